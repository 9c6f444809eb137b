// What all elements share: one style sheet of signs and sizes, and small helpers for the DOM.

const sheet = new CSSStyleSheet();
sheet.replaceSync(`
  :host { all: initial; display: block; box-sizing: border-box; color: var(--c2-ink);
    font: 14px/1.4 var(--c2-font); font-variant-numeric: tabular-nums; }
  *, *::before, *::after { box-sizing: border-box; }
  button { font: inherit; color: inherit; }
  :focus-visible { outline: 2px solid var(--c2-blue-text); outline-offset: 2px; }
  [hidden] { display: none !important; }
`);

/** A style sheet of an element: constructed, so that a strict policy allows it. */
export function styled(text) {
  const own = new CSSStyleSheet();
  own.replaceSync(text);
  return [sheet, own];
}

const HANDLED = ["onclick", "onkeydown", "onpointerdown", "onpointerenter", "onpointerleave"];

/** Make a DOM node: h("b", { class: "x", onclick }, "text", child). */
export function h(name, attributes = {}, ...children) {
  const node = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (value === null || value === undefined || value === false) continue;
    if (HANDLED.includes(key)) node[key] = value;
    else if (key.startsWith("on")) node.addEventListener(key.slice(2), value);
    else node.setAttribute(key, value === true ? "" : value);
  }
  node.append(...children.filter((child) => child !== null && child !== undefined));
  return node;
}

/** The same for SVG. */
export function s(name, attributes = {}, ...children) {
  const node = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) {
    if (value === null || value === undefined || value === false) continue;
    if (key.startsWith("on")) node.addEventListener(key.slice(2), value);
    else node.setAttribute(key, value);
  }
  node.append(...children);
  return node;
}

/** Make what a node holds like `wanted`, with the nodes that stand there wherever they serve: one that
 *  is pressed or focused must not be exchanged under the pointer. What has a name (`data-key`,
 *  `data-name`, `data-sha`) serves only under it. */
export function renew(parent, ...wanted) {
  const kept = new Set();
  const old = [...parent.childNodes];
  const stands = wanted.filter((one) => one !== null && one !== undefined && one !== "").map((one) => {
    const next = one instanceof Node ? one : document.createTextNode(one);
    const found = old.find((node) => !kept.has(node) && (node === next || serves(node, next)));
    if (!found) return next;
    kept.add(found);
    if (found !== next) adapt(found, next);
    return found;
  });
  for (const node of old) if (!kept.has(node)) node.remove();
  stands.forEach((node, index) => {
    if (parent.childNodes[index] !== node) parent.insertBefore(node, parent.childNodes[index] ?? null);
  });
}

const named = ({ dataset }) => dataset?.key ?? dataset?.name ?? dataset?.sha;

const serves = (node, next) => node.nodeName === next.nodeName && named(node) === named(next);

function adapt(node, next) {
  if (node.nodeType === Node.TEXT_NODE) {
    if (node.data !== next.data) node.data = next.data;
    return;
  }
  // A picture's address is filled in later, and belongs to its digest.
  const own = (name) => name === "src" && node.dataset.sha;
  for (const { name } of [...node.attributes]) if (!next.hasAttribute(name) && !own(name)) node.removeAttribute(name);
  for (const { name, value } of [...next.attributes]) if (node.getAttribute(name) !== value) node.setAttribute(name, value);
  for (const name of HANDLED) if (node[name] !== next[name]) node[name] = next[name];
  renew(node, ...next.childNodes);
}

export const metres = (value) => `${value.toFixed(1)} m`;
