// Judging blind. The page knows one question at a time; the next comes with the answer to the last.
const token = new URLSearchParams(location.search).get("token") ?? "";
const at = (id) => document.getElementById(id);

const farewell = `Nothing is left to judge.${globalThis.packedDesk ? " Save your answers and send the file back." : ""} Thank you.`;

let item = null; // the question on the page
let tiers = []; // labels from best to worst
let none = false;
let tying = false;
let shownAt = 0;
let hiddenMs = 0;
let hiddenSince = null;
let waiting = false;
let answerId = "";

async function call(name, body = {}) {
  // A packed page brings its own desk and asks nothing of any network.
  if (globalThis.packedDesk) return globalThis.packedDesk(name, body);
  const answer = await fetch(`judge/${name}`, {
    method: "POST",
    headers: { "Content-Type": "application/json", "X-Judge-Token": token },
    body: JSON.stringify(body),
  });
  const said = await answer.json();
  if (!answer.ok) throw Object.assign(new Error(said.detail ?? "refused"), { status: answer.status });
  return said;
}

function wordsOf(text) {
  const words = document.createElement("div");
  words.className = "words";
  words.textContent = text;
  return words;
}

/** The parts in their order; pictures that follow each other stand side by side to be compared. */
function laidOut(parts) {
  const nodes = [];
  let text = "";
  let row = null;
  for (const part of parts) {
    if (part.text !== undefined) {
      text += part.text;
      continue;
    }
    // The last line before a picture names it and goes with it.
    const name = text.trimEnd().lastIndexOf("\n") + 1;
    if (text.slice(0, name).trim() || !row) {
      row = document.createElement("div");
      row.className = "views";
      nodes.push(wordsOf(text.slice(0, name)), row);
    }
    const view = document.createElement("figure");
    view.append(wordsOf(text.slice(name)), imageOf(part));
    row.append(view);
    text = "";
  }
  return text ? [...nodes, wordsOf(text)] : nodes;
}

function imageOf(piece) {
  const image = new Image(piece.width, piece.height);
  image.alt = "";
  image.src = `data:image/jpeg;base64,${piece.jpeg}`;
  return image;
}

/** Whole multiples of the picture's own pixels: nothing is smoothed, nothing is left out. */
function enlarge() {
  const large = document.body.classList.contains("large");
  const room = at("question").clientWidth - 48;
  for (const image of document.querySelectorAll("main img")) {
    const width = Number(image.getAttribute("width"));
    const times = Math.max(1, Math.floor((large ? room : Math.min(room, 560)) / width));
    image.style.width = `${width * times}px`;
    image.parentElement.style.width = `${width * times}px`;
  }
}

async function show(said) {
  item = said.question ? said : null;
  [tiers, none, tying, hiddenMs, answerId] = [[], false, false, 0, fresh()];
  hiddenSince = document.hidden ? performance.now() : null;
  at("bar").value = said.done;
  at("bar").max = Math.max(1, said.total);
  at("progress").textContent = `${said.done} of ${said.total}`;
  const parts = item ? laidOut(item.question.parts) : [wordsOf(farewell)];
  at("question").replaceChildren(...parts);
  at("choices").replaceChildren(...(item ? item.question.labels.map(choice) : []));
  enlarge();
  draw();
  window.scrollTo(0, 0);
  await Promise.all([...document.querySelectorAll("main img")].map((image) => image.decode().catch(() => {})));
  shownAt = performance.now();
  document.body.dataset.shown = item ? String(item.number) : "done";
}

function choice(label, index) {
  const button = document.createElement("button");
  button.type = "button";
  button.dataset.label = label;
  button.append(label, " ", Object.assign(document.createElement("kbd"), { textContent: index + 1 }));
  button.addEventListener("click", () => put(label));
  return button;
}

function words() {
  if (none) return "none";
  return tiers.map((tier) => tier.join(" = ")).join(" > ") + (tying ? " =" : "");
}

