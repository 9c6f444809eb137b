// What is being waited for, and what waits for a yes: question, fork, consent.
import { send, subscribe } from "./store.js";
import { h, styled } from "./look.js";

const styles = styled(`
  :host { pointer-events: none; }
  .card { pointer-events: auto; display: inline-flex; align-items: center; gap: 10px; flex-wrap: wrap;
    background: var(--c2-card); border-radius: 8px; box-shadow: var(--c2-shadow); padding: 6px 12px;
    margin-top: 8px; border-left: 4px solid var(--c2-blue); }
  .card span { min-width: 0; overflow-wrap: anywhere; }
  button { border: 1px solid var(--c2-line); background: var(--c2-card); border-radius: 6px; padding: 3px 10px;
    min-height: 28px; cursor: pointer; }
  button.go { background: var(--c2-blue); border-color: var(--c2-blue); color: #fff; font-weight: 600; }
  .quiet { color: var(--c2-quiet); }
  progress { width: 90px; height: 8px; accent-color: var(--c2-blue); }
`);

const plural = (count, noun) => `${count} ${count === 1 ? noun : noun === "query" ? "queries" : `${noun}s`}`;

class WaitCard extends HTMLElement {
  constructor() {
    super();
    this.attachShadow({ mode: "open" }).adoptedStyleSheets = styles;
  }

  connectedCallback() {
    const sections = ["asking", "offer", "working", "consent_to", "playing", "timeline"];
    this.stop = subscribe((state, changed) => {
      this.state = state;
      if (sections.some((name) => changed.has(name))) this.draw();
    });
  }

  disconnectedCallback() {
    this.stop?.();
    clearInterval(this.ticking);
  }

  draw() {
    const { asking, offer, working, consent_to: host } = this.state;
    clearInterval(this.ticking);
    const cards = [];
    if (host) cards.push(this.consent(host));
    if (offer) cards.push(this.offer(offer));
    if (working) cards.push(h("div", { class: "card" }, `${working}…`, h("progress")));
    if (this.state.timeline.place) cards.push(this.place(this.state.timeline.place));
    if (asking) {
      const card = this.asking(asking);
      if (card) cards.push(card);
      this.ticking = setInterval(() => this.draw(), 250);
    }
    this.shadowRoot.replaceChildren(...cards);
  }

  /** Shown once a wait is long enough to be noticed. */
  asking(asking) {
    const elapsed = Date.now() / 1000 - asking.since_s;
    if (elapsed < 0.4) return null;
    const expected = asking.median_s ? asking.median_s * asking.queries : null;
    const query = asking.median_s
      ? Math.min(asking.queries, 1 + Math.floor(elapsed / asking.median_s))
      : 1;
    const usual = expected ? ` of about ${expected.toFixed(1)} s` : "";
    return h(
      "div",
      { class: "card", role: "status" },
      h("span", {}, `${asking.ranker} ranks decision ${asking.decision}`),
      h("span", { class: "quiet" }, `query ${query} of ${asking.queries} · ${elapsed.toFixed(1)} s${usual}`),
      h("progress", expected ? { value: Math.min(elapsed / expected, 1), max: 1 } : {}),
      h("button", { onclick: () => send("cancel") }, "Cancel"),
    );
  }

  offer(offer) {
    const cost = [
      plural(offer.decisions, "decision"),
      plural(offer.queries, "query"),
      `${offer.seconds.toFixed(0)} s`,
      offer.dollars ? `$${offer.dollars.toFixed(2)}` : "",
    ];
    return h(
      "div",
      { class: "card" },
      h("span", {}, offer.decisions ? `Forks here: about ${cost.filter(Boolean).join(", ")}` : "Forks here; what follows is not known yet"),
      h("button", { class: "go", onclick: () => send("commit") }, "Fork"),
      h("button", { onclick: () => send("clear") }, "Cancel"),
    );
  }

  place({ looks, basis }) {
    const count = (status) => looks.filter((look) => look.status === status).length;
    const words = [`in view in ${count("seen")} of ${looks.length} looks`];
    if (count("vetoed")) words.push(`${count("vetoed")} only in a vetoed view`);
    if (count("hidden")) words.push(`${count("hidden")} hidden`);
    return h(
      "div",
      { class: "card" },
      h("span", {}, `Asked place: ${words.join(", ")}`),
      h("span", { class: "quiet" }, basis),
      h("button", { onclick: () => send("forget_place") }, "Forget"),
    );
  }

  consent(host) {
    return h(
      "div",
      { class: "card" },
      h("span", {}, `Pictures would go to ${host}, outside this machine; scene licence: ${this.state.licence || "unknown"}`),
      h("button", { class: "go", onclick: () => send("consent", { allow: true }) }, "Allow"),
      h("button", { onclick: () => send("consent", { allow: false }) }, "Refuse"),
    );
  }
}

customElements.define("wait-card", WaitCard);
