"use strict";
// three linked surfaces: two models and their signed difference, with the line |D| = u_D and the phases of stored motions
const every = (rows, k) => rows.filter((_, i) => i % k === 0);
const pick = (mu, k) => every(mu, k).map(row => every(row, k));  // every k-th phase of both axes
const wrapped = mu => { const rows = mu.map(row => [...row, row[0]]); return [...rows, rows[0]]; };
const turned = rows => rows[0].map((_, j) => rows.map(row => row[j]));  // plotly wants z[alpha2][alpha1]
const axis = text => ({ title: { text }, range: [0, turn], tickvals: [0, Math.PI, turn], ticktext: ["0", "π", "2π"] });
const SIGN = [[0, "#2166ac"], [0.5, "#f7f7f7"], [1, "#b2182b"]];
const NAMES = ["scene", "scene2", "scene3"];

function extent(values) {
  const known = values.flat().filter(v => v !== null);
  if (!known.length) return [0, 1];
  const low = known.reduce((a, b) => Math.min(a, b)), high = known.reduce((a, b) => Math.max(a, b));
  return low < high ? [low, high] : [low - 0.1, high + 0.1];
}

// height of a surface (rows alpha1, columns alpha2) between its points, null where a neighbor has no value
function heightAt(rows, alpha1, alpha2) {
  const n = rows.length, u = alpha1 / turn * n, v = alpha2 / turn * n, i = Math.floor(u), j = Math.floor(v);
  const at = (a, b) => rows[a % n][b % n], weight = (s, k) => k ? s : 1 - s;
  let sum = 0;
  for (const [k, l] of [[0, 0], [0, 1], [1, 0], [1, 1]]) {
    const share = weight(u - i, k) * weight(v - j, l), value = at(i + k, j + l);
    if (share < 1e-9) continue;
    if (value === null) return null;
    sum += share * value;
  }
  return sum;
}

