// The alternatives of the decision in view: click or drag them into order, ties, none of these.
import { image, send, subscribe } from "./store.js";
import { h, metres, renew, styled } from "./look.js";

const styles = styled(`
  :host { padding: 0 11px; }
  .chips { display: flex; flex-wrap: wrap; gap: 6px; margin: 0 0 10px; }
  .chip { background: var(--c2-chip); border-radius: 10px; padding: 1px 9px; font-size: 12px; }
  .cards { display: flex; flex-wrap: wrap; gap: 8px; align-items: stretch; }
  /* Its edge is a shadow, which takes no room: a picture keeps its size and place whatever its rank. */
  .card { position: relative; flex: 1 0 160px; max-width: 244px; min-width: 160px; padding: 0;
    display: flex; flex-direction: column; text-align: left; background: var(--c2-card);
    border: 0; border-radius: 6px; overflow: hidden; cursor: pointer; touch-action: none; user-select: none;
    --edge: 1px; --colour: var(--c2-line); box-shadow: 0 0 0 var(--edge) var(--colour), var(--glow, 0 0 #0000); }
  .card.wide { flex-basis: 240px; max-width: none; }
  .card.text { flex-basis: 100%; max-width: none; flex-direction: row; min-height: 48px; }
  .card[data-rank="1"] { --edge: 4px; --colour: var(--c2-blue); }
  .card[data-rank="2"] { --edge: 2px; }
  .card.lit { --glow: 0 0 0 calc(var(--edge) + 3px) var(--c2-halo); }
  .card.vetoed { cursor: default; }
  .card.vetoed:not(:focus-visible) { --edge: 0px; outline: 1px dashed var(--c2-line); }
  .card.dragged { opacity: 0.45; }
  .card.before::before, .card.after::before { content: ""; position: absolute; z-index: 3; top: 0;
    bottom: 0; width: 5px; background: var(--c2-blue); }
  .card.before::before { left: 0; } .card.after::before { right: 0; }
  .picture { width: 100%; aspect-ratio: var(--ratio, 1); background: var(--c2-well); display: block;
    object-fit: contain; pointer-events: none; -webkit-user-drag: none; }
  .vetoed .picture { filter: grayscale(1) contrast(0.45) brightness(1.35); }
  .letter, .rank { position: absolute; top: 6px; background: var(--c2-card); color: var(--c2-ink);
    font-weight: 600; border: 1px solid var(--c2-line); }
  .letter { left: 6px; width: 24px; height: 24px; line-height: 22px; border-radius: 50%;
    text-align: center; font-size: 13px; }
  .rank { right: 6px; padding: 0 7px; border-radius: 6px; line-height: 22px; font-size: 13px; }
  .text .letter, .text .rank { position: static; margin: 11px 0 0 10px; flex: none; align-self: flex-start; }
  .text .rank { margin: 11px 10px 0 auto; }
  .pin { position: absolute; width: 18px; height: 18px; margin: -9px 0 0 -9px; border-radius: 50%;
    border: 3px solid var(--c2-blue); outline: 2px solid #fff; top: calc(var(--row) * 100cqw / var(--ratio, 1)); }
  .card { container-type: inline-size; }
  .caption { padding: 6px 8px 7px; font-size: 12px; line-height: 1.35; flex: 1; }
  .text .caption { font-size: 14px; padding: 12px 10px; }
  .x { color: var(--c2-vermilion); font-weight: 700; }
  b { font-weight: 600; }
  .context { display: flex; flex-wrap: wrap; gap: 8px; margin-bottom: 8px; }
  .context figure { margin: 0; flex: 0 1 160px; font-size: 12px; color: var(--c2-quiet); }
  .context img { width: 100%; display: block; border-radius: 6px; background: var(--c2-well); }
  .context figure.small { flex-basis: 72px; }
  .rail { display: flex; align-items: center; flex-wrap: wrap; gap: 6px; margin-top: 10px; min-height: 30px;
    font-size: 14px; }
  .rail .who { color: var(--c2-quiet); margin-right: 2px; font-size: 12px; }
  .rail .order { font-weight: 600; }
  .rail button { border: 1px solid var(--c2-line); background: var(--c2-card); border-radius: 6px;
    padding: 3px 10px; min-height: 28px; cursor: pointer; }
  .rail button.go { background: var(--c2-blue); border-color: var(--c2-blue); color: #fff; font-weight: 600; }
  .rail button:disabled { background: var(--c2-chip); border-color: var(--c2-line); color: var(--c2-quiet);
    cursor: default; }
  .rail button[aria-pressed="true"] { border-color: var(--c2-blue); color: var(--c2-blue-text); }
  .rail .space { flex: 1; }
  kbd { font: inherit; font-size: 12px; color: inherit; opacity: 0.75; margin-left: 4px; }
  .empty { color: var(--c2-quiet); margin: 6px 0; }
`);

