"use strict";
// paper, engine and their difference of one body of one scene, side by side; the second screen
const camera = { azimuth: -0.65, elevation: 0.5 };
const state = { scene: 0, body: 1, pair: "total", view: "3d", grid: "own", cursor: null, place: null, away: null };
const CHOICES = ["view", "grid"];  // parts of the state that buttons choose
let study = null;  // the data, unpacked when the page stands
const viewer = document.getElementById("viewer") ?? document.createElement("div");  // empty where no surfaces were asked for
const part = name => viewer.querySelector(`[data-part="${name}"]`);
const degrees = phase => `${Math.round(phase * 180 / Math.PI)}°`;
const at = phases => `(${phases.map(degrees).join(", ")})`;
const percentText = value => !known(value) ? "none" : `${value > 0 ? "+" : value < 0 ? "−" : ""}${Math.abs(value) >= 10 ? Math.abs(value).toFixed(0) : +Math.abs(value).toPrecision(2)}\u00a0%`;  // no line ends before the sign
const digits = (value, count = 4) => known(value) ? String(+value.toPrecision(count)).replace("-", "−") : "none";

async function unpacked(id) {
  const bytes = Uint8Array.from(atob(document.getElementById(id).textContent), letter => letter.charCodeAt(0));
  return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"))).arrayBuffer();
}

const sceneNow = () => study.scenes[state.scene];
const pairNow = () => sceneNow().pairs.find(pair => pair.key === state.pair) ?? sceneNow().pairs[0];
const decimated = (rows, n) => { const k = rows.length / n; return rows.filter((_, i) => i % k === 0).map(row => row.filter((_, j) => j % k === 0)); };
const pointsOf = (rows, errors) => rows.flatMap((row, i) => row.flatMap((z, j) => known(z) ? [{ a: turn * i / rows.length, b: turn * j / rows.length, z, error: errors?.[i][j] }] : []));

// one model as it may be drawn: all phases, completed, or points; `every` asks for so many phases per axis only; phases: per axis, of what was computed
function surfaceOf(scene, key, body, every = null) {
  const model = scene.models[key], mu = model.mu[body - 1], completed = model.completed[body - 1], { phases } = model;
  if (every !== null && every < model.phases) return { rows: decimated(mu, every), sheet: false, points: pointsOf(decimated(mu, every), null), model, phases: every };
  if (model.surface) return { rows: mu, sheet: true, points: [], model, phases };
  if (completed?.mu) return { rows: completed.mu, sheet: true, points: pointsOf(mu, null), model, completed, phases };
  return { rows: mu, sheet: false, points: pointsOf(mu, model.error?.[body - 1]), model, completed, phases };
}
const relative = (rows, base) => rows.map((row, i) => row.map((value, j) => known(value) && base[i][j] > 0 ? 100 * (value - base[i][j]) / base[i][j] : null));
// the difference in percent of the first model, on the phases of both
function differenceOf(scene, pair, body) {
  const [first, second] = [pair.first, pair.second].map(key => surfaceOf(scene, key, body)), [a, b] = [pair.first, pair.second].map(key => scene.models[key]);
  const n = Math.min(a.phases, b.phases), raw = relative(decimated(b.mu[body - 1], n), decimated(a.mu[body - 1], n));
  const errors = pair.uncertainty?.[body - 1].map(row => row.map(value => known(value) ? 100 * value : null));
  if (first.sheet && second.sheet && first.rows.length === second.rows.length && [first, second].every(one => !one.completed || one.completed.difference))
    return { rows: relative(second.rows, first.rows), sheet: true, points: first.completed || second.completed ? pointsOf(raw, null) : [], completed: second.completed ?? first.completed, phases: n };
  return { rows: raw, sheet: false, points: pointsOf(raw, errors), phases: n };
}
const values = surface => surface.sheet ? surface.rows.flat().filter(known) : surface.points.map(point => point.z);
function extent(list) {
  if (!list.length) return [0, 1];
  const low = list.reduce((a, b) => Math.min(a, b)), high = list.reduce((a, b) => Math.max(a, b));
  return low < high ? [low, high] : [low - 0.1 * (Math.abs(low) || 1), high + 0.1 * (Math.abs(high) || 1)];
}
// the largest value that was computed, by its size where it is signed
function largestOf(surface, size = value => value) {
  const list = surface.sheet && !surface.points.length ? pointsOf(surface.rows, null) : surface.points;
  return list.reduce((best, point) => !best || size(point.z) > size(best.z) ? point : best, null);
}