function drawSurfaces(box, data, pair, chosen) {
  const scene = data.scenes[box.dataset.scene], body = Number(box.dataset.body);
  const [first, second] = scene.pairs[pair];
  const a = scene.mu[first][body - 1], b = scene.mu[second][body - 1];
  const strides = [first, second].map(model => data.strides[model]), common = Math.max(...strides);
  const [one, other] = [pick(a, common / strides[0]), pick(b, common / strides[1])];
  const percent = one.map((row, i) => row.map((v, j) => v > 0 && other[i][j] !== null ? 100 * (other[i][j] - v) / v : null));
  const range = extent([a, b].flat()), reach = Math.max(...extent(percent).map(Math.abs)) || 1;
  const [low, high] = range;
  const phases = rows => [...rows.map((_, i) => turn * i / rows.length), turn];
  const filled = rows => rows.flat().some(v => v !== null);  // a surface without any value is none: the library cannot draw it
  const missing = rows => filled(rows) ? "" : "<br>no value at any phase pair";
  const surface = (rows, scene, colors, [cmin, cmax], x, unit) => !filled(rows) ? { type: "scatter3d", scene, x: [], y: [], z: [], showlegend: false } : ({
    type: "surface", x: phases(rows), y: phases(rows), z: turned(wrapped(rows)), scene, colorscale: colors, cmin, cmax,
    colorbar: { x, len: 0.7, thickness: 10, tickfont: { size: 10 } }, showscale: x !== null,
    hovertemplate: `α₁ %{x:.3f}<br>α₂ %{y:.3f}<br>%{z:.5g}${unit}<extra></extra>`,
  });
  const marks = (rows, scene3d, height) => ({
    type: "scatter3d", mode: "markers", scene: scene3d, showlegend: false, hoverinfo: "skip",
    x: scene.places.map(p => p.phases[0]), y: scene.places.map(p => p.phases[1]),
    z: scene.places.map(p => { const z = heightAt(rows, ...p.phases); return z === null ? null : z + 0.02 * height; }),
    marker: { symbol: "circle", size: scene.places.map((_, i) => i === chosen ? 7 : 3.5),
      color: scene.places.map((_, i) => i === chosen ? "#ff2d95" : "#1b1f24"), line: { color: "#fff", width: 1 } },
  });
  const lone = (rows, scene3d, colors, [cmin, cmax]) => {  // what is left of a surface with gaps
    const known = rows.flatMap((row, i) => row.flatMap((z, j) => z === null ? [] : [[turn * i / rows.length, turn * j / rows.length, z]]));
    if (known.length === rows.length ** 2) return [];
    const [x, y, z] = [0, 1, 2].map(k => known.map(point => point[k]));
    return [{ type: "scatter3d", mode: "markers", scene: scene3d, showlegend: false, hoverinfo: "skip", x, y, z,
      marker: { symbol: "square", size: 4, color: z, colorscale: colors, cmin, cmax } }];
  };
  const line = {  // one trace: polylines parted by gaps
    type: "scatter3d", mode: "lines", scene: "scene3", showlegend: false, hoverinfo: "skip", line: { color: "#1b1f24", width: 4 },
    x: [], y: [], z: [],
  };
  scene.contours[pair][body - 1].forEach(points => [...points, [null, null]].forEach(([u, v]) => {
    const z = u === null ? null : heightAt(percent, u, v);
    line.x.push(u); line.y.push(v); line.z.push(z === null ? null : z + 0.01 * reach);
  }));
  const camera = box.camera || { eye: { x: -1.25, y: -1.63, z: 0.98 }, center: { x: 0, y: 0, z: -0.1 } };
  const space = (x0, x1, [from, to]) => ({ domain: { x: [x0, x1], y: [0, 1] }, camera, aspectmode: "manual",
    aspectratio: { x: 1, y: 1, z: 0.65 }, xaxis: axis("α₁"), yaxis: axis("α₂"), zaxis: { title: { text: "" }, range: [from - 0.04 * (to - from), to + 0.04 * (to - from)] } });
  const heading = (x, text) => ({ x, y: 1, xref: "paper", yref: "paper", showarrow: false, text: `<b>${text}</b>`, font: { size: 13 } });
  const mu = `μ<sub>${body}</sub>`;
  return Plotly.react(box, [
    surface(a, "scene", "Cividis", range, null, ""), surface(b, "scene2", "Cividis", range, 0.625, ""),
    surface(percent, "scene3", SIGN, [-reach, reach], 1, " %"),
    marks(a, "scene", high - low), marks(b, "scene2", high - low), marks(percent, "scene3", 2 * reach), line,
    ...lone(a, "scene", "Cividis", range), ...lone(b, "scene2", "Cividis", range), ...lone(percent, "scene3", SIGN, [-reach, reach]),
  ], {
    margin: { l: 0, r: 10, t: 6, b: 0 }, font: { size: 11 }, uirevision: pair,
    scene: space(0, 0.3, range), scene2: space(0.31, 0.62, range), scene3: space(0.69, 0.99, [-reach, reach]),
    annotations: [heading(0.13, `${mu}, ${indexed(data.titles[first])}${missing(a)}`), heading(0.46, `${mu}, ${indexed(data.titles[second])}${missing(b)}`),
      heading(0.85, `difference, % of the first${missing(percent)}`)],
  }, { displaylogo: false, responsive: true, modeBarButtonsToRemove: ["toImage"] });
}

// one turn turns the three alike
function linkCameras(box) {
  box.on("plotly_relayout", change => {
    const name = NAMES.find(name => change[`${name}.camera`]);
    if (!name || box.turning) return;
    box.camera = change[`${name}.camera`];
    box.turning = true;
    Plotly.relayout(box, Object.fromEntries(NAMES.map(name => [`${name}.camera`, box.camera])))
      .then(() => { box.turning = false; });
  });
}