const WHOSE = {
  draft: "your ranking",
  override: "◆ overridden",
  proposal: "proposed",
  committed: "committed",
  unasked: "not asked",
};

/** What stands below a picture: where it looks, how far it is free, why it is vetoed. */
export function caption(card, decision) {
  if (!card.feasible) {
    return h("span", { class: "caption" }, h("span", { class: "x" }, "✕ "), h("b", {}, "vetoed"), ` · ${card.veto}`);
  }
  const words = [card.sha ? card.name : card.text];
  if (card.free_m !== null) words.push(`free ${metres(card.free_m)}`);
  if (card.rank === 1 && card.sha && decision.source !== "draft")
    words.push(decision.pending ? "proposed" : "elected");
  return h("span", { class: "caption" }, words.filter(Boolean).join(" · "));
}

class RankStrip extends HTMLElement {
  constructor() {
    super();
    this.attachShadow({ mode: "open" }).adoptedStyleSheets = styles;
  }

  connectedCallback() {
    const sections = ["decision", "draft", "asking", "view", "offer", "branch"];
    this.stop = subscribe((state, changed) => {
      if (this.drag || !sections.some((name) => changed.has(name))) return;
      this.draw(state);
      this.stands();
    });
  }

  disconnectedCallback() {
    this.stop?.();
  }

  draw(state) {
    this.state = state;
    const decision = state.decision;
    if (!decision) {
      renew(this.shadowRoot, h("p", { class: "empty" }, "The robot has not looked around yet"));
      return;
    }
    const focused = this.shadowRoot.activeElement?.dataset.key;
    const there = [...this.shadowRoot.querySelectorAll("img")].filter((one) => one.naturalWidth > 0);
    this.known = new Map(there.map((one) => [`${one.className} ${one.dataset.sha}`, one]));
    const parts = [this.chips(decision), this.context(decision)];
    if (decision.cards.length) {
      const cards = h("div", { class: "cards", role: "list" });
      cards.append(...decision.cards.map((card) => this.card(card, decision, state)));
      parts.push(cards);
    } else parts.push(h("p", { class: "empty" }, "Nothing was offered"));
    if (decision.asked) parts.push(this.rail(decision, state));
    renew(this.shadowRoot, ...parts.filter(Boolean));
    this.fill(decision.number);
    if (focused && this.shadowRoot.activeElement?.dataset.key !== focused) this.shadowRoot.querySelector(`[data-key="${CSS.escape(focused)}"]`)?.focus();
  }

  /** The picture where it stands here already, else a new one, still empty. */
  picture(sha, attributes) {
    const key = `${attributes.class ?? ""} ${sha}`;
    const known = this.known.get(key);
    this.known.delete(key);
    if (known) known.alt = attributes.alt;
    return known ?? h("img", { "data-sha": sha, ...attributes });
  }

  /** Fetch what is missing. While a person scrubs, decisions that are passed must not stand in line
   *  before the one in view: each waits for a moment whether it stays. */
  fill(number) {
    const now = performance.now();
    const passing = number !== this.number && now - this.drawn < 80;
    [this.number, this.drawn] = [number, now];
    clearTimeout(this.filling);
    const fetch = () => {
      for (const one of this.shadowRoot.querySelectorAll("img:not([src])")) one.src = image(one.dataset.sha);
    };
    if (passing) this.filling = setTimeout(fetch, 40);
    else fetch();
  }

