"use strict";
// the stored motions of one phase pair: plots of both models, and the numbers that a designer asks for
let numbers = null;  // unpacked when first asked for
const motionNumbers = () => numbers ??= unpacked("motions").then(buffer => new Int32Array(buffer));
const MM = 1000;

// one motion out of the packed numbers: see analyses/motions/page_data.py
function motionOf(all, place, key) {
  const about = place.motions.find(motion => motion.model === key);
  if (!about || !about.count) return { about, time: [] };
  const { start, count, blocks, exponents } = about;
  const column = (block, index = 0) => {  // undefined where the motion lacks the block
    if (!(block in blocks)) return undefined;
    const number = blocks[block][0] + index, from = start + count * number, unit = 2 ** exponents[number];
    let sum = 0;
    return Float64Array.from(all.subarray(from, from + count), change => unit * (sum += change));
  };
  return {
    about, column, time: column("time"), columns: block => blocks[block]?.[1] ?? 0,
    position: (body, axis) => column("position", 2 * (body - 1) + axis).map(value => MM * value),
    acceleration: (body, axis) => column("acceleration", 2 * (body - 1) + axis),
  };
}
const sizeOf = (x, y) => x.map((value, i) => Math.hypot(value, y[i]));

async function showMotions() {
  const scene = sceneNow(), place = scene.places[state.place], plots = part("plots");
  part("play").hidden = !place;
  if (!place) {
    plots.replaceChildren(element("p", "soft", "No motion is stored."));
    part("demands").replaceChildren();
    return;
  }
  const why = place.why ? `: ${place.why}` : "";
  part("distance").textContent = state.away === null ? place.why : `the nearest stored motion is ${degrees(state.away)} away from where you clicked${why}`;
  const all = await motionNumbers(), pair = pairNow(), models = [pair.first, pair.second];
  if (scene !== sceneNow() || place !== scene.places[state.place]) return;  // another was chosen meanwhile
  const motions = models.map(key => motionOf(all, place, key));
  const notes = motions.flatMap((motion, k) => motion.time.length
    ? motion.about.status === "ok" ? [] : [`${study.titles[models[k]]} ended early: ${motion.about.status}`]
    : [`${study.titles[models[k]]}: ${motion.about ? motion.about.error_message || motion.about.status : "no motion is stored at this phase pair"}`]);
  plots.replaceChildren(...notes.map(note => element("p", "note", ...indexed(note))), ...motionFigures(scene, models, motions));
  part("demands").replaceChildren(...demandsTable(scene, place, models));
  startFilm(scene, models.map(key => study.titles[key]), motions);
}

// every plot has both models: the first solid, the second dashed
function motionFigures(scene, models, motions) {
  const { body } = state, shown = motions.map((motion, k) => ({ motion, k })).filter(({ motion }) => motion.time.length);
  if (!shown.length) return [];
  const line = k => ({ name: study.titles[models[k]], color: k, dash: k ? "5 3" : "", width: k ? 1.4 : 1.8 });
  const figure = (title, spec) => plotFigure(scene.name, title, { height: 200, ...spec, label: `${title}, ${scene.title}: ${models.map(key => study.titles[key]).join(" and ")}` });
  const time = { title: "t, s", range: [0, scene.duration] };
  const over = (title, unit, pick) => figure(title, { x: time, y: { title: unit }, series: shown.map(({ motion, k }) => ({ ...line(k), x: motion.time, y: pick(motion) })) });
  const plane = (title, x, y, pick, extra = {}) => {
    const series = shown.flatMap(({ motion, k }) => (pick(motion) ?? []).map((path, i) => ({ ...line(k), ...path, legend: i === 0 })));
    return series.length ? [figure(title, { height: 260, x: { title: x }, y: { title: y }, series, ...extra })] : [];
  };
  const name = body === 1 ? "platform" : `body ${body}`;
  const supports = shown.filter(({ motion }) => motion.columns("support_force"));
  return [
    over(`displacement of the ${name} in x`, "mm", motion => motion.position(body, 0)),
    over(`displacement of the ${name} in y`, "mm", motion => motion.position(body, 1)),
    over(`absolute acceleration of the ${name}`, "m/s²", motion => sizeOf(motion.acceleration(body, 0), motion.acceleration(body, 1))),
    ...["x", "y"].flatMap((axis, i) => plane(`loop of the isolator in ${axis}`, `displacement in ${axis}, mm`, "force, N", motion => motion.column("isolator_force", i) && [{ x: motion.position(1, i), y: motion.column("isolator_force", i) }])),
    ...plane("path of the contact on its sphere", "mm", "mm", motion => contactPaths(scene, motion), { equal: true }),
    figure("rest of the platform", {
      height: 130, x: time, y: { title: "", range: [-0.6, 1.6], ticks: [[0, "2nd"], [1, "1st"]] },
      series: shown.map(({ motion, k }) => ({ ...line(k), dash: "", width: 9, x: motion.about.stick.flatMap(([a, b]) => [a, b, b]), y: motion.about.stick.flatMap(() => [1 - k, 1 - k, null]) })),
    }),
    ...spectraFigures(scene, shown, line, figure),
    ...(shown.some(({ motion }) => motion.columns("contact_force")) ? [over("contact force of the isolator", "N", motion => motion.column("contact_force") ?? [])] : []),
    ...supports.map(({ motion, k }) => figure(`support forces, ${study.titles[models[k]]}`, {
      x: time, y: { title: "N" }, series: Array.from({ length: motion.columns("support_force") }, (_, i) => ({ name: `support ${i + 1}`, color: i % 7, width: 1.1, x: motion.time, y: motion.column("support_force", i) })),
    })),
  ];
}

