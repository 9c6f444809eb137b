// What text of the page is too small or too faint, as "element size contrast: words".
() => {
  const linear = (value) => (value <= 10.31 ? value / 3294.6 : ((value / 255 + 0.055) / 1.055) ** 2.4);
  const light = ([r, g, b]) => 0.2126 * linear(r) + 0.7152 * linear(g) + 0.0722 * linear(b);
  const rgba = (text) => {
    const [r, g, b, a = 1] = (text.match(/[\d.]+/g) ?? [0, 0, 0, 0]).map(Number);
    return [r, g, b, a];
  };
  const above = (node) => node.parentElement ?? node.getRootNode().host;
  const chain = (node) => (node ? [node, ...chain(above(node))] : []);
  const mixed = (top, share, ground) => [0, 1, 2].map((i) => top[i] * share + ground[i] * (1 - share));

  /** The colour behind an element; null over a picture or the map. */
  function ground(node) {
    const layers = [];
    for (const one of chain(node)) {
      const colour = rgba(getComputedStyle(one).backgroundColor);
      layers.unshift(colour);
      if (colour[3] > 0.95) return layers.reduce((under, top) => mixed(top, top[3], under));
    }
    return null;
  }

  const words = (node) => {
    if (/^(INPUT|TEXTAREA)$/.test(node.tagName)) return /checkbox|radio|range/.test(node.type) ? "" : node.value;
    if (/^(SCRIPT|STYLE|TITLE)$/i.test(node.tagName)) return "";
    return [...node.childNodes].filter((one) => one.nodeType === 3).map((one) => one.textContent.trim()).join(" ").trim();
  };

  function shown(node) {
    const box = node.getBoundingClientRect();
    const inside = box.width && box.height && box.bottom > 0 && box.right > 0;
    if (!inside || box.top > innerHeight || box.left > innerWidth) return false;
    return node.checkVisibility({ opacityProperty: true, visibilityProperty: true });
  }

  function fault(node) {
    const said = words(node);
    if (!said || !shown(node) || node.disabled || node.closest(":disabled")) return null;
    const style = getComputedStyle(node);
    const behind = ground(node instanceof SVGElement ? above(node.closest("svg")) : node);
    if (!behind) return null;
    const colour = rgba(node instanceof SVGElement ? style.fill : style.color);
    const share = chain(node).reduce((all, one) => all * Number(getComputedStyle(one).opacity), colour[3]);
    const [low, high] = [light(mixed(colour, share, behind)), light(behind)].sort((a, b) => a - b);
    const contrast = (high + 0.05) / (low + 0.05);
    const size = parseFloat(style.fontSize);
    // Signs of the timeline are marks.
    const needed = node instanceof SVGElement && !/[\p{L}\p{N}]/u.test(said) ? 3 : 4.5;
    if (size >= 12 && contrast >= needed) return null;
    return `${node.tagName} ${size.toFixed(1)} ${contrast.toFixed(1)}: ${said.slice(0, 30)}`;
  }

  const every = (root) =>
    [...root.querySelectorAll("*")].flatMap((node) => [node, ...(node.shadowRoot ? every(node.shadowRoot) : [])]);
  const nodes = every(document.body);
  return { read: nodes.filter((node) => words(node) && shown(node)).length, faults: nodes.map(fault).filter(Boolean) };
}