  /** Say once that what is in view stands here, pictures included. */
  stands() {
    const waiting = [...this.shadowRoot.querySelectorAll("img")].find((one) => !one.complete);
    if (!waiting) {
      this.stands = () => {};
      window.dispatchEvent(new CustomEvent("c2-stands"));
    }
    for (const end of ["load", "error"]) waiting?.addEventListener(end, () => this.stands(), { once: true });
  }

  chips(decision) {
    const orders = { cyclic: "asked in every order", both: "asked in both orders", once: "" };
    const words = [
      `decision ${decision.number} of 0–${decision.total - 1}`,
      `${decision.words} ${decision.sign}`,
      decision.contested ? `contested: ${decision.contested}` : "",
      decision.asked ? orders[decision.orders] : "not asked",
    ];
    return h("div", { class: "chips" }, ...words.filter(Boolean).map((w) => h("span", { class: "chip" }, w)));
  }

  context(decision) {
    if (!decision.context.length) return null;
    return h(
      "div",
      { class: "context" },
      ...decision.context.map(({ words, sha }, index) =>
        h(
          "figure",
          { class: index > 0 && decision.context.length > 2 ? "small" : null },
          this.picture(sha, { alt: words }),
          words,
        ),
      ),
    );
  }

  card(card, decision, state) {
    const wide = card.width > 1.5 * card.height;
    const kinds = ["card", card.sha ? "" : "text", wide ? "wide" : "", card.feasible ? "" : "vetoed"];
    if (state.view.hovered === card.key) kinds.push("lit");
    const node = h("button", {
      type: "button",
      role: "listitem",
      class: kinds.filter(Boolean).join(" "),
      "data-key": card.key,
      "data-rank": card.rank,
      "aria-disabled": card.feasible ? null : "true",
      "aria-label": this.spoken(card),
      style: card.sha ? `--ratio:${card.width / card.height}` : null,
      onpointerenter: () => card.feasible && this.hover(card.key),
      onpointerleave: () => this.hover(""),
      onpointerdown: (event) => this.begin(event, card),
      onkeydown: (event) => this.key(event, card),
    });
    node.append(h("span", { class: "letter" }, card.letter || "–"));
    if (card.ordinal) node.append(h("span", { class: "rank" }, card.ordinal));
    if (card.sha) node.append(this.picture(card.sha, { class: "picture", alt: "", draggable: "false" }));
    if (card.mark)
      node.append(h("span", { class: "pin", style: `left:${100 * card.mark[0]}%;--row:${card.mark[1]}`, title: "the asked place" }));
    node.append(caption(card, decision));
    if (!card.sha) node.append(node.querySelector(".rank") ?? "");
    return node;
  }

  spoken(card) {
    if (!card.feasible) return `${card.name}, vetoed: ${card.veto}`;
    return `${card.letter} ${card.name} ${card.ordinal}`.trim();
  }

  rail(decision, state) {
    const drafted = decision.source === "draft";
    const rail = h("div", { class: "rail" });
    const button = (type, label, key, more = {}) =>
      h("button", { type: "button", "data-name": type, onclick: () => send(type), ...more }, label, h("kbd", {}, key));
    const out = state.asking?.branch === state.branch.id && state.asking.decision === decision.number;
    const waits = decision.source === "waiting";
    if (waits) {
      rail.append(h("span", { class: "who" }, out ? "asking…" : "waits for your ranking"));
    } else {
      rail.append(h("span", { class: "who" }, WHOSE[decision.source]), h("span", { class: "order" }, decision.outcome || "–"));
    }
    rail.append(h("span", { class: "space" }));
    if (drafted) {
      rail.append(
        button("none", "None", "X", { "aria-pressed": `${state.draft.none}` }),
        button("tie", "Tie", "=", { "aria-pressed": `${state.draft.tie_next}` }),
        button("clear", "Clear", "Esc"),
        button("commit", decision.pending ? "Commit" : state.offer ? "Fork" : "Fork…", "⏎", { class: "go" }),
      );
    } else {
      rail.append(button("none", "None", "X", { title: "none of these" }));
      // While the question is out, a commit takes the answer as soon as it comes.
      const idle = waits && !out;
      if (decision.pending)
        rail.append(button("commit", "Commit", "⏎", { class: "go", disabled: idle, title: idle && "rank the views first" }));
    }
    return rail;
  }

