// Runs before viser's own script: chooses light or dark, which viser only reads from the address.
// Our own view lives in search parameters, never in the hash: viser builds its websocket address
// from everything before the question mark.
(() => {
  const address = new URL(window.location.href);
  const asked = address.searchParams.get("theme");
  const dark = asked ? asked === "dark" : window.matchMedia("(prefers-color-scheme: dark)").matches;
  if (dark === address.searchParams.has("darkMode")) return;
  if (dark) address.searchParams.set("darkMode", "1");
  else address.searchParams.delete("darkMode");
  window.history.replaceState(null, "", address);
})();
