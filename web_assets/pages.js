// The pages about runs: choosing, tagging, sets, opening an episode in the inspector.
// Every page works without this as far as reading goes; here is what changes something.

const at = (path) => new URL(path, document.baseURI).href;
const said = document.getElementById("p-said");

function say(text, fault = false) {
  said.textContent = fault ? `✕ ${text}` : text;
  said.classList.toggle("p-fault", fault);
  said.hidden = false;
  setTimeout(() => (said.hidden = true), fault ? 9000 : 5000);
}

/** Send a change; says what is wrong with it, and resolves to the answer or null. */
async function post(path, body) {
  try {
    const answer = await fetch(at(path), {
      method: "POST",
      headers: { "Content-Type": "application/json" },
      body: JSON.stringify(body),
    });
    const told = await answer.json();
    if (answer.ok) return told;
    say(typeof told.detail === "string" ? told.detail : `not understood (${answer.status})`, true);
  } catch {
    say("no connection to the inspector", true);
  }
  return null;
}

async function changed(path, body) {
  if ((await post(path, body)) !== null) window.location.reload();
}

for (const control of document.querySelectorAll("[data-submit]")) {
  control.addEventListener("change", () => control.form.submit());
}

// ---------------------------------------------------------------- opening an episode

document.addEventListener("click", async (event) => {
  const link = event.target.closest("[data-open]");
  if (!link || event.ctrlKey || event.metaKey) return;
  event.preventDefault();
  const told = await post("api/commands", { type: "open", entry: link.dataset.open, tab: "pages" });
  if (told !== null) window.location.href = at(link.dataset.at ? `.?decision=${link.dataset.at}` : ".");
});

// ---------------------------------------------------------------- a run in progress

const run = document.querySelector("[data-stamp]");
if (run) {
  setInterval(async () => {
    const answer = await fetch(at(`run/stamp?run=${encodeURIComponent(run.dataset.run)}`));
    if (answer.ok && (await answer.json()).stamp !== run.dataset.stamp) window.location.reload();
  }, 4000);
}

// ---------------------------------------------------------------- a page that is not ready yet

if (document.querySelector("[data-again]")) setTimeout(() => window.location.reload(), 1000);

// ---------------------------------------------------------------- cases

const picked = new Set(JSON.parse(sessionStorage.getItem("c2-picked") ?? "[]"));
const bar = document.querySelector(".p-picked");

function showPicked() {
  if (!bar) return;
  sessionStorage.setItem("c2-picked", JSON.stringify([...picked]));
  bar.hidden = picked.size === 0;
  bar.querySelector("[data-picked]").textContent = `${picked.size} chosen`;
  bar.querySelector("[data-compare]").disabled = picked.size !== 2;
  for (const item of document.querySelectorAll(".p-case")) {
    const box = item.querySelector("input[type=checkbox]");
    box.checked = picked.has(item.dataset.sha) && item.dataset.sha !== "";
    item.classList.toggle("p-on", box.checked);
  }
  const all = document.querySelector("[data-all]");
  if (!all) return;
  const boxes = [...document.querySelectorAll(".p-case input[type=checkbox]:enabled")];
  const on = boxes.filter((box) => box.checked).length;
  all.checked = on > 0 && on === boxes.length;
  all.indeterminate = on > 0 && on < boxes.length;
}

document.addEventListener("change", (event) => {
  if (event.target.type !== "checkbox") return;
  const item = event.target.closest(".p-case");
  const meant = item ? [item] : document.querySelectorAll(".p-case:has(input[type=checkbox]:enabled)");
  for (const { dataset } of meant) {
    if (event.target.checked) picked.add(dataset.sha);
    else picked.delete(dataset.sha);
  }
  showPicked();
});

/** Ask for a name in a dialog of our own; resolves to "" when nothing was said. */
function ask(words, known) {
  const dialog = document.getElementById("p-ask");
  const input = dialog.querySelector("input");
  dialog.querySelector("label span").textContent = words;
  dialog.querySelector("datalist").replaceChildren(...known.map((name) => new Option(name)));
  input.value = "";
  dialog.showModal();
  return new Promise((resolve) => {
    input.onkeydown = (event) => {
      if (event.key !== "Enter") return;
      event.preventDefault();
      dialog.close("yes");
    };
    dialog.onclose = () => resolve(dialog.returnValue === "yes" ? input.value.trim() : "");
  });
}

const list = (id) => JSON.parse(document.getElementById(id)?.textContent ?? "[]");
const inSet = document.querySelector("[data-set]")?.dataset.set;

async function named(words, known, act) {
  const name = await ask(words, known);
  if (name) await act(name);
}

const actions = {
  "[data-tag]": () =>
    named("Tag for the chosen episodes", list("p-marks"), (tag) => changed("cases/marks", { traces: [...picked], tag, on: true })),
  "[data-untag]": () =>
    named("Tag to take off the chosen episodes", list("p-marks"), (tag) => changed("cases/marks", { traces: [...picked], tag, on: false })),
  "[data-add]": () =>
    named("Set to add the chosen episodes to", list("p-sets"), (name) => changed("cases/sets", { traces: [...picked], name, on: true })),
  "[data-take]": () => changed("cases/sets", { traces: [...picked], name: inSet, on: false }),
  "[data-compare]": () => {
    const [a, b] = picked;
    window.location.href = at(`compare?a=${a}&b=${b}`);
  },
  "[data-clear]": () => {
    picked.clear();
    showPicked();
  },
  "[data-save-view]": () => {
    const form = document.querySelector(".p-line");
    const query = form.elements.q.value;
    const sort = form.elements.sort.value;
    return named("Name of this view", [], (name) => changed("cases/views", { name, query, sort }));
  },
  "[data-drop-view]": (button) => changed("cases/views/drop", { name: button.dataset.dropView }),
  "[data-export]": async (button) => {
    // It stays on the page: this takes a while, and what was written has to be found.
    const how = document.querySelector("[data-exported]");
    how.textContent = "exporting; figures take a few seconds a case…";
    how.hidden = false;
    button.disabled = true;
    const told = await post("cases/export", { name: inSet });
    button.disabled = false;
    if (told === null) how.hidden = true;
    else how.textContent = `exported to ${told.folder}`;
  },
};

document.addEventListener("click", (event) => {
  for (const [selector, act] of Object.entries(actions)) {
    const button = event.target.closest(selector);
    if (button) act(button);
  }
});

document.addEventListener("change", (event) => {
  if (event.target.matches("[data-note]")) post("cases/note", { name: inSet, note: event.target.value });
  if (event.target.matches("[data-caption]")) {
    const trace = event.target.closest(".p-case").dataset.sha;
    post("cases/caption", { name: inSet, trace, caption: event.target.value });
  }
});

showPicked();
