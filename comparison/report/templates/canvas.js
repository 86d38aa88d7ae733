"use strict";
// surfaces on a canvas: as a map seen from above, or in 3-D, painted from back to front; no graphics library
//   panel: { rows (alpha1 by alpha2), sheet, points: [{ a, b, z, error }], range, color (0 to 1 -> CSS color), lines,
//            largest: [a, b] or null, places: [[a, b]], chosen (index), cursor: [a, b] or null }
const turn = 2 * Math.PI;
const CIVIDIS = ["#00224e", "#123570", "#3b496c", "#575d6d", "#707173", "#8a8678", "#a59c74", "#c3b369", "#e1cc55", "#fee838"];
const SIGN_LIGHT = ["#2166ac", "#67a9cf", "#d1e5f0", "#f7f7f7", "#fddbc7", "#ef8a62", "#b2182b"];
const SIGN_DARK = ["#6db3f2", "#3f7fb8", "#2b4560", "#2b3036", "#5e4034", "#b5623f", "#ff9a76"];
const parsed = list => list.map(hex => [1, 3, 5].map(at => parseInt(hex.slice(at, at + 2), 16)));
function palette(list) {
  const stops = parsed(list);
  return (share, light = 1) => {
    const at = Math.min(1, Math.max(0, share)) * (stops.length - 1), i = Math.min(stops.length - 2, Math.floor(at)), w = at - i;
    return `rgb(${stops[i].map((v, k) => Math.round(Math.min(255, light * ((1 - w) * v + w * stops[i + 1][k])))).join(" ")})`;
  };
}
const variable = name => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
const dark = () => matchMedia("(prefers-color-scheme: dark)").matches && !paper.printing;
const around = (a, b) => { const d = Math.abs(a - b) % turn; return Math.min(d, turn - d); };

function prepared(canvas) {
  const [width, height] = paper.printing ? paper.surface : [canvas.clientWidth, canvas.clientHeight], ratio = paper.printing ? 4 : devicePixelRatio;  // sharp in print
  canvas.width = Math.round(width * ratio);
  canvas.height = Math.round(height * ratio);
  const pen = canvas.getContext("2d");
  pen.setTransform(ratio, 0, 0, ratio, 0, 0);
  pen.font = `12px ${getComputedStyle(document.body).fontFamily}`;
  return [pen, width, height];
}
const share = (panel, z) => (z - panel.range[0]) / (panel.range[1] - panel.range[0] || 1);

// where a phase pair and a height stand on the canvas; deeper is farther from the eye
function projection(width, height, camera) {
  const [ca, sa, ce, se] = [Math.cos(camera.azimuth), Math.sin(camera.azimuth), Math.cos(camera.elevation), Math.sin(camera.elevation)];
  const tall = 0.62, scale = Math.min((width - 56) / 1.36, (height - 46) / (tall * ce + 1.36 * se)), middle = [width / 2 + 14, height / 2 - 6];
  return (a, b, z01) => {
    const x = a / turn - 0.5, y = b / turn - 0.5, z = (z01 - 0.5) * tall, across = x * ca - y * sa, deep = x * sa + y * ca;
    return [middle[0] + scale * across, middle[1] - scale * (z * ce + deep * se), deep * ce - z * se];
  };
}

