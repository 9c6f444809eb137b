// Runs before viser's own script: chooses light or dark, which viser only reads from the address.
// Our own view lives in search parameters, never in the hash: viser builds its websocket address
// from everything before the question mark.
(() => {
  const system = window.matchMedia("(prefers-color-scheme: dark)");
  const apply = () => {
    const address = new URL(window.location.href);
    const asked = address.searchParams.get("theme");
    const dark = asked ? asked === "dark" : system.matches;
    document.documentElement.classList.toggle("c2-dark", dark);
    if (dark !== address.searchParams.has("darkMode")) {
      if (dark) address.searchParams.set("darkMode", "1");
      else address.searchParams.delete("darkMode");
      window.history.replaceState(null, "", address);
    }
    return dark;
  };
  apply();
  // viser has read the address by then; its colours hang on this one mark.
  system.addEventListener("change", () => {
    document.documentElement.dataset.mantineColorScheme = apply() ? "dark" : "light";
  });
})();

// The map is drawn into a few pixels until the decision in view stands: where no GPU draws it, each
// of viser's first empty frames at full size takes as long as all of the page's own work.
document.documentElement.classList.add("c2-opening", "c2-first");

// viser brings a panorama to light a scene with, and begins to unpack it, on the GPU, before it hears
// that none is wanted; where no GPU does that, it takes half a second. It stays packed.
const fetched = window.fetch;
window.fetch = (what, ...more) => {
  const url = what instanceof Request ? what.url : String(what);
  return url.startsWith("data:image/jpeg") ? new Promise(() => {}) : fetched(what, ...more);
};
