"use strict";
// every plot of the page: drawn as SVG at the width it has, from a description
//   { label, height, x: {title, log, range, ticks: [[value, text], ...], equal}, y: the same,
//     series: [{ name, x, y, low, high, band, line, marks, color, dash, width, titles, legend }], bands: [{ from, to, text }] }
// color: number in the palette, "ink" or "gray"; a null in y parts a line; low and high make error bars, or a band
const SVG = "http://www.w3.org/2000/svg";
function svgElement(name, attributes = {}, ...content) {
  const element = document.createElementNS(SVG, name);
  Object.entries(attributes).forEach(([key, value]) => element.setAttribute(key, value));
  element.append(...content);
  return element;
}
function element(name, className = "", ...content) {
  const made = document.createElement(name);
  if (className) made.className = className;
  made.append(...content);
  return made;
}

const COLORS = 8;  // of the palette: from there on they repeat
const lookOf = series => `c-${Number.isInteger(series.color) ? series.color % COLORS : series.color ?? 0}`;
const paper = { printing: false, plot: 342, surface: [226, 190] };  // px at 96 to the inch: what stands two and three times beside each other on A4
const known = value => value !== null && Number.isFinite(value);
function rangeOf(axis, values) {
  if (axis.range) return axis.range;
  const fit = values.filter(value => known(value) && (!axis.log || value > 0));
  if (!fit.length) return axis.log ? [0.1, 1] : [0, 1];
  let low = fit.reduce((a, b) => Math.min(a, b)), high = fit.reduce((a, b) => Math.max(a, b));
  if (axis.log) return low < high ? [low / (high / low) ** 0.06, high * (high / low) ** 0.06] : [low / 2, high * 2];
  if (low === high) [low, high] = [low - (Math.abs(low) || 1) * 0.1, high + (Math.abs(high) || 1) * 0.1];
  return [low - 0.05 * (high - low), high + 0.05 * (high - low)];
}
// round values for the ticks: at most `most` of them
function ticksOf(axis, [low, high], most) {
  if (axis.ticks) return axis.ticks;
  if (axis.log) {
    const from = Math.ceil(Math.log10(low) - 1e-9), to = Math.floor(Math.log10(high) + 1e-9), every = Math.max(1, Math.ceil((to - from + 1) / most));
    const powers = Array.from({ length: Math.max(0, to - from + 1) }, (_, i) => from + i).filter(power => power % every === 0);
    if (powers.length > 1) return powers.map(power => [10 ** power, scientific(power)]);
    return [1, 2, 5].flatMap(digit => [from - 1, from, to].map(power => digit * 10 ** power)).filter((v, i, all) => v >= low && v <= high && all.indexOf(v) === i)
      .sort((a, b) => a - b).map(v => [v, shortNumber(v)]);
  }
  const rough = (high - low) / most, power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map(digit => digit * power).find(size => size >= rough) || 10 * power;
  const first = Math.ceil(low / step - 1e-9), count = Math.max(0, Math.floor(high / step + 1e-9) - first + 1);
  return Array.from({ length: Math.min(count, 50) }, (_, i) => [(first + i) * step, shortNumber(+((first + i) * step).toPrecision(10), step)]);
}
const RAISED = { "-": "⁻", 0: "⁰", 1: "¹", 2: "²", 3: "³", 4: "⁴", 5: "⁵", 6: "⁶", 7: "⁷", 8: "⁸", 9: "⁹" };
const scientific = power => power === 0 ? "1" : power === 1 ? "10" : `10${[...String(power)].map(letter => RAISED[letter]).join("")}`;
// a tick; step: to the next one, which decides how many digits of a very large or small value are told
function shortNumber(value, step = Math.abs(value)) {
  if (value === 0 || (Math.abs(value) >= 1e-3 && Math.abs(value) < 1e5)) return String(value).replace("-", "−");
  const digits = Math.max(0, Math.floor(Math.log10(Math.abs(value)) + 1e-9) - Math.floor(Math.log10(step) + 1e-9));
  return value.toExponential(Math.min(digits, 9)).replace("-", "−").replace(/e\+?(.*)/, (_, power) => `·10${[...power.replace("−", "-")].map(letter => RAISED[letter]).join("")}`);
}