function panels() {
  const scene = sceneNow(), pair = pairNow(), { body } = state, second = surfaceOf(scene, pair.second, body);
  const first = surfaceOf(scene, pair.first, body, state.grid === "second" ? scene.models[pair.second].phases : null), difference = differenceOf(scene, pair, body);
  const range = extent([...values(surfaceOf(scene, pair.first, body)), ...values(second)]), reach = Math.max(...extent(values(difference)).map(Math.abs)) || 1;
  const common = { places: scene.places.map(place => place.phases), chosen: state.place, cursor: state.cursor };
  const light = palette(CIVIDIS), signs = palette(dark() ? SIGN_DARK : SIGN_LIGHT);
  const grid = (surface, n) => `${n} × ${n} phases, ${surface.model.computed} computed${surface.completed?.mu ? `, completed through ${study.titles[surface.completed.through]}` : ""}`;
  return [first, second, difference].map((surface, k) => {
    const largest = largestOf(surface, k === 2 ? Math.abs : undefined), shown = surface.sheet ? surface.rows.length : Math.round(Math.sqrt(surface.rows.flat().length));
    const notes = [k === 2 ? `${shown} × ${shown} phases${surface.completed ? ", completed" : ""}` : state.grid === "second" && k === 0 && !surface.sheet ? `${shown} × ${shown} of ${surface.model.phases} × ${surface.model.phases} phases` : grid(surface, surface.model.phases)];
    if (surface.completed?.mu && k < 2) notes.push(`dots: computed; ${surface.completed.certificate}`);
    if (!surface.sheet && k === 1 && surface.completed?.reason) notes.push(`points: ${surface.completed.reason}`);
    if (largest) notes.push(`largest of ${surface.phases} × ${surface.phases} phases: ${k === 2 ? percentText(largest.z) : digits(largest.z)} at ${at([largest.a, largest.b])}\u00a0▾`);
    else notes.push("no value at any phase pair");
    if (surface.points.some(point => point.error === null)) notes.push("dashed: of unknown error");
    const worst = k < 2 ? scene.worst?.[k ? pair.second : pair.first]?.[body - 1] : null;
    const own = worst && worst[3] === (k ? pair.second : pair.first);
    if (k < 2) notes.push(worst ? `largest over all phases${own ? "" : `, ${study.titles[worst[3]]}`}: ${digits(worst[2])} at ${at(worst.slice(0, 2))}${own ? "\u00a0▿" : ""}` : "largest over all phases: not searched");
    return { ...common, ...surface, range: k === 2 ? [-reach, reach] : range, color: k === 2 ? signs : light, largest: largest && [largest.a, largest.b], worst: own && worst.slice(0, 2),
      lines: k === 2 && surface.sheet && !surface.completed ? pair.contours[body - 1] : [], notes,
      title: k === 2 ? "difference, % of the first" : scene.labels[k ? pair.second : pair.first], unit: k === 2 ? " %" : "" };
  });
}

