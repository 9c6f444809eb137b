// Stands in for the inspector's store: the same state, read from the page instead of a server.

const listeners = new Set();
const read = (id) => JSON.parse(document.getElementById(id).textContent);

export const tale = read("x-tale");
const pictures = read("x-pictures");
const addresses = new Map();

export const state = {};
export const tab = "page";
export const link = { connected: true };

let branch = tale.branches[0];
let stop = 0;

/** The branch in view, and where one stands in it. */
export const here = () => ({ branch, stop });

export function subscribe(listener) {
  listeners.add(listener);
  if (state.schema) listener(state, new Set(Object.keys(state)));
  return () => listeners.delete(listener);
}

/** A branch in a word or two, for labels among lines. */
export const brief = ({ branch }) => (branch.fork >= 0 ? `fork at ${branch.fork}` : "recorded");

const MISSING =
  "data:image/svg+xml," +
  encodeURIComponent(
    `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 224 224"><rect width="224" height="224" fill="#8a94a6" opacity=".18"/>` +
      `<text x="112" y="118" text-anchor="middle" font-family="sans-serif" font-size="15" fill="#717c90">picture left out</text></svg>`,
  );

/** The bytes as they were sent, as an address of this page. */
export function image(sha) {
  if (!(sha in pictures)) return MISSING;
  if (!addresses.has(sha)) {
    const bytes = Uint8Array.from(atob(pictures[sha]), (letter) => letter.charCodeAt(0));
    addresses.set(sha, URL.createObjectURL(new Blob([bytes], { type: "image/jpeg" })));
  }
  return addresses.get(sha);
}

/** Stand at a stop of a branch. */
export function stand(nextStop, nextBranch = branch) {
  branch = nextBranch;
  stop = Math.max(0, Math.min(nextStop, branch.stops.length - 1));
  const [step, number, at] = branch.stops[stop];
  const shown = branch.decisions[Math.max(0, number)] ?? null;
  Object.assign(state, {
    schema: tale.schema,
    episode: { ...branch.episode, leg: shown?.decision?.leg ?? 0 },
    decision: shown?.decision ?? null,
    lookback: shown?.lookback ?? null,
    timeline: branch.timeline,
    place: { step, decision: number, at_decision: at, stop, stops: branch.stops.length },
    branch: branch.branch,
    draft: { tiers: [], none: false, tie_next: false },
    asking: null,
    offer: null,
    pending: false,
    playing: "",
    view: { camera: "free", layers: [], hovered: "" },
    shown,
  });
  const changed = new Set(Object.keys(state));
  for (const listener of [...listeners]) listener(state, changed);
}

const first = (test) => branch.stops.findIndex(test);

/** Stand where a decision is taken, or at the last place of a step. */
export function go({ decision, step }) {
  if (decision !== undefined) stand(Math.max(0, first(([, number, at]) => at && number >= decision)));
  else stand(branch.stops.findLastIndex(([at]) => at <= step));
}

/** Forwards or back by decision or by step. */
export function move(by, count) {
  if (by === "step") {
    const [step] = branch.stops[stop];
    const next = step + count;
    if (next >= 0 && next <= branch.track.length - 1) go({ step: next });
    return;
  }
  const ahead = branch.stops.map(([, , at], index) => (at ? index : -1)).filter((index) => index >= 0);
  const next = count > 0 ? ahead.find((index) => index > stop) : ahead.findLast((index) => index < stop);
  if (next !== undefined) stand(next);
}

/** What the inspector's elements send; a recording only moves. */
export async function send(type, fields = {}) {
  if (type === "go") go(fields);
  return true;
}

export function follow() {}
export function toast() {}
export const at = (path) => path;
