// before the page's own scripts: every canvas and plot has one size, and a canvas keeps what is drawn on it
for (const [side, size] of [["clientWidth", 400], ["clientHeight", 300]])
  Object.defineProperty(HTMLElement.prototype, side, { get: () => size });
for (const name of ["clearRect", "fillText", "moveTo", "lineTo", "arc", "fillRect", "strokeRect", "fill", "stroke"]) {
  const real = CanvasRenderingContext2D.prototype[name];
  CanvasRenderingContext2D.prototype[name] = function (...given) {
    if (name === "clearRect") this.canvas.drawn = [];
    else (this.canvas.drawn ??= []).push({ name, given, color: name === "stroke" ? this.strokeStyle : this.fillStyle, dash: this.getLineDash().length });
    return real.apply(this, given);
  };
}
const figure = value => Number(value).toPrecision(5);
const mean = list => figure(list.reduce((sum, value) => sum + value, 0) / list.length);
// where the parts of a drawing are: how many, means of x, y and their product, which tells a mirrored one
const spread = points => `${points.length}: ${mean(points.map(([x]) => x))} ${mean(points.map(([, y]) => y))} ${mean(points.map(([x, y]) => x * y))}`;
const light = color => color.startsWith("#") ? [1, 3, 5].map(at => parseInt(color.slice(at, at + 2), 16)) : color.match(/[\d.]+/g).map(Number);

function toldCanvas(canvas) {
  const all = canvas.drawn ?? [], of = name => all.filter(each => each.name === name), parts = of("fillText").map(({ given }) => `${given[0]} at ${figure(given[1])} ${figure(given[2])}`);
  for (const name of ["moveTo", "lineTo", "arc", "fillRect", "strokeRect"]) {
    const list = of(name);
    if (list.length) parts.push(`${name} ${spread(list.map(({ given }) => given))} size ${mean(list.map(({ given }) => given[2] ?? 0))} red ${mean(list.map(({ given, color }) => given[0] * light(color)[0]))}`);
  }
  for (const name of ["fill", "stroke"]) {
    const list = of(name);
    if (list.length) parts.push(`${name} ${list.length} dashed ${list.filter(({ dash }) => dash).length} color ${mean(list.map(({ color }) => light(color)[0]))} ${mean(list.map(({ color }, i) => i * light(color)[2]))}`);
  }
  return parts.join(" | ");
}
function toldPlot(box) {
  const svg = box.querySelector("svg.plot-svg"), parts = [svg.getAttribute("aria-label"), ...[...svg.querySelectorAll("text")].map(text => `${text.textContent} at ${figure(text.getAttribute("x"))} ${figure(text.getAttribute("y"))}`)];
  const values = shape => (shape.getAttribute("d") ?? shape.getAttribute("points") ?? ["x1", "y1", "x2", "y2", "cx", "cy", "x", "y", "width", "height"].map(name => shape.getAttribute(name) ?? "").join(" ")).match(/-?[\d.]+(e-?\d+)?/g)?.map(Number) ?? [];
  for (const shape of svg.querySelectorAll("g path, g polygon, g line, g circle, rect.band, line.zero")) {
    const all = values(shape), points = Array.from({ length: all.length >> 1 }, (_, i) => [all[2 * i], all[2 * i + 1]]), begins = (shape.getAttribute("d")?.match(/M/g) ?? []).length;
    parts.push(`${shape.tagName} ${shape.getAttribute("class")} ${shape.getAttribute("stroke-dasharray") ?? ""} ${begins} ${points.length ? spread(points) : "none"} ${shape.textContent}`);
  }
  return [...parts, ...[...box.querySelectorAll(".legend li")].map(item => item.textContent)].join(" | ");
}
const text = node => node.innerText.replace(/\s+/g, " ").trim();

globalThis.toldPage = async () => {
  dispatchEvent(new Event("beforeprint"));
  const lines = [...document.querySelectorAll("[data-plot]")].map(box => `plot ${toldPlot(box)}`);
  const shaken = study?.scenes.find(scene => !scene.recorded);  // the scene whose pairs are all told
  for (const [number, scene] of (study?.scenes ?? []).entries()) for (let body = 1; body <= Math.min(2, scene.bodies); body++) {
    chooseScene(number, body);
    const pairs = scene.recorded ? [state.pair] : scene.pairs.map(pair => pair.key);
    for (const key of scene === shaken ? pairs : [state.pair]) {
      change({ pair: key, cursor: scene.recorded ? null : [turn / 4, 1.5 * turn / 4] });
      const where = `scene ${number} body ${body} ${key}`;
      lines.push(`${where}: ${text(part("sentence"))} | ${[...part("pair").options, ...part("place").options].map(option => option.text).join(" | ")} | ${part("readout").textContent}`);
      for (const view of scene.recorded ? [] : ["3d", "map"]) {
        change({ view });
        paint();
        canvases.forEach((canvas, k) => lines.push(`${where} ${view} ${k}: ${view === "map" ? text(canvas.closest("figure")) : ""} ${toldCanvas(canvas)}`));
        if (view === "map") lines.push(`${where} clicked: ${canvases.map(canvas => canvas.inverse(150, 100)?.map(phase => phase.toPrecision(6)).join(" ")).join(" | ")}`);
      }
      if (scene === shaken && key !== pairs[0]) continue;
      if (!scene.recorded) pick([1.9, 4.4]);
      await showMotions();
      film.time = 3.21;
      film.draw();
      lines.push(`${where} motion: ${text(part("distance"))} | ${text(part("clock"))} | ${toldCanvas(viewer.querySelector("canvas.film"))}`);
      part("plots").querySelectorAll(".plot").forEach(box => { drawStanding(box); lines.push(`${where} plot ${text(box.closest("figure").querySelector("figcaption"))} | ${toldPlot(box)}`); });
      lines.push(...[...part("demands").querySelectorAll("h3, tr")].map(row => `${where} demands: ${text(row)}`));
    }
  }
  return lines;
};
