// Full width: distance to the goal, lanes by slot, events; everything can be clicked.
import { send, subscribe } from "./store.js";
import { h, s, styled } from "./look.js";

const LEFT = 128;
const RIGHT = 18;
const CURVE = { top: 6, height: 33 };
const LANES = [50.5, 63, 75.5];
const EVENTS = 88;
const LAST = 101;
const LABEL = { width: 162, rows: [13, 28] };
const TARGET = { width: 12, height: 24 };
const LEAST = 4; // px from mark to mark where a crowd leaves less
const LINE = 12;
const SIGNS = ["●", "▲", "■"];
const NAMES = ["Seeing", "Transition", "Arriving"];

const styles = styled(`
  :host { position: relative; background: var(--c2-card); border-top: 1px solid var(--c2-line); height: 112px; }
  svg { display: block; width: 100%; height: 100%; cursor: pointer; touch-action: none; }
  text { font: 12px var(--c2-font); fill: var(--c2-quiet); font-variant-numeric: tabular-nums; }
  .band { fill: var(--c2-band); }
  .curve { fill: none; stroke: var(--c2-ink); stroke-width: 2; }
  .rest { fill: none; stroke: var(--c2-far); stroke-width: 1.5; stroke-dasharray: 4 3; }
  .grid { stroke: var(--c2-line); stroke-width: 1; }
  .mark text { font-size: 13px; fill: var(--c2-ink); text-anchor: middle; paint-order: stroke;
    stroke: var(--c2-card); stroke-width: 2px; }
  .mark.far text { fill: var(--c2-far); }
  .mark.bad text, .bad { fill: var(--c2-vermilion); }
  .mark.now text { fill: var(--c2-blue-text); font-size: 15px; }
  .mark:hover text { fill: var(--c2-blue-text); }
  .mark rect { fill: transparent; }
  .leg { stroke: var(--c2-line); stroke-dasharray: 2 3; }
  .here, .heretext, .legname { pointer-events: none; }
  .here { stroke: var(--c2-blue); stroke-width: 2; }
  /* What they are written across ends around the letters: wide enough to close the gaps between words. */
  .heretext, .legname { paint-order: stroke; stroke: var(--c2-card); stroke-width: 6px; stroke-linejoin: round; }
  .heretext, .legname.now { fill: var(--c2-blue-text); font-weight: 600; }
  .mark rect.regret { fill: var(--c2-ink); }
  .flag { cursor: ew-resize; }
  .flag line { stroke: var(--c2-blue); stroke-width: 1.5; stroke-dasharray: 5 2; }
  .flag text { fill: var(--c2-blue-text); font-weight: 600; }
  .flag rect { fill: transparent; }
  .tip { position: absolute; bottom: calc(100% + 4px); background: var(--c2-ink); color: var(--c2-card);
    border-radius: 6px; padding: 3px 8px; font-size: 12px; white-space: nowrap; pointer-events: none;
    max-width: 480px; overflow: hidden; text-overflow: ellipsis; }
`);

class TimelineBar extends HTMLElement {
  constructor() {
    super();
    this.attachShadow({ mode: "open" }).adoptedStyleSheets = styles;
  }

  connectedCallback() {
    this.setAttribute("role", "group");
    this.setAttribute("aria-label", "timeline");
    this.tip = h("div", { class: "tip", hidden: true });
    this.stop = subscribe((state, changed) => {
      const here = { ...state.place, leg: state.episode.leg };
      const moved = changed.has("place") || changed.has("episode");
      if (changed.has("timeline")) this.soon({ ...state.timeline, here });
      else if (moved && this.timeline) this.soon({ ...this.timeline, here }, false);
    });
    this.sizes = new ResizeObserver(() => this.timeline && this.draw(this.timeline));
    this.sizes.observe(this);
  }

  disconnectedCallback() {
    this.stop?.();
    this.sizes?.disconnect();
  }

  /** Draw with the next frame: while a person scrubs, several states arrive between two. */
  soon(timeline, anew = true) {
    this.timeline = timeline;
    this.anew ||= anew;
    this.frame ??= requestAnimationFrame(() => {
      this.frame = null;
      if (this.anew) this.draw(this.timeline);
      else this.follow(this.timeline.here);
    });
  }

  /** Only the place in view has changed: hundreds of marks stay as they are. */
  follow(here) {
    for (const follower of this.followers ?? []) follower(here);
  }

