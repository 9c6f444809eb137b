// The address restores the view: branch, decision or step, camera, layers.
import { send, state, subscribe } from "./store.js";

const NAMES = ["branch", "decision", "step", "camera", "layers"];

/** On a fresh visit, go where the address says; a reload only shows what is there. */
export function restore() {
  const asked = new URL(window.location.href).searchParams;
  const reload = performance.getEntriesByType("navigation")[0]?.type === "reload";
  if (reload || !NAMES.some((name) => asked.has(name))) return;
  const stop = subscribe(() => {
    if (!state.schema) return;
    queueMicrotask(() => stop());
    const at = { branch: asked.get("branch") ?? "" };
    if (asked.has("decision")) at.decision = Number(asked.get("decision"));
    else if (asked.has("step")) at.step = Number(asked.get("step"));
    if (`${at.decision}` !== `${state.place.decision}` || at.step !== undefined) send("go", at);
    if (asked.has("camera") && asked.get("camera") !== state.view.camera) send("camera", { mode: asked.get("camera") });
    if (!asked.has("layers")) return;
    const shown = asked.get("layers").split(",");
    for (const name of new Set([...shown, ...state.view.layers])) {
      const on = shown.includes(name);
      if (name && on !== state.view.layers.includes(name)) send("layer", { name, on });
    }
  });
}

let wanted = null;

/** Write the view into the address, a few times a second at most. */
export function remember(now) {
  const fields = { camera: now.view.camera === "free" ? null : now.view.camera };
  const layers = now.view.layers.join(",");
  fields.layers = layers === now.view.layers_at_first.join(",") ? null : layers;
  fields.branch = now.branches.length > 1 ? now.branch.id : null;
  fields.decision = now.place.at_decision && now.place.decision >= 0 ? now.place.decision : null;
  fields.step = now.place.at_decision ? null : now.place.step;
  if (wanted === null) setTimeout(write, 300);
  wanted = fields;
}

function write() {
  const address = new URL(window.location.href);
  for (const [name, value] of Object.entries(wanted)) {
    if (value === null) address.searchParams.delete(name);
    else address.searchParams.set(name, value);
  }
  wanted = null;
  if (address.href !== window.location.href) window.history.replaceState(null, "", address);
}
