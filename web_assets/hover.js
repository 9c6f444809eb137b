// The frustum under the pointer lights its card, as a card lights its frustum.
// viser tells of clicks on its nodes and not of pointers above them, so the frusta are projected
// here, with the camera and the poses that its page holds.
import { send, state } from "./store.js";

const FAN = "/fan/";

let lit = "";
let waiting = null;

const three = () => window.__viserMutable?.current ?? window.__viserMutable;

/** A column-major 4 × 4 matrix times a point, divided by w; w ≤ 0 lies behind the camera. */
function times(m, [x, y, z, v = 1]) {
  const row = (i) => m[i] * x + m[4 + i] * y + m[8 + i] * z + m[12 + i] * v;
  return [row(0), row(1), row(2), row(3)];
}

/** Where a frustum stands on the page: the corners of its image plane and its tip; null behind. */
function outline(node, { fov, aspect, scale }, box) {
  const { camera } = three();
  // viser gives every frustum the same volume, whatever its opening.
  const tall = Math.tan(fov / 2);
  const wide = tall * aspect;
  const size = scale / Math.cbrt((wide * tall) / 3);
  const corners = [[-1, -1], [1, -1], [1, 1], [-1, 1]];
  const local = [...corners.map(([x, y]) => [x * wide * size, y * tall * size, size]), [0, 0, 0]];
  const points = local.map((point) => {
    const seen = times(camera.matrixWorldInverse.elements, times(node.matrixWorld.elements, point));
    const [x, y, , w] = times(camera.projectionMatrix.elements, seen);
    return w <= 0 ? null : [box.left + ((x / w + 1) / 2) * box.width, box.top + ((1 - y / w) / 2) * box.height];
  });
  return points.includes(null) ? null : points;
}

/** Whether a triangle of the page holds a point. */
function holds([a, b, c], [x, y]) {
  const side = ([px, py], [qx, qy]) => (qx - px) * (y - py) - (qy - py) * (x - px);
  const sides = [side(a, b), side(b, c), side(c, a)];
  return sides.every((one) => one >= 0) || sides.every((one) => one <= 0);
}

/** The four sides of a frustum and its image plane, as triangles of the page. */
function faces([a, b, c, d, tip]) {
  return [[a, b, c], [a, c, d], [a, b, tip], [b, c, tip], [c, d, tip], [d, a, tip]];
}

/** The offered view whose frustum lies under a point of the page; "" for none. */
export function under(point, box) {
  const nodes = window.__viserSceneTree?.getState();
  if (!nodes || !three()?.camera) return "";
  let best = { key: "", apart: Infinity };
  for (const { key, feasible } of state.decision?.cards ?? []) {
    const ref = three().nodeRefFromName[FAN + key];
    const node = ref?.current ?? ref;
    const props = nodes[FAN + key]?.message.props;
    const points = feasible && node && props?.fov ? outline(node, props, box) : null;
    if (!points || !faces(points).some((face) => holds(face, point))) continue;
    const middle = [0, 1].map((axis) => (points[0][axis] + points[2][axis]) / 2);
    const apart = Math.hypot(middle[0] - point[0], middle[1] - point[1]);
    if (apart < best.apart) best = { key, apart };
  }
  return best.key;
}

function light(key) {
  if (key === lit) return;
  lit = key;
  send("hover", { key });
}

/** Follow the pointer over the map. */
export function hovering(event) {
  const canvas = document.querySelector("canvas[data-engine]");
  if (!canvas || event.buttons) return;
  const above = event.target === canvas || canvas.parentElement?.parentElement?.contains(event.target);
  const point = [event.clientX, event.clientY];
  clearTimeout(waiting);
  if (!above) {
    if (lit) light("");
    return;
  }
  waiting = setTimeout(() => light(under(point, canvas.getBoundingClientRect())), 40);
}