// floor response spectra of the chosen body, one plot per direction
function spectraFigures(scene, shown, line, figure) {
  const { period, damping } = scene.spectra, { body } = state, with_spectra = shown.filter(({ motion }) => motion.about.spectra);
  if (!with_spectra.length) return [];
  return ["x", "y"].map((axis, i) => figure(`floor spectrum of the ${body === 1 ? "platform" : `body ${body}`} in ${axis}, ${100 * damping} % damping`, {
    x: { title: "period, s", log: true }, y: { title: "pseudo-acceleration, m/s²" },
    series: with_spectra.map(({ motion, k }) => ({ ...line(k), x: period, y: motion.about.spectra[body - 1][i] })),
  }));
}

// where the contact point goes on the sphere of each support, seen from above; of the platform itself without a stated sphere
function contactPaths(scene, motion) {
  const { lever, supports } = scene.contact, x = motion.position(1, 0), y = motion.position(1, 1), yaw = motion.column("yaw");
  const places = yaw && supports ? supports : [[0, 0]], scale = -(lever ?? 1);
  return places.map(([X, Y]) => ({ x: x.map((value, i) => scale * (value - (yaw ? yaw[i] * Y * MM : 0))), y: y.map((value, i) => scale * (value + (yaw ? yaw[i] * X * MM : 0))) }));
}

// what the motion demands of isolator and structure: one row per quantity, both models beside each other
const DEMANDS = [
  ["displacement", "largest displacement of the isolator, mm", MM], ["residual", "residual displacement (± includes the creep of regularized friction), mm", MM], ["cap_share", "largest displacement, share of ρ", 1],
  ["travel_share", "largest displacement, share of the travel", 1],
  ["acceleration", "largest absolute acceleration (literal supremum where friction sticks), m/s²", 1, i => i ? `body ${i + 1}` : "platform"], ["base_shear", "base shear, N", 1], ["drift", "story drift, mm", MM, i => `body ${i + 2}`],
  ["contact_force_min", "smallest contact force, N", 1], ["contact_force_max", "largest contact force, N", 1],
  ["support_force_min", "smallest support force, N", 1], ["support_force_max", "largest support force, N", 1],
  ["torsion", "largest rotation about the vertical, mrad", 1e3, i => i ? `body ${i + 1}` : "platform"], ["stops", "number of stops", 1],
  ["uplift", "largest uplift of a support, mm", MM], ["friction_energy", "energy dissipated by friction, J", 1], ["damping_energy", "energy dissipated by dampers of the links, J", 1],
];
function demandsTable(scene, place, models) {
  const demands = models.map(key => place.motions.find(motion => motion.model === key)?.demands ?? null);
  const rows = DEMANDS.flatMap(([key, title, factor, each]) => {
    if (!each) return [[title, factor, demands.map(one => one?.[key] ?? null)]];
    const count = Math.max(...demands.map(one => one?.[key]?.length ?? 0));
    return Array.from({ length: count }, (_, i) => [`${title}: ${each(i)}`, factor, demands.map(one => one?.[key]?.[i] ?? null)]);
  }).filter(([, , values]) => values.some(value => known(value?.[0]) || value?.[2]));
  if (!rows.length) return [];
  const cell = (value, factor) => {
    const made = element("td", "number", known(value?.[0]) ? digits(factor * value[0]) + (value[1] > 1e-4 * Math.abs(value[0]) ? ` ± ${digits(factor * value[1], 1)}` : "") : value?.[2] ? `none: ${value[2]}` : "none");
    made.dataset.value = known(value?.[0]) ? factor * value[0] : "";
    return made;
  };
  const head = ["demand", ...models.map(key => study.titles[key]), "difference"].map((text, i) => { const made = element("th", i ? "number" : "", ...indexed(text)); made.scope = "col"; return made; });
  const body = rows.map(([title, factor, values]) => {
    const [a, b] = values.map(value => value?.[0]), heading = element("th", "", title), change = known(a) && known(b) && a ? 100 * (b - a) / Math.abs(a) : null;
    heading.scope = "row";
    const covered = known(change) && Math.abs(b - a) <= values.reduce((sum, value) => sum + (value[1] ?? 0), 0);
    const last = element("td", "number", known(change) ? percentText(change) + (covered ? ", within the errors" : "") : "");
    last.dataset.value = change ?? "";
    return element("tr", "", heading, ...values.map(value => cell(value, factor)), last);
  });
  const table = element("table", "data", element("thead", "", element("tr", "", ...head)), element("tbody", "", ...body)), frame = element("div", "table", table);
  const holder = element("div", "", element("h3", "", `Demands ${place.phases ? `at ${at(place.phases)}` : "under the record"}`), frame);
  equipTable(table);
  return [holder];
}