function draw(problem = "") {
  at("ranking").textContent = problem || words();
  at("ranking").classList.toggle("fault", problem !== "");
  at("submit").disabled = !item || waiting || (tiers.length === 0 && !none);
  at("tie").setAttribute("aria-pressed", String(tying));
  at("none").setAttribute("aria-pressed", String(none));
  for (const button of at("choices").children)
    button.setAttribute("aria-pressed", String(tiers.flat().includes(button.dataset.label)));
}

function put(label) {
  if (!item || waiting) return;
  none = false;
  if (tiers.flat().includes(label)) {
    tiers = tiers.map((tier) => tier.filter((one) => one !== label)).filter((tier) => tier.length);
  } else if (tying && tiers.length) tiers.at(-1).push(label);
  else tiers.push([label]);
  tying = false;
  draw();
}

function back() {
  none = false;
  if (tying) tying = false;
  else {
    tiers.at(-1)?.pop();
    tiers = tiers.filter((tier) => tier.length);
  }
  draw();
}

function clear() {
  [tiers, none, tying] = [[], false, false];
  draw();
}

function declare() {
  if (!item || waiting) return;
  [tiers, none, tying] = [[], !none, false];
  draw();
}

const fresh = () =>
  [...crypto.getRandomValues(new Uint8Array(16))].map((byte) => byte.toString(16).padStart(2, "0")).join("");

async function step(name, body) {
  if (waiting) return;
  waiting = true;
  draw();
  try {
    const said = await call(name, body);
    waiting = false;
    await show(said);
  } catch (error) {
    waiting = false;
    if (error.status === 409) return step("next");
    draw(`${error.message}; ${name === "answer" ? "press Enter" : "reload"} to try again`);
  }
}

function submit() {
  if (!item || waiting || (tiers.length === 0 && !none)) return;
  const now = performance.now();
  const hidden = hiddenMs + (hiddenSince === null ? 0 : now - hiddenSince);
  return step("answer", {
    id: answerId,
    number: item.number,
    tiers: none ? [] : tiers,
    response_ms: Math.max(0, Math.round(now - shownAt)),
    hidden_ms: Math.round(hidden),
  });
}

function sheet() {
  const dialog = at("sheet");
  if (dialog.open) dialog.close();
  else dialog.showModal();
  at("help").setAttribute("aria-expanded", String(dialog.open));
}

function large() {
  document.body.classList.toggle("large");
  enlarge();
}

const KEYS = {
  enter: submit, x: declare, "=": () => { if (tiers.length) { tying = !tying; draw(); } },
  backspace: back, escape: clear, u: () => step("undo"), "?": sheet, z: large,
};

addEventListener("keydown", (event) => {
  if (event.ctrlKey || event.metaKey || event.altKey || event.repeat) return;
  if (at("sheet").open && event.key !== "?") return;
  const key = event.key.toLowerCase();
  const labels = item?.question.labels ?? [];
  const label = /^[1-9]$/.test(key) ? labels[Number(key) - 1] : labels.find((one) => one.toLowerCase() === key);
  // A focused button keeps Enter for itself, but for the labels: there it submits, Space presses.
  if (key === "enter" && event.target.closest(".actions button, header button")) return;
  const action = label ? () => put(label) : KEYS[key];
  if (!action) return;
  event.preventDefault();
  action();
});
document.addEventListener("visibilitychange", () => {
  const now = performance.now();
  if (document.hidden) hiddenSince = now;
  else if (hiddenSince !== null) [hiddenMs, hiddenSince] = [hiddenMs + now - hiddenSince, null];
});
addEventListener("resize", enlarge);
at("submit").addEventListener("click", submit);
at("tie").addEventListener("click", KEYS["="]);
at("back").addEventListener("click", back);
at("none").addEventListener("click", declare);
at("undo").addEventListener("click", KEYS.u);
at("help").addEventListener("click", sheet);
at("sheet").addEventListener("close", () => at("help").setAttribute("aria-expanded", "false"));
step("next");
