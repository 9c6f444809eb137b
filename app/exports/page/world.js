// viser's own page of the scene, in a frame that wakes when it is first looked at.
import { here, state, subscribe } from "./store.js";
import { h } from "./look.js";

const LIFT_M = 0.04;

/** viser's hints about the machine, and its tree of nodes, are not what a reader came for. */
const CALM = `#webgl-software-rendering, .mantine-Paper-root:has(> [aria-label$="scene tree"]) { display: none !important; }`;
const source = JSON.parse(document.getElementById("x-world").textContent);

/** Whether the page holds a 3-D view. */
export const present = source !== "";

export class World {
  constructor() {
    this.loading = h("div", { class: "x-loading" }, "Unpacking the 3-D view…");
    this.node = h("div", { role: "tabpanel", "aria-label": "3-D view" }, this.loading);
    this.frame = null;
    subscribe(() => this.place());
  }

  /** Open the view, or open it again in the other colours. */
  wake(fresh = false) {
    if (this.frame && !fresh) return;
    const dark = document.documentElement.dataset.mantineColorScheme === "dark";
    this.frame?.remove();
    this.frame = h("iframe", { class: "x-world", title: "3-D view: drag to turn, scroll to come closer" });
    const dressed = source.replace("</head>", `<style>${CALM}</style></head>`);
    this.frame.srcdoc = dressed.replace("darkMode:false", `darkMode:${dark}`);
    this.node.append(this.frame);
    this.wait();
  }

  wait() {
    const inside = this.inside();
    if (!inside) {
      setTimeout(() => this.wait(), 100);
      return;
    }
    this.loading.hidden = true;
    this.place();
  }

  /** viser's state, once the body is in it. */
  inside() {
    const mutable = this.frame?.contentWindow?.__viserMutable;
    return mutable?.nodePoseData?.["/body"] ? mutable : null;
  }

  /** Stand the body where the page stands. */
  place() {
    const mutable = this.inside();
    const pose = here().branch.track[state.place?.step];
    if (!mutable || !pose) return;
    const [x, y, z, yaw] = pose;
    mutable.nodePoseData["/body"] = {
      wxyz: [Math.cos(yaw / 2), 0, Math.sin(yaw / 2), 0],
      position: [x, y + LIFT_M, z],
      poseUpdateState: "needsUpdate",
    };
    mutable.requestRender();
  }
}
