// The look-back pair as large as the panel allows, in both presentation orders with both answers.
import { image, subscribe } from "./store.js";
import { h, styled } from "./look.js";

const styles = styled(`
  :host { padding: 0 11px; }
  .pair { display: grid; grid-template-columns: 1fr 1fr; gap: 8px; }
  figure { margin: 0; font-size: 12px; color: var(--c2-quiet); }
  img { width: 100%; display: block; border-radius: 6px; background: var(--c2-well); border: 1px solid var(--c2-line); }
  figure.won img { border: 4px solid var(--c2-blue); }
  figcaption { padding: 4px 2px; }
  b { color: var(--c2-ink); font-weight: 600; }
  table { border-collapse: collapse; margin: 8px 0; width: 100%; }
  td, th { text-align: left; padding: 4px 6px; border-bottom: 1px solid var(--c2-line); font-weight: 400; }
  th { color: var(--c2-quiet); font-size: 12px; }
  .x { color: var(--c2-vermilion); font-weight: 700; }
`);

class ImagePair extends HTMLElement {
  constructor() {
    super();
    this.attachShadow({ mode: "open" }).adoptedStyleSheets = styles;
  }

  connectedCallback() {
    this.stop = subscribe((state, changed) => changed.has("lookback") && this.draw(state.lookback));
  }

  disconnectedCallback() {
    this.stop?.();
  }

  draw(pair) {
    if (!pair) {
      this.shadowRoot.replaceChildren();
      return;
    }
    const frames = pair.cards.map((card) =>
      h(
        "figure",
        { class: card.won ? "won" : null },
        h("img", { src: image(card.sha), alt: card.name }),
        h("figcaption", {}, h("b", {}, `${card.letter} `), card.name, card.won ? " · more consistent" : ""),
      ),
    );
    const rows = pair.orders.map((order) =>
      h(
        "tr",
        {},
        h("td", {}, order.shown),
        h("td", {}, order.said, order.differs ? h("span", { class: "x" }, " ✕") : ""),
      ),
    );
    const table = h("table", {}, h("tr", {}, h("th", {}, "shown first to last"), h("th", {}, "answer")), ...rows);
    this.shadowRoot.replaceChildren(h("div", { class: "pair" }, ...frames), rows.length ? table : "");
  }
}

customElements.define("image-pair", ImagePair);