  draw(timeline) {
    this.timeline = timeline;
    const width = this.clientWidth;
    if (!width) return;
    this.anew = false;
    this.followers = [];
    this.targets = [];
    const steps = Math.max(timeline.steps, 12);
    this.x = (step) => LEFT + ((width - LEFT - RIGHT) * step) / steps;
    this.step = (x) => Math.round(((x - LEFT) * steps) / (width - LEFT - RIGHT));
    const svg = s("svg", { width, height: 112, role: "img" });
    const [line, label] = this.here(width);
    svg.append(...this.curve(timeline, width), ...this.lanes(timeline), line, ...this.names(timeline.legs), label);
    for (const end of timeline.leg_ends ?? []) svg.append(this.flag(end));
    svg.addEventListener("pointerdown", (event) => this.scrub(event));
    this.follow(timeline.here);
    this.shadowRoot.replaceChildren(svg, this.tip);
  }

  curve(timeline, width) {
    const ghost = timeline.ghost?.curve ?? [];
    const all = [...timeline.curve, ...ghost];
    const most = Math.max(timeline.band_m * 1.4, ...all.map(([, distance]) => distance));
    const y = (this.y = (distance) => CURVE.top + CURVE.height * (1 - distance / most));
    const line = (points) => points.map(([step, d], i) => `${i ? "L" : "M"}${this.x(step)} ${y(d)}`).join("");
    const parts = [
      s("text", { x: 14, y: CURVE.top + 8 }, "distance, m"),
      s("rect", {
        class: "band",
        x: LEFT,
        width: width - LEFT - RIGHT,
        y: y(timeline.band_m),
        height: y(0) - y(timeline.band_m),
      }),
    ];
    parts.push(...this.axis(timeline.band_m, most));
    for (const { step } of timeline.legs) {
      if (timeline.legs.length < 2) break;
      parts.push(s("line", { class: "leg", x1: this.x(step), x2: this.x(step), y1: CURVE.top - 4, y2: y(0) }));
    }
    if (ghost.length > 1) parts.push(s("path", { class: "rest", d: line(ghost) }));
    const [rest, done] = [s("path", { class: "rest" }), s("path", { class: "curve" })];
    this.followers.push((here) => {
      rest.setAttribute("d", line(timeline.curve.filter(([step]) => step >= here.step)));
      done.setAttribute("d", line(timeline.curve.filter(([step]) => step <= here.step)));
    });
    return [...parts, rest, done];
  }

  /** 0, the band and the greatest distance: the band's label gives way where the others are near. */
  axis(band, most) {
    const label = (value, y) => s("text", { class: "axis", x: LEFT - 8, y, "text-anchor": "end" }, value);
    const [zero, top] = [this.y(0) + 5, this.y(most) + 6];
    const far = most > band * 1.6;
    const between = Math.max(far ? top + LINE : 0, Math.min(this.y(band) + 1, zero - LINE));
    const labels = [label("0", zero), label(`${+band.toFixed(1)}`, between)];
    return far ? [...labels, label(most.toFixed(0), top)] : labels;
  }

  /** Each leg by its name where it begins, or by its number where the next one is near. */
  names(legs) {
    if (legs.length < 2) return [];
    return legs.map(({ leg, step }, index) => {
      const end = index + 1 < legs.length ? this.x(legs[index + 1].step) : this.clientWidth;
      const words = end - this.x(step) < 48 ? `${leg + 1}` : `leg ${leg + 1}`;
      const name = s("text", { class: "legname", x: this.x(step) + 4, y: this.y(0) - 2 }, words);
      this.followers.push((here) => name.classList.toggle("now", leg === here.leg));
      return name;
    });
  }

  /** Where each decision's mark stands: those of one lane at one step side by side, as far as the next
   *  step of the lane or the edge leaves room. */
  spread(marks) {
    const crowds = new Map();
    for (const mark of marks) {
      const key = `${mark.lane} ${mark.step}`;
      crowds.set(key, [...(crowds.get(key) ?? []), mark]);
    }
    const places = new Map();
    const next = LANES.map(() => Infinity);
    for (const crowd of [...crowds.values()].reverse()) {
      const { lane, step } = crowd[0];
      const room = (next[lane] - this.x(step)) / crowd.length;
      const pitch = Math.max(LEAST, Math.min(TARGET.width, room));
      const start = Math.min(this.x(step), this.clientWidth - 8 - pitch * (crowd.length - 1));
      crowd.forEach((mark, index) => places.set(mark, start + pitch * index));
      next[lane] = start;
    }
    return places;
  }

