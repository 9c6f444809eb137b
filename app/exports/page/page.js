// The page: title, cards, view, run, timeline; keys; light and dark.
import { here, move, stand, state, subscribe, tale } from "./store.js";
import { h } from "./look.js";
import "./route-strip.js";
import "./rank-strip.js";
import "./timeline-bar.js";
import "./image-pair.js";
import { about, asked } from "./panels.js";
import { Curves } from "./curves.js";
import { Plan } from "./plan.js";
import { World, present } from "./world.js";

const STEP_MS = 180;

// ---------------------------------------------------------------- light and dark

const root = document.documentElement;
const theme = h("button", { class: "x-button", type: "button", onclick: () => colour() });

function colour() {
  root.dataset.mantineColorScheme = root.dataset.mantineColorScheme === "dark" ? "light" : "dark";
  name();
  world?.wake(true);
}

function name() {
  theme.textContent = root.dataset.mantineColorScheme === "dark" ? "Light" : "Dark";
}

// ---------------------------------------------------------------- the views in the middle

const world = present ? new World() : null;
const views = [...(world ? [["3-D", world]] : []), ["Map", new Plan()], ["Curves", new Curves()]];
const tabs = h("div", { class: "x-tabs", role: "tablist" });
const middle = h("main", { class: "x-middle" }, h("div", { class: "x-top" }, document.createElement("route-strip")), tabs);

for (const [label, view] of views) {
  const tab = h("button", { class: "x-button", type: "button", role: "tab", onclick: () => show(label) }, label);
  tabs.append(tab);
  middle.append(view.node);
}

function show(wanted) {
  views.forEach(([label, view], index) => {
    const on = label === wanted;
    view.node.hidden = !on;
    tabs.children[index].setAttribute("aria-selected", `${on}`);
    if (on && view === world) world.wake();
    else if (on) view.draw();
  });
}

// ---------------------------------------------------------------- going through it

let playing = null;
const play = h("button", { class: "x-button", type: "button", onclick: () => toggle() }, "Play");

function toggle() {
  if (playing) clearInterval(playing);
  playing = playing ? null : setInterval(step, STEP_MS);
  play.textContent = playing ? "Pause" : "Play";
  if (playing && state.place.step >= here().branch.timeline.last) stand(0);
}

function step() {
  if (state.place.stop >= here().branch.stops.length - 1) toggle();
  else stand(state.place.stop + 1);
}

const button = (label, title, onclick) => h("button", { class: "x-button", type: "button", title, onclick }, label);

const KEYS = {
  n: () => move("decision", 1),
  p: () => move("decision", -1),
  arrowright: () => move("step", 1),
  arrowleft: () => move("step", -1),
  home: () => stand(0),
  end: () => stand(Infinity),
  " ": toggle,
};

document.addEventListener("keydown", (event) => {
  const inside = event.composedPath()[0];
  if (event.ctrlKey || event.metaKey || event.altKey) return;
  if (event.key === " " && inside instanceof Element && inside.closest("button")) return;
  const act = KEYS[event.key.toLowerCase()];
  if (!act) return;
  event.preventDefault();
  act();
});

// ---------------------------------------------------------------- the frame around it

const ended = h("span", { class: "x-chip" });
const cards = document.createElement("rank-strip");
const pair = document.createElement("image-pair");
const below = h("div", { class: "x-pane" });
const right = h("aside", { class: "x-right", "aria-label": "run" });

const bar = h(
  "header",
  { class: "x-bar" },
  h("h1", {}, tale.title),
  ended,
  h("span", { class: "x-chip", title: "licence of the scene's pictures" }, `licence: ${tale.licence}`),
  h("span", { class: "x-space" }),
  button("◀", "previous decision (P)", () => move("decision", -1)),
  play,
  button("▶", "next decision (N)", () => move("decision", 1)),
  theme,
);

const notes = tale.left_out.map((text) => h("p", { class: "x-note" }, text));
document.body.append(
  bar,
  h("section", { class: "x-left", "aria-label": "decision" }, ...notes, cards, pair, below),
  middle,
  right,
  h("footer", { class: "x-low" }, document.createElement("timeline-bar")),
);

// A recording is looked at, not answered: the cards keep their look and lose their buttons.
const still = new CSSStyleSheet();
still.replaceSync(".card { pointer-events: none; cursor: default; } .rail button { display: none; }");
cards.shadowRoot.adoptedStyleSheets = [...cards.shadowRoot.adoptedStyleSheets, still];

subscribe(() => {
  const { branch } = here();
  ended.textContent = branch.ended;
  ended.className = branch.success ? "x-chip good" : "x-chip";
  pair.hidden = state.decision?.slot !== "lookback";
  const top = below.scrollTop;
  below.replaceChildren(...asked(state.shown));
  below.scrollTop = top;
  right.replaceChildren(...about());
});

name();
const wanted = /^#(\d+)$/.exec(window.location.hash);
stand(0);
if (wanted) stand(Math.max(0, here().branch.stops.findIndex(([, number, at]) => at && number >= +wanted[1])));
show(views[0][0]);
window.c2nav = { state, stand, here };
