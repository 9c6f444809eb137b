// Everything wrong with the layout of the page as it stands, in words.
() => {
  const found = [];
  const box = (node) => node.getBoundingClientRect();
  const seen = (node) => box(node).width > 0 && box(node).height > 0;
  const name = (node) => `${node.localName}.${node.className} "${node.textContent.trim().slice(0, 40)}"`;
  const all = (selector) => [...document.querySelectorAll(selector)].filter(seen);
  const root = document.documentElement;
  if (root.scrollWidth > innerWidth) found.push(`the page is ${root.scrollWidth - innerWidth} px too wide`);

  for (const node of all(".c2-pane, .c2-pane button, .c2-pane dd"))
    if (node.scrollWidth > node.clientWidth + 1 && getComputedStyle(node).display !== "inline")
      found.push(`${name(node)} is ${node.scrollWidth - node.clientWidth} px too wide`);
  for (const host of all("rank-strip, image-pair, route-strip, wait-card"))
    for (const node of host.shadowRoot.querySelectorAll("*")) {
      // A card clips what it holds.
      const shown = node.closest(".cards .card") ?? node;
      if (seen(node) && box(shown).right > box(host).right + 1) found.push(`${name(node)} leaves ${host.localName}`);
    }

  const canvas = box(document.querySelector("canvas[data-engine]"));
  for (const node of all("#c2-top route-strip, #c2-pills > *, #c2-top wait-card"))
    if (box(node).left < canvas.left - 1 || box(node).right > canvas.right + 1)
      found.push(`${name(node)} lies over a dock`);
  const bar = box(document.querySelector("timeline-bar"));
  if (Math.abs(bar.bottom - innerHeight) > 1 || Math.abs(bar.width - innerWidth) > 1)
    found.push(`the timeline stands at ${bar.left}–${bar.right}, ${bar.top}–${bar.bottom}`);
  for (const node of all("[data-dock-region]"))
    if (box(node).bottom > bar.top + 1) found.push("a dock lies over the timeline");

  const light = (colour) => {
    const [r, g, b] = colour.match(/[\d.]+/g).map((part) => Number(part) / 255)
      .map((part) => (part <= 0.03928 ? part / 12.92 : ((part + 0.055) / 1.055) ** 2.4));
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
  };
  const ground = (node) => {
    for (let at = node; at; at = at.parentElement ?? at.getRootNode().host) {
      const colour = getComputedStyle(at).backgroundColor;
      if (!/^rgba\(.*, 0\)$|transparent/.test(colour)) return colour;
    }
    return "rgb(255, 255, 255)";
  };
  const texts = (root) => [...root.querySelectorAll("*")].filter((node) =>
    seen(node) && [...node.childNodes].some((child) => child.nodeType === 3 && child.data.trim()));
  const roots = [...all(".c2-pane"), ...all("rank-strip, image-pair, route-strip, wait-card").map((e) => e.shadowRoot)];
  for (const node of roots.flatMap(texts)) {
    if (node.localName === "text" || node.localName === "style") continue;
    const [high, low] = [light(getComputedStyle(node).color), light(ground(node))].sort((a, b) => b - a);
    const contrast = (high + 0.05) / (low + 0.05);
    // A sign that stands beside words is a mark, not text.
    const needed = /^[✕◆●▲■○△□✓]$/.test(node.textContent.trim()) ? 3 : 4.5;
    if (contrast < needed) found.push(`${name(node)} has a contrast of ${contrast.toFixed(1)}`);
    if (parseFloat(getComputedStyle(node).fontSize) < 11.9) found.push(`${name(node)} is smaller than 12 px`);
  }
  return [...new Set(found)];
}
