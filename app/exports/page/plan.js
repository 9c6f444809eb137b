// The map from above: floor and walls, the way walked by leg, goal, branches.
import { brief, go, here, state, subscribe, tale } from "./store.js";
import { h, s } from "./look.js";

const PAD = 34;
const BARS_M = [0.5, 1, 2, 5, 10, 20];

export class Plan {
  constructor() {
    this.node = h("div", { role: "tabpanel", "aria-label": "map", hidden: true });
    subscribe(() => this.draw());
    new ResizeObserver(() => this.draw()).observe(this.node);
  }

  draw() {
    const { clientWidth: width, clientHeight: height } = this.node;
    if (!width || !height || !state.schema) return;
    this.fit(width, height);
    const svg = s("svg", { class: "x-svg", viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": "map" });
    svg.append(...this.ground(), ...this.others(), ...this.way(), ...this.start(), ...this.body(), ...this.bar(width, height));
    this.node.replaceChildren(svg);
  }

  /** One scale for both axes; −z is up. */
  fit(width, height) {
    const points = tale.branches.flatMap((branch) => branch.track.map(([x, , z]) => [x, z]));
    points.push(...tale.map.reference.map(([x, , z]) => [x, z]));
    if (tale.map.goal) {
      const [x, , z] = tale.map.goal;
      points.push([x - tale.map.radius, z - tale.map.radius], [x + tale.map.radius, z + tale.map.radius]);
    }
    const low = [0, 1].map((axis) => Math.min(...points.map((point) => point[axis])));
    const high = [0, 1].map((axis) => Math.max(...points.map((point) => point[axis])));
    const top = document.querySelector(".x-top").offsetHeight + PAD + 8;
    const scale = Math.min(
      (width - 2 * PAD) / Math.max(high[0] - low[0], 1),
      (height - top - PAD - 40) / Math.max(high[1] - low[1], 1),
    );
    const left = (width - (high[0] - low[0]) * scale) / 2;
    const down = top + (height - top - PAD - 40 - (high[1] - low[1]) * scale) / 2;
    this.scale = scale;
    this.at = (x, z) => [left + (x - low[0]) * scale, down + (z - low[1]) * scale];
  }

  path(points, close = false) {
    const corners = points.map(([x, z]) => this.at(x, z).map((value) => value.toFixed(1)).join(" "));
    return `M${corners.join("L")}${close ? "Z" : ""}`;
  }

  ground() {
    const { floor, walls, goal, radius, reference } = tale.map;
    const rings = (list) => list.map((ring) => this.path(ring, true)).join("");
    const parts = [];
    if (floor.length) parts.push(s("path", { class: "floor", d: rings(floor) }));
    if (goal) {
      const [cx, cy] = this.at(goal[0], goal[2]);
      parts.push(s("circle", { class: "goal", cx, cy, r: radius * this.scale }));
    }
    if (walls.length) parts.push(s("path", { class: "walls", d: rings(walls) }));
    if (reference.length > 1)
      parts.push(s("path", { class: "line reference", d: this.path(reference.map(([x, , z]) => [x, z])) }));
    if (goal) {
      const [x, y] = this.at(goal[0], goal[2]);
      parts.push(s("path", { class: "rim", style: "stroke-dasharray:none", d: `M${x - 6} ${y}H${x + 6}M${x} ${y - 6}V${y + 6}` }));
      parts.push(s("text", { class: "halo", x: x + 9, y: y - 7 }, `goal, ${+radius.toFixed(2)} m`));
    }
    return parts;
  }

  others() {
    const parts = [];
    for (const branch of tale.branches) {
      if (branch === here().branch || branch.track.length < 2) continue;
      const points = branch.track.map(([x, , z]) => [x, z]);
      parts.push(s("path", { class: "line other", d: this.path(points) }, s("title", {}, branch.branch.label)));
      const [x, y] = this.at(...points.at(-1));
      parts.push(s("text", { class: "quiet halo", x: x - 7, y: y + 4, "text-anchor": "end" }, brief(branch)));
    }
    return parts;
  }

  /** Legs that are done in ink, the active one blue, what comes later dashed. */
  way() {
    const { branch } = here();
    const { step } = state.place;
    const legs = branch.timeline.legs;
    const points = branch.track.map(([x, , z]) => [x, z]);
    const parts = [];
    const labels = [];
    if (step < points.length - 1)
      parts.push(s("path", { class: "line ahead", d: this.path(points.slice(step)) }));
    legs.forEach(({ leg, step: start }, index) => {
      const from = index ? start : 0;
      const to = Math.min(step, legs[index + 1]?.step ?? points.length - 1);
      const now = leg === state.episode.leg;
      if (to > from) {
        const d = this.path(points.slice(from, to + 1));
        parts.push(s("path", { class: "case", d }), s("path", { class: `line ${now ? "now" : "done"}`, d }));
      }
      if (legs.length > 1) labels.push(this.number(leg, points[from]));
    });
    for (const { decision } of branch.decisions) {
      if (!decision || decision.lane !== "Seeing") continue;
      const mark = branch.timeline.marks[decision.number];
      const [cx, cy] = this.at(...points[Math.min(mark.step, points.length - 1)]);
      const spot = s("circle", { class: `spot ${decision.number === state.place.decision ? "now" : ""}`, cx, cy, r: 4.5 });
      spot.append(s("title", {}, mark.words));
      spot.addEventListener("click", () => go({ decision: decision.number }));
      parts.push(spot);
    }
    return [...parts, ...labels];
  }

  number(leg, [x, z]) {
    const [cx, cy] = this.at(x, z);
    return s(
      "g",
      { class: "leg", transform: `translate(${cx + 15} ${cy - 15})` },
      s("circle", { r: 10 }),
      s("text", { y: 4 }, `${leg + 1}`),
    );
  }

  start() {
    const [x, , z] = here().branch.track[0];
    const [px, py] = this.at(x, z);
    return [
      s("rect", { class: "start", x: px - 5, y: py - 5, width: 10, height: 10 }),
      s("text", { class: "halo", x: px, y: py + 20, "text-anchor": "middle" }, "start"),
    ];
  }

  body() {
    const [x, , z, yaw] = here().branch.track[state.place.step];
    const [px, py] = this.at(x, z);
    const turn = (-yaw * 180) / Math.PI;
    return [s("path", { class: "body", d: "M0 -14L9 9L0 4.5L-9 9Z", transform: `translate(${px} ${py}) rotate(${turn})` })];
  }

  bar(width, height) {
    const metres = BARS_M.filter((bar) => bar * this.scale <= 160).at(-1) ?? BARS_M[0];
    const [x, y] = [width - 18, height - 20];
    return [
      s("line", { class: "bar", x1: x - metres * this.scale, x2: x, y1: y, y2: y }),
      s("text", { class: "halo", x: x - metres * this.scale - 6, y: y + 4, "text-anchor": "end" }, `${metres} m`),
    ];
  }
}
