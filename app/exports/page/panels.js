// What stands left and right of the view: the question, every answer, the run, its evidence.
import { go, here, image, stand, state, tale } from "./store.js";
import { h } from "./look.js";

const EVIDENCE = { 1: "+ for stopping", 0: "0 open", [-1]: "− against" };

const heading = (text) => h("h2", {}, text);

/** Name and value, a pair a line. */
function facts(rows) {
  const list = h("dl", { class: "c2-facts" });
  for (const [name, value] of rows) if (value) list.append(h("dt", {}, name), h("dd", {}, value));
  return list;
}

/** Below the cards: the question as sent, all answers, what was done, what the controller knew. */
export function asked(shown) {
  if (!shown) return [];
  const parts = [];
  if (shown.question.length) {
    parts.push(heading("Asked, as it was sent"), question(shown.question), ...answers(shown));
  }
  parts.push(heading("Committed"), facts(shown.committed), heading("Controller"), facts(shown.controller));
  return parts;
}

function question(parts) {
  const text = h("pre", { class: "c2-pre x-q" });
  for (const part of parts) {
    if (typeof part === "string") text.append(part);
    else text.append(h("img", { src: image(part.sha), alt: "picture" }));
  }
  return text;
}

function answers(shown) {
  if (!shown.answers.length && !shown.override) return [heading("Answers"), h("p", { class: "c2-note" }, "None is recorded")];
  const rows = shown.answers.map((answer) =>
    h(
      "tr",
      {},
      h("td", { title: answer.shown.map(({ label, name }) => `${label}: ${name}`).join(", ") }, order(answer)),
      h("td", { class: "x-answer" }, answer.raw || "–"),
      h(
        "td",
        {},
        answer.outcome,
        answer.differs || answer.fault ? h("span", { class: "x-sign", title: "differs from the first order" }, " ✕") : "",
        answer.cost ? h("small", {}, answer.cost) : "",
      ),
    ),
  );
  const who = shown.privileged ? `${shown.ranker} · privileged` : shown.ranker;
  const table = h(
    "table",
    { class: "c2-table" },
    h("thead", {}, h("tr", {}, h("th", {}, "shown"), h("th", {}, "answer as it came"), h("th", {}, "meant"))),
    h("tbody", {}, ...rows),
  );
  const parts = [heading(`All answers · ${who}`), table];
  if (shown.override) parts.push(h("p", { class: "c2-note" }, h("span", { class: "c2-override" }, "◆ override "), shown.override));
  return parts;
}

/** Views in the order in which they were shown, by the letters of the cards. */
function order(answer) {
  const letters = answer.shown.map(({ letter }) => letter).join(" ");
  return answer.attempt ? `${letters}, reminded` : letters;
}

/** The run: facts, branches, evidence, sketch. */
export function about() {
  const { branch } = here();
  return [...branches(), ...suspects(branch), ...evidence(branch), ...sketch(branch), heading("This run"), facts(branch.facts), heading("Provenance"), provenance(branch)];
}

const LISTED = 6;

/** Decisions worth a look, worst first; the agent never read this. */
function suspects(branch) {
  if (!branch.suspects.length) return [];
  const listed = branch.suspects.slice(0, LISTED);
  const rows = listed.map(({ decision, words }) =>
    h(
      "tr",
      {},
      h("td", {}, h("button", { class: "c2-link", type: "button", onclick: () => go({ decision }) }, `decision ${decision}`)),
      h("td", {}, branch.decisions[decision].decision.words),
      h("td", {}, words),
    ),
  );
  const count = branch.suspects.length;
  const said = count > LISTED ? `Suspects, the worst ${LISTED} of ${count}` : "Suspects, worst first";
  return [heading(said), h("table", { class: "c2-table" }, h("tbody", {}, ...rows))];
}

function provenance(branch) {
  return facts([
    ["trace", branch.source],
    ["sha256", branch.sha256.slice(0, 16)],
    ["licence", tale.licence],
  ]);
}

function branches() {
  if (tale.branches.length < 2) return [];
  const list = h("ul", { class: "x-branches" });
  for (const branch of tale.branches) {
    const now = branch === here().branch;
    const fork = branch.branch.fork;
    const button = h(
      "button",
      { type: "button", "aria-pressed": `${now}`, onclick: () => change(branch) },
      h("span", { class: now ? "x-strong" : null }, branch.branch.label),
      h("small", {}, branch.source),
    );
    list.append(h("li", { class: now ? "now" : null, style: fork >= 0 ? "margin-left:14px" : null }, button));
  }
  return [heading("Branches"), list];
}

/** The same decision on another branch, or the one at which it left its parent. */
function change(branch) {
  const fork = branch.branch.fork;
  const number = fork >= 0 ? fork : state.place.decision;
  const stop = branch.stops.findIndex(([, decision, at]) => at && decision >= number);
  stand(stop < 0 ? 0 : stop, branch);
}

function evidence(branch) {
  const { decision } = state.place;
  const ladder = branch.ladders.findLast((each) => each.decision <= decision);
  if (!ladder) {
    const words = branch.ladders.length ? "Not asked yet" : "Arriving was not asked in this run";
    return [heading("Evidence"), h("p", { class: "c2-note" }, words)];
  }
  const cell = (name, value) => h("div", { "data-value": `${value}` }, h("span", {}, name), h("b", {}, EVIDENCE[value]));
  return [
    heading(`Evidence after decision ${ladder.decision}`),
    h("div", { class: "x-evidence" }, cell("ground", ladder.ground), cell("journey", ladder.journey), cell("look-back", ladder.lookback)),
    facts([
      ["verdict", h("b", {}, ladder.verdict)],
      ["vetoes", ladder.vetoes.length ? h("span", {}, h("span", { class: "x-sign" }, "✕ "), ladder.vetoes.join(", ")) : ""],
      ["look-backs", `${ladder.budget} left`],
      ["markers", ladder.markers ? `${ladder.markers}` : ""],
      ["event", ladder.event],
    ]),
  ];
}

function sketch(branch) {
  const { decision } = state.place;
  const entry = branch.sketches.findLast((each) => each.decision < decision);
  if (!entry) return [];
  const support = entry.advanced ? "the leg advanced" : `${entry.support} in a row for the next leg`;
  return [
    heading("Route sketch, as the prompt says it"),
    h("pre", { class: "c2-pre" }, entry.rendering || "–"),
    facts([
      ["gate", entry.gate ? "open" : "closed"],
      ["support", support],
      ["cue", entry.cue],
    ]),
  ];
}

