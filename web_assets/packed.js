// Judging from a file: the same page, whose answers stay here until they are saved and sent back.
const study = JSON.parse(document.getElementById("packed").textContent);
const shelf = `c2nav.${study.study_sha256}.${study.person}`;
const kept = load();
const answered = new Map(study.answered.map((place) => [place, null]));
for (const line of kept) apply(line);

function load() {
  try {
    return JSON.parse(localStorage.getItem(shelf) ?? "[]");
  } catch {
    return []; // no storage for files in this browser: answers live as long as the page
  }
}

function keep(line) {
  kept.push(line);
  apply(line);
  try {
    localStorage.setItem(shelf, JSON.stringify(kept));
  } catch {
    addEventListener("beforeunload", (event) => event.preventDefault(), { once: true });
  }
}

function apply(line) {
  if (line.undo) answered.delete(line.place);
  else answered.set(line.place, line.id);
}

const line = (fields) => ({
  packed: study.packed,
  study_sha256: study.study_sha256,
  person: study.person,
  when_s: Date.now() / 1000,
  ...fields,
});

function next() {
  const total = study.questions.length;
  const number = study.questions.findIndex((_, place) => !answered.has(place));
  const told = { done: answered.size, total };
  return number < 0 ? told : { ...told, number, question: study.questions[number].question };
}

function undo() {
  const mine = kept.filter((one) => !one.undo && answered.get(one.place) === one.id);
  const last = mine.at(-1);
  if (last) keep(line({ id: last.id, place: last.place, undo: true }));
}

/** What the server does for the page that is served. */
globalThis.packedDesk = (name, body) => {
  if (name === "answer" && !answered.has(body.number)) {
    const { id, number, tiers, response_ms, hidden_ms } = body;
    const question_sha256 = study.questions[number].sha256;
    keep(line({ id, place: number, question_sha256, tiers, response_ms, hidden_ms }));
  } else if (name === "undo") undo();
  return next();
};

document.getElementById("save").addEventListener("click", () => {
  const lines = kept.map((one) => `${JSON.stringify(one)}\n`);
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob(lines, { type: "application/jsonl" }));
  link.download = `${study.study}.${study.person}.jsonl`;
  link.click();
  URL.revokeObjectURL(link.href);
});