  lanes(timeline) {
    const parts = NAMES.map((name, lane) => s("text", { x: 14, y: LANES[lane] + 4 }, `${SIGNS[lane]} ${name}`));
    parts.push(s("text", { x: 14, y: EVENTS + 4 }, "events"));
    const ahead = (timeline.ghost?.marks ?? []).filter((mark) => mark.step > timeline.last);
    const places = this.spread([...timeline.marks, ...ahead]);
    for (const mark of ahead) {
      parts.push(this.mark(mark, LANES[mark.lane], SIGNS[mark.lane], "far", null, places.get(mark)));
    }
    for (const mark of timeline.marks) {
      const sign = mark.fault ? "✕" : mark.open ? { 0: "○", 1: "△", 2: "□" }[mark.lane] : SIGNS[mark.lane];
      const [kind, target] = [mark.fault ? "bad" : "", { decision: mark.decision }];
      const node = this.mark(mark, LANES[mark.lane], sign, kind, target, places.get(mark));
      this.followers.push((here) => {
        const now = mark.decision === here.decision;
        node.classList.toggle("now", now);
        node.classList.toggle("far", !now && (mark.step > here.step || mark.decision > here.decision));
      });
      parts.push(node);
    }
    const crowd = new Map();
    for (const event of timeline.events) {
      // Several events of one step stand side by side; at the right edge they grow to the left.
      const place = crowd.get(event.step) ?? 0;
      const fits = this.x(event.step) + 12 * place < this.clientWidth - 8;
      crowd.set(event.step, place + 1);
      const x = this.x(event.step) + (fits ? 12 * place : -12 * place);
      const node = this.mark(event, EVENTS, event.sign, event.fault ? "bad" : "", { step: event.step }, x);
      this.followers.push((here) => node.classList.toggle("far", event.step > here.step));
      parts.push(node);
    }
    parts.push(...(timeline.place ? this.place(timeline.place) : this.regrets(timeline.regret)));
    return parts;
  }

  regrets(regrets) {
    const parts = [s("text", { x: 14, y: LAST + 4 }, "regret")];
    for (const { decision, step, m } of regrets) {
      const x = this.x(step);
      const height = Math.min(11, 3 + m * 6);
      const group = s(
        "g",
        { class: "mark" },
        s("rect", { x: x - TARGET.width / 2, y: LAST - TARGET.height / 2, ...TARGET }),
        s("rect", { class: "regret", x: x - 2, width: 4, y: LAST + 5 - height, height }),
      );
      const mark = { step, words: `decision ${decision} · regret ${m.toFixed(1)} m` };
      this.reacts(group, { mark, target: { decision }, x, y: LAST });
      parts.push(group);
    }
    return parts;
  }

  /** Where an asked place was in view. */
  place(place) {
    const signs = { seen: "◉", vetoed: "✕", hidden: "◌", away: "·", unsure: "?" };
    const words = {
      seen: "in view",
      vetoed: "in a vetoed view",
      hidden: "hidden behind something",
      away: "not looked at",
      unsure: "in a view without recorded depth",
    };
    const parts = [s("text", { x: 14, y: LAST + 4 }, "asked place")];
    for (const { step, status } of place.looks) {
      const kind = { seen: "now", vetoed: "bad" }[status] ?? "far";
      const mark = { step, words: `step ${step} · ${words[status]} · ${place.basis}` };
      parts.push(this.mark(mark, LAST, signs[status], kind, { step }));
    }
    return parts;
  }

  mark(mark, y, sign, kind, target, x = this.x(mark.step)) {
    const group = s(
      "g",
      { class: `mark ${kind}` },
      s("rect", { x: x - TARGET.width / 2, y: y - TARGET.height / 2, ...TARGET }),
      s("text", { x, y: y + 4 }, sign),
    );
    this.reacts(group, { mark, target, x, y });
    return group;
  }

  reacts(group, one) {
    if (one.target) this.targets.push(one);
    const show = (event) => {
      const { nearest, all } = this.under(event, one);
      this.show(nearest, all.length);
    };
    group.addEventListener("pointerenter", show);
    group.addEventListener("pointermove", show);
    group.addEventListener("pointerleave", () => (this.tip.hidden = true));
    if (one.target) group.addEventListener("pointerdown", (event) => this.press(event, one));
  }

  show({ mark, x }, crowd = 1) {
    this.tip.textContent = crowd > 1 ? `${mark.words} · one of ${crowd} here, click again for the next` : mark.words;
    this.tip.hidden = false;
    this.tip.style.left = `${Math.max(8, Math.min(x - 40, this.clientWidth - 490))}px`;
  }

  /** Targets are taller than lanes and marks can crowd: of all under the pointer those of the nearest
   *  lane, and the nearest of them. Where there is none, the one that heard the event. */
  under({ clientX, clientY }, own) {
    const box = this.shadowRoot.querySelector("svg").getBoundingClientRect();
    const across = (one) => Math.abs(one.x - (clientX - box.left));
    const down = (one) => Math.abs(one.y - (clientY - box.top));
    const hit = this.targets.filter((one) => across(one) <= TARGET.width / 2 && down(one) <= TARGET.height / 2);
    if (!own.target || !hit.length) return { nearest: own, all: [own] };
    const lane = Math.min(...hit.map(down));
    const all = hit.filter((one) => down(one) === lane);
    return { nearest: all.reduce((best, one) => (across(one) < across(best) ? one : best)), all };
  }

