// Distance to the goal and Arriving's evidence, over low-level steps.
import { brief, go, here, state, subscribe, tale } from "./store.js";
import { h, s } from "./look.js";

const LEFT = 104;
const RIGHT = 24;
const LANE = 26;
const LANES = [
  ["ground", "ground"],
  ["journey", "journey"],
  ["lookback", "look-back"],
];
const SIGNS = { 1: "+", 0: "0", [-1]: "−" };

export class Curves {
  constructor() {
    this.node = h("div", { role: "tabpanel", "aria-label": "curves", class: "x-plain", hidden: true });
    subscribe(() => this.draw());
    new ResizeObserver(() => this.draw()).observe(this.node);
  }

  draw() {
    const { clientWidth: width, clientHeight: height } = this.node;
    if (!width || !height || !state.schema) return;
    this.top = document.querySelector(".x-top").offsetHeight + 48;
    this.foot = Math.max(this.top + 60, height - 230);
    const { timeline } = here().branch;
    const steps = Math.max(...tale.branches.map((branch) => branch.timeline.last), 1);
    const all = tale.branches.flatMap((branch) => branch.timeline.curve.map(([, metres]) => metres));
    const most = Math.max(timeline.band_m * 1.4, ...all) * 1.04;
    this.x = (step) => LEFT + ((width - LEFT - RIGHT) * step) / steps;
    this.y = (metres) => this.top + (this.foot - this.top) * (1 - metres / most);
    const svg = s("svg", { class: "x-svg", viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": "distance to the goal and evidence over steps" });
    svg.append(...this.axes(width, most, steps), ...this.legs(), ...this.lines(), ...this.lanes(width), ...this.here());
    svg.addEventListener("click", (event) => {
      const box = svg.getBoundingClientRect();
      const step = Math.round(((event.clientX - box.left - LEFT) * steps) / (width - LEFT - RIGHT));
      go({ step: Math.max(0, Math.min(timeline.last, step)) });
    });
    this.node.replaceChildren(svg);
  }

  axes(width, most, steps) {
    const band = here().branch.timeline.band_m;
    const parts = [
      s("rect", { class: "band", x: LEFT, y: this.y(band), width: width - LEFT - RIGHT, height: this.foot - this.y(band) }),
      s("line", { class: "rim", x1: LEFT, x2: width - RIGHT, y1: this.y(band), y2: this.y(band) }),
      s("text", { class: "quiet", x: LEFT, y: this.top - 14 }, "distance to the goal, m"),
    ];
    const label = (text, y) => s("text", { class: "quiet", x: LEFT - 10, y: y + 4, "text-anchor": "end" }, text);
    const stride = [1, 2, 5, 10, 20, 50].find((value) => most / value <= 7) ?? 100;
    for (let metres = 0; metres <= most; metres += stride) {
      parts.push(s("line", { class: "grid", x1: LEFT, x2: width - RIGHT, y1: this.y(metres), y2: this.y(metres) }));
      if (Math.abs(this.y(metres) - this.y(band)) > 14) parts.push(label(`${metres}`, this.y(metres)));
    }
    parts.push(label(`${+band.toFixed(2)}`, this.y(band)));
    const along = [1, 2, 5, 10, 20, 50, 100].find((value) => steps / value <= 12) ?? 100;
    for (let step = 0; step <= steps; step += along)
      parts.push(s("text", { class: "quiet", x: this.x(step), y: this.foot + 18, "text-anchor": "middle" }, `${step}`));
    parts.push(s("text", { class: "quiet", x: (LEFT + width - RIGHT) / 2, y: this.foot + 36, "text-anchor": "middle" }, "low-level step"));
    return parts;
  }

  legs() {
    const { legs } = here().branch.timeline;
    if (legs.length < 2) return [];
    return legs.flatMap(({ leg, step }, index) => {
      const x = this.x(index ? step : 0);
      return [
        s("line", { class: "cut", x1: x, x2: x, y1: this.top, y2: this.foot }),
        s("text", { class: "quiet", x: x + 5, y: this.foot - 7 }, `leg ${leg + 1}`),
      ];
    });
  }

  lines() {
    const path = (curve) => curve.map(([step, metres], i) => `${i ? "L" : "M"}${this.x(step)} ${this.y(metres)}`).join("");
    const parts = [];
    const others = tale.branches.filter((branch) => branch !== here().branch && branch.timeline.curve.length > 1);
    others.forEach((branch, index) => {
      const { curve } = branch.timeline;
      parts.push(s("path", { class: "line other", d: path(curve) }, s("title", {}, branch.branch.label)));
      // Each name stands on its own curve, at another share of the way.
      const [step, metres] = curve[Math.floor((curve.length - 1) * (0.62 - 0.18 * (index % 3)))];
      parts.push(s("text", { class: "quiet halo", x: this.x(step) + 6, y: this.y(metres) - 6 }, brief(branch)));
    });
    const { curve } = here().branch.timeline;
    if (curve.length > 1) parts.push(s("path", { class: "line done", d: path(curve) }));
    return parts;
  }

  /** Evidence as signs, each where it was read; the verdict below. */
  lanes(width) {
    const { ladders } = here().branch;
    const top = this.foot + 74;
    const parts = [s("text", { class: "quiet", x: LEFT, y: top - 20 }, "Arriving's evidence: + for stopping, − against, 0 open")];
    const row = (index) => top + index * LANE;
    LANES.forEach(([, name], index) => parts.push(s("text", { class: "quiet", x: 14, y: row(index) + 4 }, name)));
    parts.push(s("text", { class: "quiet", x: 14, y: row(3) + 4 }, "verdict"));
    for (let index = 0; index < 4; index += 1)
      parts.push(s("line", { class: "grid", x1: LEFT, x2: width - RIGHT, y1: row(index), y2: row(index) }));
    if (!ladders.length) parts.push(s("text", { class: "quiet halo", x: LEFT + 8, y: row(1) + 4 }, "Arriving was not asked in this run"));
    let next = Infinity;
    for (const ladder of [...ladders].reverse()) {
      const x = this.x(ladder.step);
      LANES.forEach(([field], index) => {
        const value = ladder[field];
        const sign = s("text", { class: `halo ${value ? "" : "quiet"}`, x, y: row(index) + 5, "text-anchor": "middle" }, SIGNS[value]);
        sign.style.fontWeight = value ? "700" : "400";
        sign.style.fontSize = "15px";
        parts.push(sign);
      });
      if (next - x < 44) continue;
      const at = { class: "halo", x, y: row(3) + 5, "text-anchor": x > width - 60 ? "end" : "middle" };
      parts.push(s("text", at, ladder.verdict));
      next = x;
    }
    return parts;
  }

  here() {
    const x = this.x(state.place.step);
    return [s("line", { class: "here", x1: x, x2: x, y1: this.top - 6, y2: this.foot + 74 + 3.4 * LANE })];
  }
}
