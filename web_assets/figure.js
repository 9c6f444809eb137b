// Export ▸ Figure…: which kind, of which decisions, how wide; seen before it is taken away.
import { at, state } from "./store.js";
import { h } from "./look.js";

const KINDS = { strip: "decisions as cards", map: "the way from above", curve: "distance to the goal", compare: "fork beside its parent" };
const WIDTHS = { "3.5in": "one column, 3.5 in", "7.16in": "two columns, 7.16 in" };

const options = (words) => Object.entries(words).map(([value, text]) => h("option", { value }, text));

class FigureDialog {
  /** Show the dialog with a figure of the decision in view. */
  open() {
    this.dialog ??= this.build();
    const here = state.place.decision;
    const [compare] = this.kind.querySelectorAll("option[value=compare]");
    compare.disabled = !state.branches.find(({ id }) => id === state.branch.id)?.parent;
    compare.title = compare.disabled ? "for a fork in view" : "";
    if (compare.selected && compare.disabled) this.kind.value = "strip";
    this.decisions.value = here < 0 ? "0" : `${here}`;
    this.dialog.showModal();
    this.draw();
  }

  build() {
    const redraw = () => this.draw();
    this.kind = h("select", { onchange: redraw }, ...options(KINDS));
    this.decisions = h("input", { type: "text", onchange: redraw, size: 12, spellcheck: "false" });
    this.width = h("select", { onchange: redraw }, ...options(WIDTHS));
    this.width.value = "7.16in";
    this.picture = h("img", { alt: "" });
    this.words = h("p", { role: "status" });
    this.links = h("div", { class: "c2-buttons" });
    const field = (label, control) => h("label", {}, label, control);
    const close = h("button", { type: "button", class: "c2-link", onclick: () => this.dialog.close() }, "Close");
    const form = h(
      "form",
      { method: "dialog", onsubmit: (event) => (event.preventDefault(), redraw()) },
      field("Kind", this.kind),
      field("Decisions", this.decisions),
      field("Printed width", this.width),
      h("span", { class: "c2-buttons" }, close),
    );
    const well = h("div", { class: "c2-figure" }, this.picture, this.words);
    const dialog = h("dialog", { id: "c2-figure", "aria-label": "figure" }, form, well, this.links);
    // The page's own keys stay out of what is typed here.
    dialog.addEventListener("keydown", (event) => event.stopPropagation());
    document.body.append(dialog);
    return dialog;
  }

  address(file, more = {}) {
    const asked = new URLSearchParams({ kind: this.kind.value, decisions: this.decisions.value, width: this.width.value, ...more });
    return at(`api/figure.${file}?${asked}`);
  }

  /** Draw what is chosen; only the newest answer is shown. */
  async draw() {
    const asked = this.address("svg");
    this.asked = asked;
    this.words.textContent = "drawing…";
    this.dialog.setAttribute("aria-busy", "true");
    const answer = await fetch(asked);
    const body = answer.ok ? await answer.blob() : await answer.json();
    if (this.asked !== asked) return;
    this.dialog.removeAttribute("aria-busy");
    this.show(answer.ok ? body : null, answer.ok ? "" : body.detail);
  }

  show(body, fault) {
    URL.revokeObjectURL(this.picture.src);
    this.picture.hidden = !body;
    if (body) this.picture.src = URL.createObjectURL(body);
    this.picture.alt = `${KINDS[this.kind.value]}, decisions ${this.decisions.value}`;
    this.words.replaceChildren(...(fault ? [h("b", { class: "c2-fault" }, "✕ "), fault] : []));
    const link = (label, file, more) =>
      h("a", { class: "c2-link", href: this.address(file, more), download: `${this.kind.value}.${file}` }, label);
    const files = [link("Save as PDF", "pdf"), link("Save as SVG", "svg")];
    if (state.branch.recipe) files.push(link("Recipe of the PDF", "json", { recipe_of: "pdf" }));
    this.links.replaceChildren(...(body ? files : []));
  }
}

const dialog = new FigureDialog();

document.addEventListener("click", (event) => {
  if (event.target.closest?.("[data-open=figure]")) dialog.open();
});