// title, scale and notes of a panel
function describe(figure, panel, k) {
  const scale = figure.querySelector("canvas.scale"), pen = scale.getContext("2d");
  figure.querySelector("b").replaceChildren(...(k < 2 ? indexed(`μ_${state.body}, `) : []), ...indexed(panel.title));
  figure.querySelector(".notes").replaceChildren(...panel.notes.map(note => element("span", "", ...indexed(note))));
  for (let x = 0; x < scale.width; x++) { pen.fillStyle = panel.color(x / (scale.width - 1)); pen.fillRect(x, 0, scale.width - x, scale.height); }  // over the one before: no seam is seen
  panel.range.forEach((value, end) => { figure.querySelectorAll(".scale span")[end].textContent = k === 2 ? percentText(value) : digits(value, 3); });
}
const canvases = [...viewer.querySelectorAll("figure canvas.surface")];
let shown = [];
function paint() {
  canvases.forEach((canvas, k) => state.view === "3d" ? draw3d(canvas, shown[k], camera) : drawMap(canvas, shown[k]));
}
let waiting = false;
function paintSoon() {
  if (waiting) return;
  waiting = true;
  requestAnimationFrame(() => { waiting = false; if (!part("panels").hidden) paint(); });
}
function show() {
  const scene = sceneNow();
  part("panels").hidden = scene.recorded;
  part("shape").hidden = part("hint").hidden = scene.recorded;
  viewer.querySelectorAll("[data-record]").forEach(box => { box.hidden = box.dataset.record !== `${state.scene}-${state.body}`; });
  if (scene.recorded) return;
  shown = panels();
  shown.forEach((panel, k) => {
    describe(canvases[k].closest("figure"), panel, k);
    canvases[k].setAttribute("aria-label", `${panel.title}, ${scene.title}, body ${state.body}: ${panel.notes.join("; ")}. Arrow keys move the cross, Enter shows the nearest stored motion.`);
  });
  paintSoon();
}
function readOut() {
  const scene = sceneNow(), pair = pairNow();
  if (!state.cursor) return;
  const [a, b, d] = shown.map(panel => valueAt(panel, state.cursor));
  const written = (value, text) => text(value.z) + (value.error ? ` ± ${digits(value.error, 1)}` : value.error === null ? " (error unknown)" : "");
  const sizes = [`${scene.labels[pair.first]} ${written(a, digits)}`, `${scene.labels[pair.second]} ${written(b, digits)}`, `difference ${written(d, percentText)}`];
  part("readout").replaceChildren(...indexed(`${at(state.cursor)}: ${sizes.join(", ")}`));
}
// height of a surface at a phase pair, or the point that is there, with its error
function valueAt(panel, [alpha1, alpha2]) {
  if (panel.sheet) return { z: heightAt(panel.rows, alpha1, alpha2) };
  const reach = turn / panel.rows.length / 4;
  return panel.points.find(point => Math.max(around(point.a, alpha1), around(point.b, alpha2)) < reach) ?? { z: null };
}

// what a click, a key or a picker changes
function change(changes) {
  Object.assign(state, changes);
  const scene = sceneNow();
  if (state.body > scene.bodies) state.body = 1;
  const bodies = part("body");
  bodies.replaceChildren(...Array.from({ length: scene.bodies }, (_, i) => new Option(i ? `body ${i + 1}` : "body 1 (platform)", i + 1, false, i + 1 === state.body)));
  const pairs = part("pair");
  pairs.replaceChildren(...scene.pairs.map(pair => new Option(`${pair.title}: ${scene.labels[pair.first]} | ${scene.labels[pair.second]}`.replaceAll("_", " "), pair.key, false, pair === pairNow())));
  part("sentence").replaceChildren(...indexed(`${pairNow().sentence}.`));
  part("scene").value = String(state.scene);
  CHOICES.forEach(name => viewer.querySelectorAll(`button[data-${name}]`).forEach(button => button.setAttribute("aria-pressed", String(button.dataset[name] === state[name]))));
  listPlaces();
  show();
  readOut();
}
function listPlaces() {
  const scene = sceneNow();
  part("place").replaceChildren(...(scene.places.length ? [] : [new Option("none stored", "")]), ...scene.places.map((place, i) => new Option([place.phases ? at(place.phases) : "the record", place.why].filter(Boolean).join(", "), i, false, i === state.place)));
}
function nearestPlace(phases) {
  return sceneNow().places.reduce((best, place, index) => {
    const far = Math.hypot(around(place.phases[0], phases[0]), around(place.phases[1], phases[1]));
    return far < best.far ? { index, far } : best;
  }, { index: null, far: Infinity });
}
function pick(phases) {
  const near = nearestPlace(phases);
  change({ cursor: phases, place: near.index, away: near.far });
  showMotions();
}
// an engine of the user, else the first pair whose second model is drawn as a surface: points beside a surface look as if they differed from it
const drawnPair = body => (sceneNow().pairs.find(pair => pair.user || surfaceOf(sceneNow(), pair.second, body).sheet) ?? sceneNow().pairs[0]).key;
// another scene: the motion where its difference is largest
const firstPlace = () => sceneNow().places.length ? 0 : null;
function chooseScene(scene, body = 1) {
  Object.assign(state, { scene, body, cursor: null, away: null, place: null });
  if (!sceneNow().recorded) state.pair = drawnPair(body);
  // the largest difference of this body where both models have a motion, else a place where both have one
  const largest = place => place.why.includes(`body ${body}`);
  const both = place => [pairNow().first, pairNow().second].every(key => place.motions.some(motion => motion.model === key));
  const tests = [place => largest(place) && both(place), both, largest];
  change({ place: tests.map(test => sceneNow().places.findIndex(test)).find(index => index >= 0) ?? firstPlace() });
  part("readout").textContent = "";
  showMotions();
}