function draw3d(canvas, panel, camera) {
  const [pen, width, height] = prepared(canvas), at = projection(width, height, camera), ink = variable("--ink"), soft = variable("--soft");
  const n = panel.rows.length, z = (i, j) => panel.rows[i % n][j % n], place = (i, j, value) => at(turn * i / n, turn * j / n, share(panel, value));
  pen.clearRect(0, 0, width, height);
  const corners = [[0, 0], [turn, 0], [turn, turn], [0, turn]], floor = corners.map(([a, b]) => at(a, b, 0));
  pen.strokeStyle = soft;
  pen.lineWidth = 0.8;
  pen.beginPath();
  floor.forEach(([x, y], i) => i ? pen.lineTo(x, y) : pen.moveTo(x, y));
  pen.closePath();
  pen.stroke();
  pen.fillStyle = soft;
  const front = floor.reduce((best, corner, i) => corner[2] < floor[best][2] ? i : best, 0), leftmost = floor.reduce((best, corner, i) => corner[0] < floor[best][0] ? i : best, 0);
  const center = [width / 2 + 14, height / 2];
  [front, (front + 3) % 4].forEach(from => {  // the two edges at the front carry the phases
    const [p, q] = [corners[from], corners[(from + 1) % 4]], name = p[0] === q[0] ? "α₂" : "α₁";
    [["π/2", 0.25, 0], [name, 0.5, 9], ["3π/2", 0.75, 0]].forEach(([text, part, farther]) => {
      const value = part * turn, [x, y] = at(name === "α₁" ? value : p[0], name === "α₁" ? p[1] : value, 0), side = Math.sign(x - center[0]) || 1;
      pen.textAlign = side > 0 ? "left" : "right";
      pen.fillText(text, x + (6 + farther) * side, y + 13 + farther);
    });
  });
  const [low, high] = [0, 1].map(part => at(...corners[leftmost], part));
  pen.textAlign = "right";
  pen.beginPath();
  pen.moveTo(low[0], low[1]);
  pen.lineTo(high[0], high[1]);
  pen.stroke();
  ticksOf({}, panel.range, 4).forEach(([value, text]) => {
    const [x, y] = at(...corners[leftmost], share(panel, value));
    if (share(panel, value) > 0.1) pen.fillText(text, x - 4, y + 4);
  });
  const base = panel.range[0] < 0 ? share(panel, 0) : 0;  // differences stand on zero
  if (base) {
    pen.setLineDash([3, 3]);
    strokeLine(pen, [...corners, corners[0]].map(([a, b]) => at(a, b, base)));
    pen.setLineDash([]);
  }
  const order = (forward, count) => Array.from({ length: count }, (_, i) => forward ? i : count - 1 - i);
  if (panel.sheet) {
    const rows = order(Math.sin(camera.azimuth) < 0, n), columns = order(Math.cos(camera.azimuth) < 0, n), tilt = n / 9;
    for (const i of rows) for (const j of columns) {
      const heights = [z(i, j), z(i + 1, j), z(i + 1, j + 1), z(i, j + 1)];
      if (!heights.every(known)) continue;
      const s = heights.map(value => share(panel, value)), light = 1 + 0.22 * Math.tanh(tilt * 0.5 * (s[0] + s[3] - s[1] - s[2]) + tilt * 0.3 * (s[0] + s[1] - s[2] - s[3]));
      const p = [[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]].map(([u, v], k) => place(u, v, heights[k]));
      pen.fillStyle = pen.strokeStyle = panel.color((s[0] + s[1] + s[2] + s[3]) / 4, light);
      pen.lineWidth = 0.6;
      pen.beginPath();
      p.forEach(([x, y], k) => k ? pen.lineTo(x, y) : pen.moveTo(x, y));
      pen.closePath();
      pen.fill();
      pen.stroke();
    }
  }
  const lift = ([a, b]) => { const value = heightAt(panel.rows, a, b); return known(value) ? at(a, b, share(panel, value)) : null; };
  pen.strokeStyle = ink;
  pen.lineWidth = 1.4;
  panel.lines.forEach(points => strokeLine(pen, points.map(lift)));
  panel.points.slice().sort((p, q) => at(q.a, q.b, 0)[2] - at(p.a, p.b, 0)[2]).forEach(point => {
    const [x, y] = at(point.a, point.b, share(panel, point.z));
    if (panel.sheet) return dot(pen, x, y, 1.1, ink);
    const foot = at(point.a, point.b, base);
    pen.strokeStyle = soft;
    pen.lineWidth = 0.6;
    strokeLine(pen, [foot, [x, y]]);
    if (point.error) {
      const [up, down] = [1, -1].map(sign => at(point.a, point.b, share(panel, point.z + sign * point.error)));
      pen.strokeStyle = ink;
      pen.lineWidth = 1.4;
      [[up, down], [[up[0] - 3, up[1]], [up[0] + 3, up[1]]], [[down[0] - 3, down[1]], [down[0] + 3, down[1]]]].forEach(line => strokeLine(pen, line));
    }
    dot(pen, x, y, 4, panel.color(share(panel, point.z)), ink, point.error === null);
  });
  drawMarks(pen, panel, ([a, b]) => lift([a, b]) ?? at(a, b, base));
  canvas.inverse = (x, y) => nearestVertex(panel, at, x, y);
}

function drawMap(canvas, panel) {
  const [pen, width, height] = prepared(canvas), side = Math.min(width - 50, height - 44), left = (width - side) / 2 + 14, top = 8, ink = variable("--ink"), soft = variable("--soft");
  const X = a => left + side * a / turn, Y = b => top + side * (1 - b / turn), n = panel.rows.length, cell = side / n;
  pen.clearRect(0, 0, width, height);
  pen.save();
  pen.beginPath();
  pen.rect(left, top, side, side);
  pen.clip();
  if (panel.sheet) for (let i = 0; i <= n; i++) for (let j = 0; j <= n; j++) {  // a cell stands around its phase pair, on the closed square
    const value = panel.rows[i % n][j % n];
    if (!known(value)) continue;
    pen.fillStyle = panel.color(share(panel, value));
    pen.fillRect(X(turn * i / n) - cell / 2, Y(turn * j / n) - cell / 2, cell + 0.7, cell + 0.7);
  }
  pen.strokeStyle = ink;
  pen.lineWidth = 1.3;
  panel.lines.forEach(points => strokeLine(pen, points.map(([a, b]) => [X(a), Y(b)])));
  pen.restore();
  pen.strokeStyle = soft;
  pen.lineWidth = 1;
  pen.strokeRect(left, top, side, side);
  panel.points.forEach(({ a, b, z, error }) => panel.sheet ? dot(pen, X(a), Y(b), 1.2, ink) : dot(pen, X(a), Y(b), Math.min(9, side / 2.6 / Math.sqrt(panel.points.length)), panel.color(share(panel, z)), ink, error === null));
  pen.fillStyle = soft;
  [["0", 0], ["π", Math.PI], ["2π", turn]].forEach(([text, value]) => {
    pen.textAlign = "center";
    pen.fillText(text, X(value), top + side + 15);
    pen.textAlign = "right";
    pen.fillText(text, left - 6, Y(value) + 4);
  });
  pen.textAlign = "center";
  pen.fillText("α₁", X(0.75 * turn), top + side + 16);
  pen.textAlign = "right";
  pen.fillText("α₂", left - 6, Y(0.75 * turn) + 4);
  drawMarks(pen, panel, ([a, b]) => [X(a), Y(b)]);
  canvas.inverse = (x, y) => {
    const a = (x - left) / side * turn, b = (1 - (y - top) / side) * turn;
    return a < -0.2 || b < -0.2 || a > turn + 0.2 || b > turn + 0.2 ? null : [Math.min(turn, Math.max(0, a)), Math.min(turn, Math.max(0, b))];
  };
}

