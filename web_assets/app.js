// The page around viser's: strip, banner, timeline, waiting, keys, address.
import { at, follow, link, send, state, subscribe, tab, toast } from "./store.js";
import { h } from "./look.js";
import "./route-strip.js";
import "./rank-strip.js";
import "./timeline-bar.js";
import "./image-pair.js";
import "./wait-card.js";
import "./enlarged.js";
import "./figure.js";
import { keepInSight } from "./body.js";
import { hovering } from "./hover.js";
import { keys } from "./keys.js";
import { restore, remember } from "./address.js";

document.title = "C²Nav inspector";

const top = h("div", { id: "c2-top" });
const banner = h("div", { id: "c2-banner", role: "status" });
const tabs = h("div", { id: "c2-tabs" });
const ego = h("div", { id: "c2-ego", hidden: true });
const bare = h("div", { hidden: true }, h("span", { class: "c2-long" }, "map without the scene"), h("span", { class: "c2-short" }, "no scene"));
const seen = h("div", { hidden: true });
const menu = h("nav", { id: "c2-menu", "aria-label": "pages", hidden: true });
const pills = h("div", { id: "c2-pills" }, banner, bare, seen, ego, tabs, menu);
top.append(document.createElement("route-strip"), pills, document.createElement("wait-card"));
const lower = h("div", { id: "c2-low" }, document.createElement("timeline-bar"));
const toasts = h("div", { id: "c2-toasts", role: "status", "aria-live": "polite" });
const lost = h("div", { id: "c2-lost", role: "alert", hidden: true }, "✕ no connection to the inspector; trying again…");

function mount() {
  document.body.append(top, lower, document.createElement("enlarged-views"), toasts, lost);
  place();
  new MutationObserver(place).observe(document.getElementById("root"), { childList: true, subtree: true });
  window.addEventListener("resize", place);
}

// Those pages say how episodes ended.
const showMenu = () => (menu.hidden = !state.view || state.view.blind || !menu.children.length);

/** The pages that stand beside this one. */
async function fillMenu() {
  const beside = await (await fetch(at("api/menu"))).json();
  menu.replaceChildren(...Object.entries(beside).map(([name, words]) => h("a", { href: name }, words)));
  showMenu();
}

let watched = null;
const sizes = new ResizeObserver(() => place());

/** Keep our strip over the part of the map that no dock covers. */
function place() {
  hurry();
  const map = document.querySelector("canvas[data-engine]")?.parentElement.parentElement;
  if (map && map !== watched) {
    watched = map;
    sizes.observe(map);
  }
  const box = map?.getBoundingClientRect();
  const left = box?.width ? box.left : 0;
  const right = box?.width ? window.innerWidth - box.right : 0;
  document.documentElement.style.setProperty("--c2-left", `${left}px`);
  document.documentElement.style.setProperty("--c2-right", `${right}px`);
}

subscribe((now, changed) => {
  if (now.schema) document.documentElement.classList.remove("c2-opening");
  if (changed.has("branch")) {
    banner.textContent = now.branch.label;
    banner.classList.toggle("differs", now.branch.differs);
  }
  if (changed.has("no_scene") || changed.has("view")) {
    ego.hidden = now.view.camera !== "ego";
    ego.textContent = now.no_scene ? "no mesh to look at; the cards show what the robot saw" : "rendered here, not what the robot saw";
    bare.hidden = !now.no_scene || !ego.hidden;
    bare.title = ego.title = now.no_scene;
    showMenu();
  }
  if (changed.has("place") || changed.has("glimpse")) {
    const age = now.glimpse && !now.place.at_decision ? now.place.step - now.glimpse.step : 0;
    seen.hidden = !age;
    seen.textContent = age ? `view of ${age} ${age === 1 ? "step" : "steps"} ago` : "";
  }
  if (changed.has("pages") || changed.has("driver")) {
    const driver = now.driver ? ` · ${now.driver === tab ? "this" : "another"} one is driving` : "";
    tabs.textContent = now.pages > 1 ? `${now.pages} pages open${driver}` : "";
    tabs.hidden = now.pages < 2;
  }
  if (changed.has("notice") && now.notice.serial > 0 && now.notice.text) toast(now.notice.text, now.notice.fault);
  if (changed.has("link")) lost.hidden = link.connected;
  if (changed.has("place") || changed.has("branch") || changed.has("view")) remember(now);
});

window.addEventListener("c2-toast", ({ detail }) => {
  const node = h("div", { class: detail.fault ? "c2-toast fault" : "c2-toast" }, `${detail.fault ? "✕ " : ""}${detail.text}`);
  toasts.replaceChildren(node);
  setTimeout(() => node.remove(), detail.fault ? 9000 : 4000);
});

// Buttons inside viser's panels carry their command; the state's id is added by `send`.
document.addEventListener("click", (event) => {
  const button = event.target.closest?.("[data-command]");
  if (!button) return;
  const { type, ...fields } = JSON.parse(button.dataset.command);
  send(type, fields);
});

document.addEventListener("click", async (event) => {
  const button = event.target.closest?.("[data-copy]");
  if (!button) return;
  const text = button.dataset.copy === "address" ? window.location.href : button.dataset.copy;
  try {
    await navigator.clipboard.writeText(text);
    toast("Copied", false);
  } catch {
    window.prompt("Copy this", text);
  }
});

// Until then the server leaves the cores to this page; a second page changes nothing.
window.addEventListener(
  "c2-stands",
  () => {
    enlarge();
    fetch(at("api/standing"), { method: "POST" }).then(() => watchScene());
  },
  { once: true },
);
setTimeout(enlarge, 10_000);

/** While the map is small, docks take their place without easing in: viser's own mark for that. */
function hurry() {
  if (!document.documentElement.classList.contains("c2-first")) return;
  document.querySelector("[data-dock-root]")?.setAttribute("data-dock-resizing", "");
}

/** Give the map its place, once the decision stands or where none comes. */
function enlarge() {
  document.documentElement.classList.remove("c2-first");
  document.querySelector("[data-dock-root]")?.removeAttribute("data-dock-resizing");
}

/** Say when the scene is there; who opened without one never says it. */
function watchScene(turns = 300) {
  const nodes = window.__viserSceneTree?.getState() ?? {};
  if ("/scene/part0" in nodes) requestAnimationFrame(() => fetch(at("api/standing/scene"), { method: "POST" }));
  else if (turns > 0) setTimeout(watchScene, 100, turns - 1);
}

document.addEventListener("pointermove", hovering, { passive: true });
document.addEventListener("keydown", keys, true);
const small = () => window.dispatchEvent(new CustomEvent("c2-big", { detail: false }));
document.addEventListener("keyup", (event) => event.key.toLowerCase() === "z" && small(), true);
// A window that loses its keyboard hears of no key that is let go.
window.addEventListener("blur", small);

if (document.readyState === "loading") document.addEventListener("DOMContentLoaded", mount);
else mount();
restore();
follow();
fillMenu();
keepInSight();
window.c2nav = { state, send };