// on paper: the surfaces of every scene and body; the pair of models is the one shown, or the one with which the page opens
function drawPaper() {
  const now = { ...state }, place = sceneNow().places[now.place], pair = pairNow();
  const models = `${study.titles[pair.first]} and ${study.titles[pair.second]}`;
  part("chosen").replaceChildren(...indexed(`${sceneNow().name}, body ${now.body}, ${models}: ${place?.phases ? at(place.phases) : "the record"}`));
  const sheets = [...part("scene").options].map(option => Number(option.value)).flatMap(number => Array.from({ length: study.scenes[number].recorded ? 0 : study.scenes[number].bodies }, (_, i) => {
    const scene = study.scenes[number], body = i + 1, here = number === now.scene && body === now.body;
    Object.assign(state, { scene: number, body, cursor: null, place: here ? now.place : null });
    state.pair = here ? now.pair : drawnPair(body);
    const figures = panels().map((panel, k) => {
      const figure = canvases[k].closest("figure").cloneNode(true), canvas = figure.querySelector("canvas.surface");
      ["tabindex", "aria-label"].forEach(name => canvas.removeAttribute(name));
      describe(figure, panel, k);
      state.view === "3d" ? draw3d(canvas, panel, camera) : drawMap(canvas, panel);
      return figure;
    });
    const sheet = element("div", "sheet", element("h3", "", `${scene.title} (${scene.name}), body ${body}: `, ...indexed(pairNow().sentence)), element("div", "three", ...figures));
    return sheet;
  }));
  part("paper").replaceChildren(...sheets);
  Object.assign(state, now);
}

function startViewer() {
  part("scene").addEventListener("change", event => chooseScene(Number(event.target.value)));
  part("body").addEventListener("change", event => chooseScene(state.scene, Number(event.target.value)));
  part("pair").addEventListener("change", event => { change({ pair: event.target.value }); showMotions(); });
  part("place").addEventListener("change", event => { change({ place: Number(event.target.value), away: null, cursor: null }); showMotions(); });
  CHOICES.forEach(name => viewer.querySelectorAll(`button[data-${name}]`).forEach(button => button.addEventListener("click", () => change({ [name]: button.dataset[name] }))));
  viewer.querySelectorAll("button[data-turn]").forEach(button => button.addEventListener("click", () => { camera.azimuth += Number(button.dataset.turn) * Math.PI / 8; paintSoon(); }));
  canvases.forEach(canvas => {
    let pressed = null;
    const spot = event => { const box = canvas.getBoundingClientRect(); return [event.clientX - box.left, event.clientY - box.top]; };
    canvas.addEventListener("pointerdown", event => { pressed = { x: event.clientX, y: event.clientY, azimuth: camera.azimuth, elevation: camera.elevation, moved: false }; });
    canvas.addEventListener("pointermove", event => {
      if (pressed && event.buttons && state.view === "3d") {
        const [dx, dy] = [event.clientX - pressed.x, event.clientY - pressed.y];
        if (Math.hypot(dx, dy) > 4) pressed.moved = true;
        if (!pressed.moved) return;
        camera.azimuth = pressed.azimuth - dx / 150;
        camera.elevation = Math.min(1.5, Math.max(0.1, pressed.elevation + dy / 200));
        paintSoon();
      } else {
        const phases = canvas.inverse?.(...spot(event));
        if (!phases) return;
        state.cursor = shown[1].rows.length ? phases : null;
        readOut();
        shown.forEach(panel => { panel.cursor = state.cursor; });
        paintSoon();
      }
    });
    canvas.addEventListener("pointerup", event => {
      const phases = pressed && !pressed.moved && canvas.inverse?.(...spot(event));
      pressed = null;
      if (phases && sceneNow().places.length) pick(phases);
    });
    canvas.addEventListener("keydown", event => {
      const step = turn / study.grid, move = { ArrowLeft: [-step, 0], ArrowRight: [step, 0], ArrowUp: [0, step], ArrowDown: [0, -step] }[event.key];
      if (event.key === "Enter" && state.cursor && sceneNow().places.length) pick(state.cursor);
      if (!move) return;
      event.preventDefault();
      const from = state.cursor ?? sceneNow().places[state.place]?.phases ?? [0, 0];
      state.cursor = from.map((phase, k) => (phase + move[k] + turn) % turn);
      shown.forEach(panel => { panel.cursor = state.cursor; });
      readOut();
      paintSoon();
    });
  });
  new ResizeObserver(paintSoon).observe(part("panels"));
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", show);
  chooseScene(Number(part("scene").options[0].value));
}
