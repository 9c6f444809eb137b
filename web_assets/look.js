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

/** Make a DOM node: h("b", { class: "x", onclick }, "text", child). */
export function h(name, attributes = {}, ...children) {
  const node = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (value === null || value === undefined || value === false) continue;
    if (key.startsWith("on")) node.addEventListener(key.slice(2), value);
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

export const metres = (value) => `${value.toFixed(1)} m`;