// the largest value: a triangle, open over all phases; stored motions: diamonds, the one shown filled; what is pointed at: a cross
function drawMarks(pen, panel, at) {
  const [ink, back, accent] = ["--ink", "--back", "--mark"].map(variable);
  panel.places.forEach((place, i) => diamond(pen, at(place), i === panel.chosen ? 8 : 5, i === panel.chosen ? accent : "", i === panel.chosen ? back : ink));
  [[panel.largest, 6, ink, back], [panel.worst, 8, "", ink]].forEach(([place, size, fill, edge]) => {
    if (!place) return;
    const [x, y] = at(place);
    pen.fillStyle = fill;
    pen.strokeStyle = edge;
    pen.lineWidth = 1.2;
    pen.beginPath();
    [[0, -1], [-size, -2 * size], [size, -2 * size]].forEach(([u, v], i) => i ? pen.lineTo(x + u, y + v) : pen.moveTo(x + u, y + v));
    pen.closePath();
    if (fill) pen.fill();
    pen.stroke();
  });
  if (panel.cursor) {
    const [x, y] = at(panel.cursor);
    pen.strokeStyle = accent;
    pen.lineWidth = 2;
    strokeLine(pen, [[x - 8, y], [x + 8, y]]);
    strokeLine(pen, [[x, y - 8], [x, y + 8]]);
  }
}
// a dashed edge: of unknown error
function dot(pen, x, y, radius, fill, edge = "", dashed = false) {
  pen.beginPath();
  pen.arc(x, y, radius, 0, turn);
  pen.fillStyle = fill;
  pen.fill();
  if (!edge) return;
  pen.strokeStyle = edge;
  pen.lineWidth = dashed ? 2 : 1.2;
  pen.setLineDash(dashed ? [2, 2] : []);
  pen.stroke();
  pen.setLineDash([]);
}
function diamond(pen, [x, y], radius, fill, edge) {
  pen.beginPath();
  [[0, -1], [1, 0], [0, 1], [-1, 0]].forEach(([u, v], i) => i ? pen.lineTo(x + radius * u, y + radius * v) : pen.moveTo(x + radius * u, y + radius * v));
  pen.closePath();
  pen.fillStyle = fill;
  if (fill) pen.fill();
  pen.strokeStyle = edge;
  pen.lineWidth = 1.5;
  pen.stroke();
}
function strokeLine(pen, points) {
  pen.beginPath();
  let down = false;
  points.forEach(point => { if (point) down ? pen.lineTo(point[0], point[1]) : pen.moveTo(point[0], point[1]); down = Boolean(point); });
  pen.stroke();
}

// the phase pair of the grid that is drawn nearest to the pointer, in front where several are
function nearestVertex(panel, at, x, y) {
  const n = panel.rows.length;
  let best = null;
  panel.rows.concat([panel.rows[0]]).forEach((row, i) => row.concat([row[0]]).forEach((value, j) => {
    if (!known(value)) return;
    const [a, b] = [turn * i / n, turn * j / n], [u, v, deep] = at(a, b, share(panel, value)), far = Math.hypot(u - x, v - y), score = Math.max(far, 12) + 8 * deep;
    if (far < 60 && (!best || score < best.score)) best = { score, phases: [a, b] };
  }));
  return best && best.phases;
}
// height of a surface between its points, null where a neighbor has no value
function heightAt(rows, alpha1, alpha2) {
  const n = rows.length, u = alpha1 / turn * n, v = alpha2 / turn * n, i = Math.floor(u), j = Math.floor(v);
  let sum = 0;
  for (const [k, l] of [[0, 0], [0, 1], [1, 0], [1, 1]]) {
    const weight = (k ? u - i : 1 - u + i) * (l ? v - j : 1 - v + j), value = rows[(i + k) % n][(j + l) % n];
    if (weight < 1e-9) continue;
    if (!known(value)) return null;
    sum += weight * value;
  }
  return sum;
}
