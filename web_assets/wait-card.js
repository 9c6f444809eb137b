// What is being waited for, and what waits for a yes: question, fork, consent.
import { send, subscribe } from "./store.js";
import { h, renew, styled } from "./look.js";

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

const card = (name, ...parts) => h("div", { class: "card", "data-name": name, role: "status" }, ...parts);

class WaitCard extends HTMLElement {
  constructor() {
    super();
    this.attachShadow({ mode: "open" }).adoptedStyleSheets = styles;
  }

  connectedCallback() {
    const sections = ["asking", "let_go", "offer", "working", "consent_to", "playing", "timeline"];
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
    const { asking, let_go: why, offer, working, consent_to: host } = this.state;
    clearInterval(this.ticking);
    const cards = [];
    if (host) cards.push(this.consent(host));
    if (offer) cards.push(this.offer(offer));
    if (working) cards.push(card("working", `${working}…`, h("progress")));
    if (this.state.timeline.place) cards.push(this.place(this.state.timeline.place));
    if (why) cards.push(this.letGo(why));
    if (asking) {
      cards.push(this.asking(asking));
      this.ticking = setInterval(() => this.draw(), 250);
    }
    renew(this.shadowRoot, ...cards);
  }

  /** Shown once a wait is long enough to be noticed. */
  asking(asking) {
    const elapsed = Date.now() / 1000 - asking.since_s;
    if (elapsed < 0.4) return null;
    const { usual_s: usual, answered, queries } = asking;
    const facts = [
      queries > 1 ? `${answered} of ${queries} queries answered` : "",
      `${elapsed.toFixed(1)} s${usual ? `, usually ${usual.toFixed(1)} s` : ""}`,
    ];
    const share = usual && elapsed < usual ? { value: elapsed / usual, max: 1 } : {};
    return card(
      "question",
      h("span", {}, `${asking.ranker} ranks decision ${asking.decision}`),
      h("span", { class: "quiet", "aria-live": "off" }, facts.filter(Boolean).join(" · ")),
      h("progress", share),
      h("button", { onclick: () => send("cancel") }, "Cancel"),
    );
  }

  /** Nobody answers any longer. *Ask again* stands where *Cancel* was: a second click is none. */
  letGo(why) {
    return card(
      "question",
      h("span", {}, `${why}: rank the views yourself, or ask again`),
      h("button", { onclick: (event) => event.detail < 2 && send("ask_again") }, "Ask again"),
    );
  }

  offer(offer) {
    const cost = [
      plural(offer.decisions, "decision"),
      plural(offer.queries, "query"),
      `${offer.seconds.toFixed(0)} s`,
      offer.dollars ? `$${offer.dollars.toFixed(2)}` : "",
    ];
    return card(
      "offer",
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
    return card(
      "place",
      h("span", {}, `Asked place: ${words.join(", ")}`),
      h("span", { class: "quiet" }, basis),
      h("button", { onclick: () => send("forget_place") }, "Forget"),
    );
  }

  consent(host) {
    return card(
      "consent",
      h("span", {}, `Pictures would go to ${host}, outside this machine; scene licence: ${this.state.licence || "unknown"}`),
      h("button", { class: "go", onclick: () => send("consent", { allow: true }) }, "Allow"),
      h("button", { onclick: () => send("consent", { allow: false }) }, "Refuse"),
    );
  }
}

customElements.define("wait-card", WaitCard);
