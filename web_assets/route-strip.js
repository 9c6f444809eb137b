// The instruction as one text, numbered by leg; the active leg is underlined.
import { subscribe } from "./store.js";
import { h, styled } from "./look.js";

const styles = styled(`
  :host { background: var(--c2-card); border-radius: 8px; box-shadow: var(--c2-shadow);
    padding: 9px 14px; max-height: 30vh; overflow: auto; }
  p { margin: 0; line-height: 1.6; color: var(--c2-quiet); }
  .n { display: inline-block; min-width: 19px; padding: 0 4px; margin-right: 5px; border-radius: 10px;
    border: 1px solid var(--c2-line); font-size: 12px; line-height: 17px; text-align: center;
    vertical-align: 1px; text-decoration: none; color: var(--c2-quiet); }
  .done { color: var(--c2-quiet); }
  .now { color: var(--c2-ink); font-size: 16px; font-weight: 600; text-decoration: underline;
    text-decoration-color: var(--c2-blue); text-decoration-thickness: 3px; text-underline-offset: 4px; }
  .now-n { border-color: var(--c2-blue); color: var(--c2-blue-text); font-weight: 600; }
`);

class RouteStrip extends HTMLElement {
  constructor() {
    super();
    this.attachShadow({ mode: "open" }).adoptedStyleSheets = styles;
  }

  connectedCallback() {
    this.setAttribute("role", "note");
    this.setAttribute("aria-label", "instruction");
    this.stop = subscribe((state, changed) => changed.has("episode") && this.draw(state.episode));
  }

  disconnectedCallback() {
    this.stop?.();
  }

  draw(episode) {
    const text = h("p");
    for (const { text: words, leg } of episode.segments) {
      if (leg === null) {
        text.append(words);
        continue;
      }
      const now = leg === episode.leg;
      if (episode.legs > 1) text.append(h("span", { class: now ? "n now-n" : "n" }, `${leg + 1}`));
      const kind = now ? "now" : leg < episode.leg ? "done" : "ahead";
      text.append(h("span", { class: kind, "aria-current": now && "step" }, words));
    }
    this.shadowRoot.replaceChildren(text);
  }
}

customElements.define("route-strip", RouteStrip);
