// The body is drawn over all else: the cut leaves cupboards standing that would hide it.
// viser has no such switch for a mesh, so the one that its page holds is changed.
import { subscribe } from "./store.js";

const BODY = "/body";

const held = () => window.__viserMutable?.current ?? window.__viserMutable;

/** Whether the body is there, and now over all else. */
function lift() {
  const ref = held()?.nodeRefFromName[BODY];
  let found = false;
  (ref?.current ?? ref)?.traverse((part) => {
    if (!part.isMesh) return;
    found = true;
    if (!part.material.depthTest) return;
    // What shines through is drawn after what does not.
    Object.assign(part.material, { depthTest: false, transparent: true, needsUpdate: true });
    part.renderOrder = 1;
    held().requestRender?.();
  });
  return found;
}

/** Look for the body until it has arrived. */
function find(turns = 300) {
  if (!lift() && turns > 0) setTimeout(find, 100, turns - 1);
}

/** Keep the body in sight, also once viser has made it anew. */
export function keepInSight() {
  find();
  subscribe((_, changed) => {
    if (changed.has("place") || changed.has("link")) lift();
  });
}
