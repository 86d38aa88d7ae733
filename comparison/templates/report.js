"use strict";
const data = JSON.parse(document.getElementById("data").textContent);
const every = (rows, k) => rows.filter((_, i) => i % k === 0);
const pick = (mu, k) => every(mu, k).map(row => every(row, k));  // every k-th phase of both axes
const phases = (mu, stride) => [...mu.map((_, i) => 2 * Math.PI * i * stride / data.grid), 2 * Math.PI];
const wrapped = mu => { const rows = mu.map(row => [...row, row[0]]); return [...rows, rows[0]]; };
const turned = rows => rows[0].map((_, j) => rows.map(row => row[j]));  // plotly wants z[alpha2][alpha1]
const axis = text => ({ title: { text }, tickvals: [0, Math.PI, 2 * Math.PI], ticktext: ["0", "π", "2π"] });
let pair = "total";

function extent(values) {
  const known = values.flat().filter(v => v !== null);
  if (!known.length) return [0, 1];
  const low = known.reduce((a, b) => Math.min(a, b)), high = known.reduce((a, b) => Math.max(a, b));
  return low < high ? [low, high] : [low - 0.1, high + 0.1];
}

function draw(box) {
  const scene = data.scenes[box.dataset.scene], body = Number(box.dataset.body);
  const [first, second] = scene.pairs[pair];
  const a = scene.mu[first][body - 1], b = scene.mu[second][body - 1];
  const strides = [first, second].map(model => data.strides[model]), common = Math.max(...strides);
  const [one, other] = [pick(a, common / strides[0]), pick(b, common / strides[1])];
  const percent = one.map((row, i) => row.map((v, j) => v > 0 && other[i][j] !== null ? 100 * (other[i][j] - v) / v : null));
  const [low, high] = extent([a, b].flat());
  const reach = Math.max(...extent(percent).map(Math.abs)) || 1;
  const hover = unit => `α₁ %{x:.3f}<br>α₂ %{y:.3f}<br>%{z:.5g}${unit}<extra></extra>`;
  const surface = (mu, stride, scene, colours, range, x, unit) => ({
    type: "surface", x: phases(mu, stride), y: phases(mu, stride), z: turned(wrapped(mu)), scene, colorscale: colours, cmin: range[0], cmax: range[1],
    colorbar: { x, len: 0.7, thickness: 10, tickfont: { size: 10 } }, showscale: x !== null, hovertemplate: hover(unit),
  });
  const camera = box.camera || { eye: { x: -1.25, y: -1.63, z: 0.98 }, center: { x: 0, y: 0, z: -0.1 } };
  const space = (x0, x1, range) => ({ domain: { x: [x0, x1], y: [0, 1] }, camera, aspectmode: "manual",
    aspectratio: { x: 1, y: 1, z: 0.65 }, xaxis: axis("α₁"), yaxis: axis("α₂"), zaxis: { title: { text: "" }, range } });
  const heading = (x, text) => ({ x, y: 1, xref: "paper", yref: "paper", showarrow: false, text: `<b>${text}</b>`, font: { size: 13 } });
  const mu = `μ<sub>${body}</sub>`;
  Plotly.react(box, [
    surface(a, strides[0], "scene", "Cividis", [low, high], null, ""),
    surface(b, strides[1], "scene2", "Cividis", [low, high], 0.625, ""),
    surface(percent, common, "scene3", [[0, "#2166ac"], [0.5, "#f7f7f7"], [1, "#b2182b"]], [-reach, reach], 1, " %"),
  ], {
    margin: { l: 0, r: 10, t: 6, b: 0 }, font: { size: 11 },
    scene: space(0, 0.3, [low, high]), scene2: space(0.31, 0.62, [low, high]),
    scene3: space(0.69, 0.99, [-reach, reach]),
    annotations: [heading(0.13, `${mu}, ${data.titles[first]}`), heading(0.46, `${mu}, ${data.titles[second]}`),
      heading(0.85, "difference, % of the first")],
  }, { displaylogo: false, responsive: true, modeBarButtonsToRemove: ["toImage"] });
  if (!box.linked) {
    box.linked = true;
    box.on("plotly_relayout", change => {  // one turn turns the three alike
      const name = ["scene", "scene2", "scene3"].find(name => change[`${name}.camera`]);
      if (!name || box.turning) return;
      box.camera = change[`${name}.camera`];
      box.turning = true;
      Plotly.relayout(box, { "scene.camera": box.camera, "scene2.camera": box.camera, "scene3.camera": box.camera })
        .then(() => { box.turning = false; });
    });
  }
}

// a browser keeps only about sixteen drawing contexts: draw what is in view, drop what is not
const boxes = [...document.querySelectorAll(".surfaces")];
const visible = new Set();
function show(box) {
  try { draw(box); } catch (fault) {
    box.replaceChildren(`The surfaces cannot be turned in this browser (${fault.message}): see the static figure below.`);
    box.parentElement.querySelector("details").open = true;
  }
}
const watcher = new IntersectionObserver(entries => entries.forEach(({ target, isIntersecting }) => {
  if (isIntersecting && !visible.has(target)) { visible.add(target); show(target); }
  if (!isIntersecting && visible.delete(target)) {
    target.querySelectorAll("canvas").forEach(canvas => canvas.getContext("webgl")?.getExtension("WEBGL_lose_context")?.loseContext());
    Plotly.purge(target);
    target.linked = false;
  }
}), { rootMargin: "150px" });
boxes.forEach(box => watcher.observe(box));

const buttons = [...document.querySelectorAll("button[data-pair]")];
buttons.forEach(button => button.addEventListener("click", () => {
  pair = button.dataset.pair;
  buttons.forEach(other => other.setAttribute("aria-pressed", String(other === button)));
  visible.forEach(show);
}));

document.querySelectorAll("table.sortable").forEach(table => {
  const headings = [...table.tHead.rows[0].cells];
  headings.forEach((heading, column) => heading.addEventListener("click", () => {
    const down = heading.getAttribute("aria-sort") === "ascending";
    headings.forEach(other => other.removeAttribute("aria-sort"));
    heading.setAttribute("aria-sort", down ? "descending" : "ascending");
    const key = row => row.cells[column].dataset.value ?? row.cells[column].textContent;
    const order = (one, other) => {
      const a = key(one), b = key(other), x = Number(a), y = Number(b);
      return Number.isNaN(x) || Number.isNaN(y) ? a.localeCompare(b) : x - y;
    };
    const rows = [...table.tBodies[0].rows].sort(order);
    table.tBodies[0].append(...(down ? rows.reverse() : rows));
  }));
});

addEventListener("beforeprint", () => document.querySelectorAll("details.static").forEach(part => { part.open = true; }));
