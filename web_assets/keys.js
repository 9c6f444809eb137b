// Keys. They are handled here and not by viser, whose callbacks run in no order.
import { send, state } from "./store.js";
import { sheet } from "./sheet.js";

const PLAIN = {
  n: () => send("move", { by: "decision", count: 1 }),
  p: () => send("move", { by: "decision", count: -1 }),
  arrowright: () => send("move", { by: "step", count: 1 }),
  arrowleft: () => send("move", { by: "step", count: -1 }),
  " ": () => send(state.playing ? "pause" : "play"),
  enter: () => send("commit"),
  backspace: () => send("take_back"),
  "=": () => send("tie"),
  x: () => send("none"),
  escape: () => send("clear"),
  "[": () => send("jump", { to: "previous_disagreement" }),
  "]": () => send("jump", { to: "next_disagreement" }),
  b: () => send("jump", { to: "first_suspect" }),
  a: () => send("verdict", { value: "agree" }),
  s: () => send("verdict", { value: "acceptable" }),
  w: () => send("verdict", { value: "wrong" }),
  c: () => send("verdict", { value: "cannot tell" }),
  t: () => openTab("Review"),
  f: () => send("flag"),
  v: () => send("reveal"),
  u: () => send("undo"),
  r: () => send("redo"),
  g: () => send("layer", { name: "goal", on: !state.view.layers.includes("goal") }),
  z: () => window.dispatchEvent(new CustomEvent("c2-big", { detail: true })),
  "?": () => sheet.toggle(),
};

/** Show one of viser's dock tabs. */
function openTab(name) {
  const tabs = [...document.querySelectorAll("[data-dock-strip] [role=tab]")];
  const tab = tabs.find((one) => one.textContent.trim() === name);
  tab?.dispatchEvent(new PointerEvent("pointerdown", { bubbles: true, button: 0, pointerId: 1 }));
  tab?.dispatchEvent(new PointerEvent("pointerup", { bubbles: true, button: 0, pointerId: 1 }));
  tab?.click();
}

/** Whether a key belongs to something that is being typed into or worked with. */
function taken(event) {
  const target = event.composedPath()[0];
  if (!(target instanceof Element)) return false;
  if (target.closest("input, textarea, select, [contenteditable], [role=slider], [role=combobox]")) return true;
  // A focused card whose ranking is being made lets Enter commit it.
  if (event.key === "Enter" && target.closest(".card") && state.decision?.source === "draft") return false;
  // A focused button keeps Space and Enter for itself.
  return (event.key === " " || event.key === "Enter") && target.closest("button, a") !== null;
}

const PALETTE = "[data-mantine-shared-portal-node] [role=dialog]";
const PATIENCE_MS = 5000;

// What is typed after Ctrl K belongs to the palette, which takes a moment until it is there.
let hasty = null;

const opensPalette = (event) =>
  (event.ctrlKey || event.metaKey) && !event.altKey && event.code === (event.shiftKey ? "KeyP" : "KeyK");

/** Hold what is typed until the palette can take it; returns whether the key was held. */
function held(event) {
  if (hasty) deliver(document.activeElement);
  if (!hasty) return false;
  if (taken(event)) {
    hasty = null;
    return false;
  }
  if (event.key === "Escape" || (performance.now() - hasty.since > PATIENCE_MS && !document.querySelector(PALETTE))) {
    hasty = null;
    return event.key === "Escape";
  }
  if (event.ctrlKey || event.metaKey || event.altKey || /^(Shift|Control|Meta|Alt|AltGraph)$/.test(event.key)) return true;
  event.preventDefault();
  event.stopPropagation();
  if (event.key === "Backspace") hasty.text = hasty.text.slice(0, -1);
  else if (event.key.length === 1) hasty.text += event.key;
  return true;
}

/** Give the palette's field what was typed before it was there. */
function deliver(field) {
  if (!hasty || !field?.matches(`${PALETTE} input`)) return;
  const { text } = hasty;
  hasty = null;
  if (!text) return;
  // The field belongs to React, which hears of a value that its own setter did not see.
  const { set } = Object.getOwnPropertyDescriptor(HTMLInputElement.prototype, "value");
  set.call(field, field.value + text);
  field.dispatchEvent(new InputEvent("input", { bubbles: true, data: text, inputType: "insertText" }));
}

document.addEventListener("focusin", ({ target }) => deliver(target));
document.addEventListener("pointerdown", () => (hasty = null), true);

export function keys(event) {
  if (sheet.open) {
    // The browser closes it on Escape by itself.
    if (event.key === "?" || opensPalette(event)) sheet.toggle();
    if (event.key === "?") event.preventDefault();
    if (!opensPalette(event)) return;
  }
  if (document.querySelector("dialog[open]")) return;
  if (opensPalette(event) && !taken(event)) hasty = { since: performance.now(), text: "" };
  else if (held(event)) return;
  if (event.ctrlKey || event.metaKey || event.altKey || taken(event)) return;
  if (document.querySelector(PALETTE)) return;
  const key = event.key.toLowerCase();
  let action = PLAIN[key];
  if (event.shiftKey && key === "b") action = () => send("jump", { to: "worst_suspect" });
  // Shift and a digit have a sign of their own on every keyboard: the key's place tells the digit.
  if (event.shiftKey && /^Digit[1-9]$/.test(event.code))
    action = () => send("better", { position: Number(event.code.at(-1)) - 1 });
  else if (/^[1-9]$/.test(key)) action = () => send("press", { position: Number(key) - 1 });
  if (!action || (event.repeat && key !== "arrowright" && key !== "arrowleft")) return;
  event.preventDefault();
  event.stopPropagation();
  action();
}
