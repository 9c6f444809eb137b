// Z, held: all alternatives beside each other, each pixel that was sent twice as wide and high.
import { caption } from "./rank-strip.js";
import { image, subscribe } from "./store.js";
import { h, styled } from "./look.js";

const TIMES = 2;
const GAP = 12;
const EDGE = 20;
const HEAD = 34;
const BELOW = 48; // two lines of words
const LINE = 26;

const styles = styled(`
  :host { position: fixed; inset: 0; z-index: 40; background: var(--c2-card); overflow: auto;
    padding: 0 ${EDGE}px ${EDGE}px; }
  :host([hidden]) { display: none; }
  .head { height: ${HEAD}px; display: flex; gap: 14px; align-items: center; color: var(--c2-quiet); }
  .head b { font-weight: 600; color: var(--c2-ink); }
  .views { display: grid; gap: ${GAP}px; align-content: center; min-height: calc(100% - ${HEAD}px); }
  .row { display: flex; gap: ${GAP}px; justify-content: center; }
  figure { margin: 0; flex: none; }
  .frame { position: relative; box-shadow: 0 0 0 1px var(--c2-line); background: var(--c2-well); }
  [data-rank="1"] .frame { box-shadow: 0 0 0 4px var(--c2-blue); }
  [data-rank="2"] .frame { box-shadow: 0 0 0 2px var(--c2-far); }
  img { display: block; width: 100%; height: 100%; }
  .exact img { image-rendering: pixelated; }
  .vetoed img { filter: grayscale(1) contrast(0.45) brightness(1.35); }
  .letter, .rank { position: absolute; top: 6px; background: var(--c2-card); font-weight: 600;
    border: 1px solid var(--c2-line); line-height: 26px; }
  .letter { left: 6px; width: 28px; border-radius: 50%; text-align: center; }
  .rank { right: 6px; padding: 0 8px; border-radius: 6px; }
  .pin { position: absolute; width: 18px; height: 18px; margin: -9px 0 0 -9px; border-radius: 50%;
    border: 3px solid var(--c2-blue); outline: 2px solid #fff; }
  figcaption { padding-top: 8px; max-height: ${BELOW}px; overflow: hidden; }
  .x { color: var(--c2-vermilion); font-weight: 700; }
  b { font-weight: 600; }
  .texts { display: grid; gap: 4px; margin: 0 auto; width: fit-content; max-width: 100%; }
`);

/** Views in rows no wider than the room. */
function rows(views, times, room, most) {
  const made = [];
  let left = 0;
  for (const view of views) {
    left -= GAP + view.width * times;
    if (left < 0 || made.at(-1).length === most) {
      made.push([]);
      left = room.width - view.width * times;
    }
    made.at(-1).push(view);
  }
  return made;
}

/** The rows that show views largest without a scroll, and how large: in twentieths, up to twice. */
function fitted(views, room) {
  const widest = Math.max(0, ...views.map((view) => view.width));
  const height = (row, times) => BELOW + times * Math.max(...row.map((view) => view.height));
  const fits = (made, times) =>
    times * widest <= room.width && made.reduce((sum, row) => sum + height(row, times) + GAP, -GAP) <= room.height;
  for (let part = 20 * TIMES; part > 0; part--) {
    const times = part / 20;
    const few = rows(views, times, room, views.length);
    // As many rows, equally long.
    const even = rows(views, times, room, Math.ceil(views.length / few.length));
    if (even.length === few.length && fits(even, times)) return { made: even, times };
    if (fits(few, times)) return { made: few, times };
  }
  return { made: views.map((view) => [view]), times: 0.05 };
}

class EnlargedViews extends HTMLElement {
  constructor() {
    super();
    this.attachShadow({ mode: "open" }).adoptedStyleSheets = styles;
  }

  connectedCallback() {
    this.hidden = true;
    this.setAttribute("role", "group");
    this.setAttribute("aria-label", "alternatives, enlarged");
    this.stop = subscribe((state, changed) => {
      this.state = state;
      if (!this.hidden && ["decision", "draft"].some((name) => changed.has(name))) this.draw();
    });
    this.onbig = ({ detail }) => {
      const shown = detail && this.state?.decision;
      if (shown) this.draw();
      this.hidden = !shown;
    };
    this.onsize = () => !this.hidden && this.draw();
    window.addEventListener("c2-big", this.onbig);
    window.addEventListener("resize", this.onsize);
  }

  disconnectedCallback() {
    this.stop?.();
    window.removeEventListener("c2-big", this.onbig);
    window.removeEventListener("resize", this.onsize);
  }

  draw() {
    const { decision } = this.state;
    if (!decision) {
      this.shadowRoot.replaceChildren();
      return;
    }
    // Alternatives in words stand below the pictures that they are about.
    const pictured = decision.cards.filter((card) => card.sha);
    const texts = decision.cards.filter((card) => !card.sha);
    const shown = pictured.length ? pictured : this.about(decision.context);
    const room = {
      width: window.innerWidth - 2 * EDGE,
      height: window.innerHeight - HEAD - EDGE - (texts.length ? GAP + LINE * texts.length : 0),
    };
    const { made, times } = fitted(shown, room);
    const words = times < TIMES ? `the window has no room for ${TIMES}×` : "twice the pixels that were sent";
    const head = h("div", { class: "head" });
    head.append(h("b", {}, `decision ${decision.number} · ${decision.words} ${decision.sign}`));
    if (shown.length) head.append(h("span", {}, h("b", { class: "times" }, `${times}×`), ` · ${words}`));
    const views = h("div", { class: times === TIMES ? "views exact" : "views" });
    for (const row of made) views.append(h("div", { class: "row" }, ...row.map((one) => this.view(one, times, decision))));
    const said = texts.map((card) => h("div", {}, h("b", {}, `${card.letter} `), card.text, card.ordinal && ` · ${card.ordinal}`));
    if (texts.length) views.append(h("div", { class: "texts" }, ...said));
    this.shadowRoot.replaceChildren(head, views);
  }

  /** Pictures that all alternatives share; the strip has loaded them and knows their sizes. */
  about(context) {
    const loaded = [...(document.querySelector("rank-strip")?.shadowRoot.querySelectorAll("img") ?? [])];
    return context.map(({ words, sha }) => {
      const known = loaded.find((one) => one.dataset.sha === sha && one.naturalWidth);
      return { sha, words, width: known?.naturalWidth ?? 224, height: known?.naturalHeight ?? 224, feasible: true };
    });
  }

  view(one, times, decision) {
    const frame = h("div", { class: "frame", style: `height:${one.height * times}px` });
    frame.append(h("img", { src: image(one.sha), alt: "" }));
    if (one.mark) frame.append(h("span", { class: "pin", style: `left:${100 * one.mark[0]}%;top:${100 * one.mark[1]}%` }));
    if (one.letter) frame.append(h("span", { class: "letter" }, one.letter));
    if (one.ordinal) frame.append(h("span", { class: "rank" }, one.ordinal));
    const words = h("figcaption", {}, one.words ?? caption(one, decision));
    const style = `width:${one.width * times}px`;
    return h("figure", { class: one.feasible ? null : "vetoed", "data-rank": one.rank, style }, frame, words);
  }
}

customElements.define("enlarged-views", EnlargedViews);
