// Runs before the style sheet is used: light or dark, as the address or the system asks.
(() => {
  const system = window.matchMedia("(prefers-color-scheme: dark)");
  const asked = new URL(window.location.href).searchParams.get("theme");
  const apply = () => {
    const dark = asked ? asked === "dark" : system.matches;
    document.documentElement.dataset.mantineColorScheme = dark ? "dark" : "light";
  };
  system.addEventListener("change", apply);
  apply();
})();
