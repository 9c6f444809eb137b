// The instruction as one text, numbered by leg; the active leg is underlined and kept in view.
import { subscribe } from "./store.js";
import { h, styled } from "./look.js";

const FADE = 26;

const styles = styled(`
  :host { position: relative; background: var(--c2-card); border-radius: 8px; box-shadow: var(--c2-shadow);
    overflow: hidden; }
  .text { position: relative; padding: 9px 14px; max-height: 30vh; overflow: auto; }
  p { margin: 0; line-height: 1.6; color: var(--c2-quiet); overflow-wrap: anywhere; }
  .n { display: inline-block; min-width: 19px; padding: 0 4px; margin-right: 5px; border-radius: 10px;
    border: 1px solid var(--c2-line); font-size: 12px; line-height: 17px; text-align: center;
    vertical-align: 1px; text-decoration: none; color: var(--c2-quiet); }
  .done { color: var(--c2-quiet); }
  .now { color: var(--c2-ink); font-size: 16px; font-weight: 600; text-decoration: underline;
    text-decoration-color: var(--c2-blue); text-decoration-thickness: 3px; text-underline-offset: 4px; }
  .now-n { border-color: var(--c2-blue); color: var(--c2-blue-text); font-weight: 600; }
  .more { position: absolute; left: 0; right: 0; height: var(--fade, ${FADE}px); pointer-events: none;
    display: flex; justify-content: flex-end; padding: 0 6px; color: var(--c2-quiet); font-size: 12px; line-height: 14px;
    opacity: 0; }
  .more.above { top: 0; align-items: start; background: linear-gradient(var(--c2-card) 30%, transparent); }
  .more.below { bottom: 0; align-items: end; background: linear-gradient(transparent, var(--c2-card) 70%); }
  .more.shown { opacity: 1; }
`);

class RouteStrip extends HTMLElement {
  constructor() {
    super();
    this.attachShadow({ mode: "open" }).adoptedStyleSheets = styles;
    this.text = h("div", { class: "text", onscroll: () => this.fade() });
    this.above = h("div", { class: "more above", "aria-hidden": "true" }, "▴");
    this.below = h("div", { class: "more below", "aria-hidden": "true" }, "▾");
    this.shadowRoot.append(this.text, this.above, this.below);
  }

  connectedCallback() {
    this.setAttribute("role", "note");
    this.setAttribute("aria-label", "instruction");
    this.stop = subscribe((state, changed) => changed.has("episode") && this.draw(state.episode));
    this.sizes = new ResizeObserver(() => this.reveal());
    this.sizes.observe(this.text);
  }

  disconnectedCallback() {
    this.stop?.();
    this.sizes?.disconnect();
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
    this.text.replaceChildren(text);
    // Who scrolls to read another leg is left alone until the active one changes.
    const shown = `${episode.leg} ${text.textContent}`;
    if (shown !== this.shown) this.reveal();
    this.shown = shown;
  }

  /** Scroll no further than it takes to show the active leg clear of the fades; its start where it is too long. */
  reveal() {
    const { text } = this;
    const parts = [...text.querySelectorAll(".now-n, .now")].map((node) => node.getBoundingClientRect());
    if (parts.length) {
      const from = text.getBoundingClientRect().top - text.scrollTop;
      const [top, bottom] = [parts[0].top - from, parts.at(-1).bottom - from];
      const clear = Math.max(4, Math.min(FADE, (text.clientHeight - (bottom - top)) / 2));
      this.style.setProperty("--fade", `${clear}px`);
      const least = bottom + clear - text.clientHeight;
      text.scrollTop = Math.min(Math.max(text.scrollTop, least), top - clear);
    }
    this.fade();
  }

  fade() {
    const { scrollTop, scrollHeight, clientHeight } = this.text;
    this.above.classList.toggle("shown", scrollTop > 2);
    this.below.classList.toggle("shown", scrollTop + clientHeight < scrollHeight - 2);
  }
}

customElements.define("route-strip", RouteStrip);
