// The `?` sheet: every key, in three columns.
import { h } from "./look.js";

const GROUPS = [
  [
    "Go",
    [
      ["→ ←", "one step"],
      ["N P", "next, previous decision"],
      ["Space", "play, pause"],
      ["] [", "next, previous disagreement"],
      ["B", "first suspect over 1 m"],
      ["Shift B", "worst suspect"],
    ],
  ],
  [
    "Rank",
    [
      ["1 2 3", "rank A, B, C in the order pressed"],
      ["=", "tie with the next"],
      ["X", "none of these"],
      ["Backspace", "take the last back"],
      ["Esc", "drop the ranking"],
      ["Enter", "commit, or fork at a past decision"],
      ["Alt ← →", "move a focused card"],
    ],
  ],
  [
    "Judge",
    [
      ["A", "agree"],
      ["S", "acceptable"],
      ["W", "wrong"],
      ["C", "cannot tell"],
      ["Shift 1 2 3", "A, B, C would have been better"],
      ["V", "show the covered answer"],
      ["T", "tags"],
      ["F", "flag"],
      ["U R", "undo, redo"],
    ],
  ],
  [
    "See",
    [
      ["Z", "hold: all alternatives side by side, twice the pixels"],
      ["Shift click", "on a picture: where else was this in view"],
      ["G", "goal"],
      ["Ctrl K", "command palette"],
      ["?", "this sheet"],
    ],
  ],
];

class Sheet {
  get open() {
    return Boolean(this.dialog?.open);
  }

  toggle() {
    if (this.open) {
      this.dialog.close();
      return;
    }
    this.dialog ??= this.build();
    this.dialog.showModal();
  }

  build() {
    const groups = GROUPS.map(([name, rows]) =>
      h(
        "section",
        {},
        h("h2", {}, name),
        h("dl", {}, ...rows.flatMap(([key, words]) => [h("dt", {}, key), h("dd", {}, words)])),
      ),
    );
    const dialog = h("dialog", { id: "c2-sheet", "aria-label": "keys" }, ...groups);
    dialog.addEventListener("click", () => dialog.close());
    document.body.append(dialog);
    return dialog;
  }
}

export const sheet = new Sheet();
