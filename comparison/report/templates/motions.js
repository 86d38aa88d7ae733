"use strict";
// the motions of a phase pair, drawn below the surfaces they were chosen on
const turn = 2 * Math.PI;
const around = (a, b) => { const d = Math.abs(a - b) % turn; return Math.min(d, turn - d); };
const indexed = text => text.replace(/_(\w+)/g, "<sub>$1</sub>");  // v_reg as plotly writes it
const degrees = phase => `${Math.round(phase * 180 / Math.PI)}°`;
const named = place => place.phases === null ? "the record" : `(${place.phases.map(degrees).join(", ")})`;
const nearest = (places, alpha1, alpha2) => places.reduce((best, place, index) => {
  const far = Math.hypot(around(place.phases[0], alpha1), around(place.phases[1], alpha2));
  return far < best[1] ? [index, far] : best;
}, [-1, Infinity])[0];

async function unpacked(id) {
  const letters = atob(document.getElementById(id).textContent);
  const bytes = Uint8Array.from(letters, letter => letter.charCodeAt(0));
  return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"))).arrayBuffer();
}
let numbers = null;  // unpacked when first asked for
const motionNumbers = () => numbers ??= unpacked("motions").then(buffer => new Int32Array(buffer));

function motionOf(all, place, model) {
  const about = place.motions.find(motion => motion.model === model);
  if (!about || !about.count) return { about, time: [] };
  const { start, count, blocks, exponents } = about;
  const column = (block, index = 0) => {  // undefined where the motion lacks the block
    if (!(block in blocks)) return undefined;
    const number = blocks[block][0] + index, from = start + count * number, unit = 2 ** exponents[number];
    let sum = 0;
    return Float64Array.from(all.subarray(from, from + count), change => unit * (sum += change));
  };
  return {
    about, column, time: column("time"),
    position: (body, axis) => column("position", 2 * (body - 1) + axis).map(value => 1000 * value),  // mm
    acceleration: (body, axis) => column("acceleration", 2 * (body - 1) + axis),
  };
}

const COLORS = ["#0b5394", "#e07b00"];
async function drawMotions(box, scene, body, place, models, titles) {
  const all = await motionNumbers();
  const traces = [], notes = [], path = [];
  models.forEach((model, k) => {
    const motion = motionOf(all, place, model);
    if (!motion.time.length) {
      notes.push(`${titles[model]}: ${motion.about ? motion.about.error_message || motion.about.status : "not asked at this phase pair"}`);
      return;
    }
    if (motion.about.status !== "ok") notes.push(`${titles[model]} ended early: ${motion.about.status}`);
    const line = { color: COLORS[k], width: k ? 1.2 : 1.8, dash: k ? "4px,2px" : "solid" };
    const common = { mode: "lines", line, legendgroup: model, name: indexed(titles[model]) };
    const x = motion.position(body, 0), y = motion.position(body, 1), ax = motion.acceleration(body, 0), ay = motion.acceleration(body, 1);
    [x, y, ax, ay].forEach((values, row) => traces.push({ ...common, x: motion.time, y: values, xaxis: "x", yaxis: `y${row ? row + 1 : ""}`, showlegend: row === 0 }));
    const peak = ax.reduce((best, _, i) => Math.hypot(ax[i], ay[i]) > Math.hypot(ax[best], ay[best]) ? i : best, 0);
    const most = Math.hypot(ax[peak], ay[peak]).toPrecision(4);
    [ax, ay].forEach((values, row) => traces.push({ x: [motion.time[peak]], y: [values[peak]], yaxis: `y${row + 3}`, mode: "markers", showlegend: false,
      marker: { color: COLORS[k], size: 9, symbol: k ? "diamond-open" : "circle-open" }, hovertemplate: `largest |a|: ${most} m/s²<extra>${indexed(titles[model])}</extra>` }));
    const rest = motion.about.stick;
    traces.push({ ...common, x: rest.flatMap(([a, b]) => [a, b, null]), y: rest.flatMap(() => [k, k, null]), yaxis: "y5", showlegend: false, line: { color: COLORS[k], width: 9 } });
    path.push(motion.position(1, 0), motion.position(1, 1));
    traces.push({ ...common, x: path.at(-2), y: path.at(-1), xaxis: "x2", yaxis: "y6", showlegend: false });
  });
  const reach = 1.1 * path.reduce((most, values) => values.reduce((a, b) => Math.max(a, Math.abs(b)), most), 1e-6);
  const span = (from, to) => ({ domain: [from, to], zeroline: true, zerolinecolor: "#d5dae0" });
  const title = text => ({ title: { text, font: { size: 11 }, standoff: 4 } });
  const lift = (x, y, text) => ({ x, y, xref: "paper", yref: "paper", showarrow: false, text, font: { size: 12 }, yanchor: "bottom" });
  await Plotly.react(box, traces, {
    margin: { l: 58, r: 12, t: 46, b: 40 }, font: { size: 11 }, hovermode: "closest",
    legend: { orientation: "h", x: 0, y: 1.015, yanchor: "bottom" },
    xaxis: { domain: [0, 0.62], anchor: "y5", ...title("t, s"), range: [0, scene.duration] },
    yaxis: { ...span(0.81, 1), ...title("x, mm") }, yaxis2: { ...span(0.59, 0.78), ...title("y, mm") },
    yaxis3: { ...span(0.37, 0.56), ...title("a<sub>x</sub>, m/s²") }, yaxis4: { ...span(0.15, 0.34), ...title("a<sub>y</sub>, m/s²") },
    yaxis5: { domain: [0, 0.1], ...title("rest"), range: [1.6, -0.6], showticklabels: false, showgrid: false, zeroline: false, fixedrange: true },
    xaxis2: { domain: [0.71, 1], anchor: "y6", ...title("x<sub>1</sub>, mm"), scaleanchor: "y6", range: [-reach, reach], zeroline: false },
    yaxis6: { domain: [0, 0.93], anchor: "x2", range: [-reach, reach], ...title("y<sub>1</sub>, mm"), zeroline: false },
    annotations: [lift(0.855, 0.94, "contact path of the platform")].map(a => ({ ...a, xanchor: "center" })),
  }, { displaylogo: false, responsive: true });
  return notes;
}