  /** Go to the mark under the pointer; pressed again, to the next of those that lie on it. */
  press(event, own) {
    event.stopPropagation();
    const { nearest, all } = this.under(event, own);
    const { clientX: x, clientY: y } = event;
    const again = this.pressed && Math.hypot(x - this.pressed.x, y - this.pressed.y) < 4;
    const inView = (one) => one.target.decision === this.timeline.here.decision;
    const last = again ? all.findIndex(({ mark }) => mark === this.pressed.mark) : -1;
    const from = last >= 0 ? last : inView(nearest) ? all.indexOf(nearest) : -1;
    const one = from >= 0 ? all[(from + 1) % all.length] : nearest;
    this.pressed = { x, y, mark: one.mark };
    if (all.length > 1) this.show(one, all.length);
    if (one.mark.opens) send("open_flip", one.mark.opens);
    else send("go", one.target);
  }

  /** Where the label beside x does not lie on the curve: above it, or below where no leg is named. */
  row(x, flip) {
    const { curve, ghost, legs } = this.timeline;
    const left = flip ? x - LABEL.width : x;
    const margin = this.x(1) - this.x(0);
    const beside = (step) => this.x(step) > left - margin && this.x(step) < left + LABEL.width + margin;
    const near = [...curve, ...(ghost?.curve ?? [])].filter(([step]) => beside(step));
    const [above, below] = LABEL.rows;
    const clear = (row) => !near.some(([, distance]) => Math.abs(this.y(distance) - row + 4) < 9);
    const named = legs.length > 1 && legs.some(({ step }) => beside(step));
    return clear(above) || named || !clear(below) ? above : below;
  }

  here(width) {
    const line = s("line", { class: "here", y1: 2, y2: 110 });
    const text = s("text", { class: "heretext" });
    this.followers.push(({ step, decision }) => {
      const x = this.x(step);
      const flip = x > width - LABEL.width - 8;
      line.setAttribute("x1", x);
      line.setAttribute("x2", x);
      text.setAttribute("x", flip ? x - 7 : x + 7);
      text.setAttribute("y", this.row(x, flip));
      text.setAttribute("text-anchor", flip ? "end" : "start");
      text.textContent = `step ${step}${decision >= 0 ? ` · decision ${decision}` : ""}`;
    });
    return [line, text];
  }

  /** Where a person says that a leg ends; dragging says it anew. */
  flag({ leg, step }) {
    const group = s(
      "g",
      { class: "flag", "data-leg": leg },
      s("line", { x1: 0, x2: 0, y1: CURVE.top, y2: EVENTS }),
      s("rect", { x: -8, y: 14, width: 34, height: 24 }),
      s("text", { x: -1, y: CURVE.top + 25 }, `⚑${leg + 1}`),
    );
    const put = (at) => group.setAttribute("transform", `translate(${this.x(at)} 0)`);
    put(step);
    const mark = { step, words: `your leg ${leg + 1} ends at step ${step} · drag it` };
    this.reacts(group, { mark, target: null, x: this.x(step) });
    group.addEventListener("pointerdown", (event) => {
      event.stopPropagation();
      let wanted = step;
      const move = ({ clientX }) => {
        const at = this.step(clientX - this.getBoundingClientRect().left);
        wanted = Math.max(0, Math.min(this.timeline.last, at));
        put(wanted);
      };
      const end = () => {
        window.removeEventListener("pointermove", move);
        window.removeEventListener("pointerup", end);
        if (wanted !== step) send("leg_end", { leg, step: wanted });
      };
      window.addEventListener("pointermove", move);
      window.addEventListener("pointerup", end);
    });
    return group;
  }

  /** Dragging goes through steps; the newest position wins. */
  scrub(event) {
    const go = (next) => {
      const box = this.getBoundingClientRect();
      const step = Math.max(0, Math.min(this.timeline.last, this.step(next.clientX - box.left)));
      if (step === this.scrubbed) return;
      this.scrubbed = step;
      this.wanted = step;
      if (!this.sending) this.drain();
    };
    const end = () => {
      this.scrubbed = null;
      window.removeEventListener("pointermove", go);
      window.removeEventListener("pointerup", end);
    };
    window.addEventListener("pointermove", go);
    window.addEventListener("pointerup", end);
    go(event);
  }

  async drain() {
    this.sending = true;
    while (this.wanted !== null) {
      const step = this.wanted;
      this.wanted = null;
      await send("go", { step });
    }
    this.sending = false;
  }
}

customElements.define("timeline-bar", TimelineBar);