  hover(key) {
    if (this.drag || this.state.view.hovered === key) return;
    clearTimeout(this.hovering);
    this.hovering = setTimeout(() => send("hover", { key }), 60);
  }

  key(event, card) {
    if (event.key === " " || event.key === "Enter") {
      // Enter on a card ranks it; Enter elsewhere commits.
      if (event.key === "Enter" && this.state.decision.source === "draft") return;
      event.preventDefault();
      event.stopPropagation();
      if (card.feasible) send("press", { key: card.key });
    } else if (event.altKey && (event.key === "ArrowLeft" || event.key === "ArrowRight")) {
      event.preventDefault();
      event.stopPropagation();
      this.shift(card.key, event.key === "ArrowLeft" ? -1 : 1);
    }
  }

  /** Tiers as shown, with everything that was offered. */
  tiers() {
    const decision = this.state.decision;
    const offered = decision.cards.filter((card) => card.feasible);
    const ranks = [...new Set(offered.map((card) => card.rank ?? 99))].sort((a, b) => a - b);
    return ranks.map((rank) => offered.filter((card) => (card.rank ?? 99) === rank).map((card) => card.key));
  }

  shift(key, by) {
    const flat = this.tiers().flat();
    const from = flat.indexOf(key);
    const to = Math.max(0, Math.min(flat.length - 1, from + by));
    flat.splice(to, 0, ...flat.splice(from, 1));
    send("arrange", { tiers: flat.map((one) => [one]) });
  }

  // ---------------------------------------------------------------- dragging

  begin(event, card) {
    if (event.button !== 0) return;
    if (event.shiftKey) {
      this.ask(event, card);
      return;
    }
    if (!card.feasible || !this.state.decision.asked) return;
    const key = card.key;
    const node = event.currentTarget;
    const start = { x: event.clientX, y: event.clientY };
    const move = (next) => {
      const far = Math.hypot(next.clientX - start.x, next.clientY - start.y) > 6;
      if (!this.drag && far) {
        this.drag = { key, target: null };
        node.classList.add("dragged");
      }
      if (this.drag) this.over(next);
    };
    const end = () => {
      window.removeEventListener("pointermove", move);
      window.removeEventListener("pointerup", end);
      window.removeEventListener("pointercancel", end);
      const drag = this.drag;
      this.drag = null;
      node.classList.remove("dragged");
      if (!drag) send("press", { key });
      else if (drag.target) this.drop(drag);
      else this.draw(this.state);
    };
    window.addEventListener("pointermove", move);
    window.addEventListener("pointerup", end);
    window.addEventListener("pointercancel", end);
  }

  /** Shift and click: where else was this seen? */
  ask(event, card) {
    const box = event.currentTarget.querySelector(".picture")?.getBoundingClientRect();
    if (!box || event.clientY > box.bottom) return;
    const column = (event.clientX - box.left) / box.width;
    const row = (event.clientY - box.top) / box.height;
    send("place", { sha256: card.sha, column, row });
  }

  /** The card under the pointer, and which third of it: before, with, after. */
  over(event) {
    this.drag.target = null;
    for (const card of this.shadowRoot.querySelectorAll(".card")) {
      card.classList.remove("before", "after", "lit");
      const box = card.getBoundingClientRect();
      const inside =
        event.clientX >= box.left && event.clientX <= box.right && event.clientY >= box.top && event.clientY <= box.bottom;
      if (!inside || card.dataset.key === this.drag.key || card.classList.contains("vetoed")) continue;
      const part = (event.clientX - box.left) / box.width;
      const where = part < 0.4 ? "before" : part > 0.6 ? "after" : "with";
      card.classList.add(where === "with" ? "lit" : where);
      this.drag.target = { key: card.dataset.key, where };
    }
  }

  drop({ key, target }) {
    const tiers = this.tiers()
      .map((tier) => tier.filter((one) => one !== key))
      .filter((tier) => tier.length);
    const index = tiers.findIndex((tier) => tier.includes(target.key));
    if (target.where === "with") tiers[index].push(key);
    else tiers.splice(target.where === "before" ? index : index + 1, 0, [key]);
    send("arrange", { tiers });
  }
}

customElements.define("rank-strip", RankStrip);
