// Two episodes in step: one slider, two pictures, two markers.

const data = JSON.parse(document.getElementById("p-pair").textContent);
const slider = document.querySelector(".p-slide input");
const axis = document.querySelector("[data-axis]");
const output = document.querySelector(".p-slide output");
const figures = [...document.querySelectorAll(".p-walk figure")];
const markers = [...document.querySelectorAll(".p-marker")];

for (const name of Object.keys(data.axes)) axis.append(new Option(name === "distance" ? "distance along the reference" : name, name));

const decided = (side, step) => side.decisions.filter(([at]) => at <= step).at(-1);

function show() {
  const stands = data.axes[axis.value];
  const place = Math.min(Number(slider.value), stands.length - 1);
  const [words, ...steps] = stands[place];
  output.textContent = `${words}${place < data.parted ? ", together" : ""}`;
  const spots = steps.map((step, index) => data.sides[index].steps[Math.min(step, data.sides[index].steps.length - 1)]);
  // Where both stand at one place, both letters stay readable.
  const near = Math.hypot(spots[0][0] - spots[1][0], spots[0][1] - spots[1][1]) < 14;
  steps.forEach((step, index) => {
    const side = data.sides[index];
    const [x, y, goal, leg, picture] = spots[index];
    markers[index].setAttribute("transform", `translate(${x + (near ? 9 * (2 * index - 1) : 0)} ${y})`);
    const image = figures[index].querySelector("img");
    const address = picture ? `compare/picture/${side.trace}/${picture}.jpg` : "";
    if (image.getAttribute("src") !== address) image.setAttribute("src", address || "data:,");
    const last = decided(side, step);
    figures[index].querySelector(".p-here").textContent = [
      `step ${step}, leg ${leg}`,
      goal === null ? "" : `${goal.toFixed(1)} m to the goal`,
      last ? `decision ${last[1]} (${last[2]}): ${last[3]}` : "",
    ].filter(Boolean).join(" · ");
  });
}

function choose() {
  slider.max = data.axes[axis.value].length - 1;
  show();
}

const by = (count) => {
  slider.value = Number(slider.value) + count;
  show();
};

slider.addEventListener("input", show);
axis.addEventListener("change", choose);
document.querySelector("[data-back]").addEventListener("click", () => by(-1));
document.querySelector("[data-on]").addEventListener("click", () => by(1));
document.addEventListener("keydown", (event) => {
  if (event.target.matches("input, select") || event.ctrlKey || event.metaKey || event.altKey) return;
  if (event.key === "ArrowLeft") by(-1);
  if (event.key === "ArrowRight") by(1);
});
slider.max = data.axes[axis.value].length - 1;
slider.value = Math.max(0, Math.min(data.parted, Number(slider.max)));
choose();