function drawPlot(box, spec) {
  const width = Math.max(200, paper.printing ? paper.plot : box.clientWidth), height = spec.height ?? 230;
  const all = key => spec.series.flatMap(series => [...series[key], ...(key === "y" ? [...(series.low ?? []), ...(series.high ?? [])] : [])]);
  let xRange = rangeOf(spec.x, all("x")), yRange = rangeOf(spec.y, all("y"));
  let yTicks = ticksOf(spec.y, yRange, Math.max(2, Math.floor(height / 42)));
  const left = 12 + 6.6 * Math.max(2, ...yTicks.map(([, text]) => text.length)), right = 14, top = 22, bottom = 38;
  const inner = { width: width - left - right, height: height - top - bottom };
  if (spec.equal) {  // one meter is as long in x as in y
    const per = Math.max((xRange[1] - xRange[0]) / inner.width, (yRange[1] - yRange[0]) / inner.height);
    const about = (range, length) => { const middle = (range[0] + range[1]) / 2; return [middle - per * length / 2, middle + per * length / 2]; };
    [xRange, yRange] = [about(xRange, inner.width), about(yRange, inner.height)];
    yTicks = ticksOf(spec.y, yRange, Math.max(2, Math.floor(height / 42)));
  }
  const place = (axis, [low, high], length) => value => (axis.log ? Math.log(value / low) / Math.log(high / low) : (value - low) / (high - low)) * length;
  const px = place(spec.x, xRange, inner.width), py = place(spec.y, yRange, inner.height);
  const X = value => left + px(value), Y = value => top + inner.height - py(value);
  const clampY = value => Math.min(top + inner.height + 4, Math.max(top - 4, Y(value)));
  const svg = svgElement("svg", { viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": spec.label, class: "plot-svg" });
  (spec.bands ?? []).forEach(band => {
    const [a, b] = [band.from, band.to].map(value => Y(Math.min(yRange[1], Math.max(yRange[0], value))));
    svg.append(svgElement("rect", { x: left, y: Math.min(a, b), width: inner.width, height: Math.abs(b - a), class: "band" }));
  });
  const widest = Math.max(1, ...(spec.x.ticks ?? []).map(([, text]) => text.length), 5);
  const xTicks = ticksOf(spec.x, xRange, Math.max(2, Math.floor(inner.width / (8.5 * widest))));
  const apart = spec.x.ticks ? Math.max(1, Math.ceil(xTicks.length * 7.5 * widest / inner.width)) : 1;  // texts given by name stay apart
  xTicks.forEach(([value, text], i) => {
    if (value < xRange[0] || value > xRange[1]) return;
    svg.append(svgElement("line", { x1: X(value), x2: X(value), y1: top, y2: top + inner.height, class: "grid" }));
    if (i % apart === 0) svg.append(svgElement("text", { x: X(value), y: top + inner.height + 14, "text-anchor": "middle" }, text));
  });
  yTicks.forEach(([value, text]) => {
    if (value < yRange[0] || value > yRange[1]) return;
    svg.append(svgElement("line", { x1: left, x2: left + inner.width, y1: Y(value), y2: Y(value), class: value === 0 ? "zero" : "grid" }));
    svg.append(svgElement("text", { x: left - 5, y: Y(value) + 4, "text-anchor": "end" }, text));
  });
  svg.append(svgElement("text", { x: 2, y: 12, class: "axis" }, ...indexedInPicture(spec.y.title ?? "")));
  svg.append(svgElement("text", { x: width - 4, y: height - 6, "text-anchor": "end", class: "axis" }, ...indexedInPicture(spec.x.title ?? "")));
  const clip = `clip-${drawPlot.count = (drawPlot.count ?? 0) + 1}`;
  const frame = svgElement("clipPath", { id: clip });
  frame.append(svgElement("rect", { x: left - 6, y: top - 6, width: inner.width + 12, height: inner.height + 12 }));
  const drawing = svgElement("g", { "clip-path": `url(#${clip})` });
  svg.append(frame, drawing);
  spec.series.forEach(series => {
    const look = lookOf(series), shown = Array.from(series.x, (x, i) => known(x) && known(series.y[i]) && (!spec.x.log || x > 0) && (!spec.y.log || series.y[i] > 0));
    if (series.line !== false) {
      let path = "", down = false;
      series.x.forEach((x, i) => { path += shown[i] ? `${down ? "L" : "M"}${X(x).toFixed(1)} ${Y(series.y[i]).toFixed(1)}` : ""; down = shown[i]; });
      drawing.append(svgElement("path", { d: path, class: `line ${look}`, "stroke-width": series.width ?? 1.6, ...(series.dash ? { "stroke-dasharray": series.dash } : {}) }));
    }
    if (series.band && series.low) {
      const both = series.x.map((x, i) => i).filter(i => shown[i] && known(series.low[i]) && known(series.high[i]));
      const points = [...both.map(i => [i, series.high[i]]), ...both.reverse().map(i => [i, series.low[i]])].map(([i, y]) => `${X(series.x[i]).toFixed(1)},${clampY(y).toFixed(1)}`);
      drawing.append(svgElement("polygon", { points: points.join(" "), class: `area ${look}` }));
    }
    series.x.forEach((x, i) => {
      if (!shown[i]) return;
      if (series.low && !series.band && known(series.low[i]) && known(series.high[i])) drawing.append(svgElement("line", { x1: X(x), x2: X(x), y1: clampY(Math.max(series.low[i], spec.y.log ? yRange[0] : -Infinity)), y2: clampY(series.high[i]), class: `line ${look}` }));
      if (!series.marks) return;
      const mark = markOf(series.marks === true ? series.color : series.marks, X(x), Y(series.y[i]), look);
      mark.append(svgElement("title", {}, series.titles?.[i] ?? `${series.name}: ${+x.toPrecision(5)}, ${+series.y[i].toPrecision(4)}`));
      drawing.append(mark);
    });
  });
  const named = namedSeries(spec);
  box.replaceChildren(...(named.length ? [legendOf(named)] : []), svg);
}
// a mark has a shape of its own for each color: told apart without colors
function markOf(color, x, y, look) {
  const r = 3.6, points = list => svgElement("polygon", { points: list.map(([a, b]) => `${x + a * r},${y + b * r}`).join(" "), class: `mark ${look}` });
  const shapes = [
    () => svgElement("circle", { cx: x, cy: y, r, class: `mark ${look}` }), () => points([[-1, -1], [1, -1], [1, 1], [-1, 1]]),
    () => points([[0, -1.3], [1.2, 0.9], [-1.2, 0.9]]), () => points([[0, -1.4], [1.4, 0], [0, 1.4], [-1.4, 0]]),
    () => points([[0, 1.3], [1.2, -0.9], [-1.2, -0.9]]), () => points([[-1.3, 0], [0.9, -1.2], [0.9, 1.2]]), () => points([[1.3, 0], [-0.9, -1.2], [-0.9, 1.2]]),
    () => points([[-1.5, -0.5], [1.5, -0.5], [1.5, 0.5], [-1.5, 0.5]]),
  ];
  return (shapes[Number(color) % COLORS] ?? shapes[0])();
}
const namedSeries = spec => spec.legend === false ? [] : spec.series.filter(series => series.name && series.legend !== false);
function keyOf(series) {
  const key = svgElement("svg", { viewBox: "0 0 26 12", "aria-hidden": "true", class: "key" }), look = lookOf(series);
  if (series.line !== false) key.append(svgElement("path", { d: "M1 6 H25", class: `line ${look}`, "stroke-width": 2, ...(series.dash ? { "stroke-dasharray": series.dash } : {}) }));
  if (series.marks) key.append(markOf(series.marks === true ? series.color : series.marks, 13, 6, look));
  return key;
}
function legendOf(list) {
  const legend = element("ul", "legend");
  list.forEach(series => legend.append(element("li", "", keyOf(series), element("span", "", ...indexed(series.name)))));
  return legend;
}
// v_reg with its index below the line, in the page and inside a picture: every second part is an index
const parts = text => text.split(/(_\w+)/).map(part => part.replace(/^_/, ""));
const indexed = text => parts(text).map((part, i) => i % 2 ? element("sub", "", part) : part);
const indexedInPicture = text => parts(text).map((part, i) => svgElement("tspan", i % 2 ? { dy: 3, "font-size": "80%" } : i ? { dy: -3 } : {}, part));

// plots that stand in the page: drawn when they come into view, and again at another width
const drawStanding = box => { if (paper.printing || box.clientWidth) drawPlot(box, box.spec ??= JSON.parse(box.dataset.plot)); };
const plotWatcher = new ResizeObserver(entries => entries.forEach(({ target, contentRect }) => {
  if (Math.abs(contentRect.width - (target.drawnAt ?? 0)) <= 1) return;
  target.drawnAt = contentRect.width;
  drawStanding(target);
}));
document.querySelectorAll("[data-plot]").forEach(box => {
  offerFile(box, box.closest("[data-scene]")?.dataset.scene);
  plotWatcher.observe(box);
});
// a plot that a script makes: a figure with its title
function plotFigure(scene, title, spec) {
  const box = element("div", "plot"), figure = element("figure", "", element("figcaption", "", ...indexed(title)), box);
  box.spec = spec;
  offerFile(box, scene);
  plotWatcher.observe(box);
  return figure;
}

// a plot as a file of its own: with its title, its legend and every style
const STYLES = ["fill", "stroke", "stroke-width", "stroke-dasharray", "stroke-linejoin", "opacity", "font-size", "font-family"];
function offerFile(box, scene = "") {
  const caption = box.closest("figure").querySelector("figcaption"), save = element("button", "save", "save as SVG");
  const title = [...caption.childNodes].map(node => (node.nodeName === "SUB" ? "_" : "") + node.textContent).join("");
  save.type = "button";
  save.addEventListener("click", () => {
    const { dataset } = document.documentElement;
    dataset.paper = "";  // light, however dark the screen
    saveFile(fileName(title.startsWith(scene) && title !== scene ? title : `${scene} ${title}`), svgFile(title, box));
    delete dataset.paper;
  });
  caption.append(save);
}
const fileName = text => `${text.replace(/[^\p{L}\p{N}_.=+-]+/gu, "-").replace(/^-+|-+$/g, "").slice(0, 120)}.svg`;
function saveFile(name, text) {
  const link = element("a");
  link.download = name;
  link.href = URL.createObjectURL(new Blob([text], { type: "image/svg+xml" }));
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}
function withStyles(shown) {
  const copy = shown.cloneNode(false), styles = getComputedStyle(shown);
  STYLES.forEach(name => copy.setAttribute(name, styles.getPropertyValue(name)));
  copy.removeAttribute("class");
  copy.append(...[...shown.childNodes].map(node => node.nodeType === Node.ELEMENT_NODE ? withStyles(node) : node.cloneNode()));
  return copy;
}
function svgFile(title, box) {
  const plot = box.querySelector("svg.plot-svg"), [, , width, height] = plot.getAttribute("viewBox").split(" ").map(Number), row = 16;
  const [ink, fill] = ["--ink", "--back"].map(variable), font = getComputedStyle(document.body).fontFamily;
  const line = (x, number, text) => svgElement("text", { x, y: row * (number + 1) - 4, fill: ink, "font-size": "11px", "font-family": font }, ...indexedInPicture(text));
  const keys = [...box.querySelectorAll("svg.key")].map(withStyles), names = namedSeries(box.spec).map(series => series.name), top = row * (names.length + 1);
  keys.forEach((key, i) => Object.entries({ x: 2, y: row * (i + 1) + 2, width: 26, height: 12 }).forEach(([name, value]) => key.setAttribute(name, value)));
  const drawing = withStyles(plot);
  Object.entries({ y: top, width, height }).forEach(([name, value]) => drawing.setAttribute(name, value));
  const whole = svgElement("svg", { viewBox: `0 0 ${width} ${top + height}`, width, height: top + height, role: "img" },
    svgElement("title", {}, box.spec.label ?? title), svgElement("rect", { width, height: top + height, fill }), line(2, 0, title),
    ...keys, ...names.map((name, i) => line(34, i + 1, name)), drawing);
  return new XMLSerializer().serializeToString(whole);
}
