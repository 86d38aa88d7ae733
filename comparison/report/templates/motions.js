"use strict";
// the stored motions of one phase pair: plots of both models, and the numbers that a designer asks for
let numbers = null;  // unpacked when first asked for
const motionNumbers = () => numbers ??= unpacked("motions").then(buffer => new Float32Array(buffer));
const MM = 1000;

// one motion out of the packed numbers: time, then position and acceleration of every body in x and y
function motionOf(all, place, key, bodies) {
  const about = place.motions.find(motion => motion.model === key);
  if (!about || !about.count) return { about, time: [] };
  const { start, count } = about, time = all.subarray(start, start + count);
  const column = (block, body, axis, factor) => {
    const from = start + count * (1 + 2 * bodies * block) + 2 * (body - 1) + axis;
    return Float32Array.from(time, (_, i) => factor * all[from + 2 * bodies * i]);
  };
  return { about, time, position: (body, axis) => column(0, body, axis, MM), acceleration: (body, axis) => column(1, body, axis, 1) };
}
const size = (x, y) => Float32Array.from(x, (value, i) => Math.hypot(value, y[i]));

async function showMotions() {
  const scene = sceneNow(), place = scene.places[state.place], plots = part("plots");
  part("play").hidden = !place;
  if (!place) {
    plots.replaceChildren(element("p", "soft", "No motion is stored."));
    part("demands").replaceChildren();
    return;
  }
  part("distance").textContent = state.away === null ? place.why : `the nearest stored motion is ${degrees(state.away)} away from where you clicked${place.why ? `: ${place.why}` : ""}`;
  const all = await motionNumbers(), pair = pairNow(), models = [pair.first, pair.second];
  const motions = models.map(key => motionOf(all, place, key, scene.bodies));
  const notes = motions.flatMap((motion, k) => motion.time.length
    ? motion.about.status === "ok" ? [] : [`${study.titles[models[k]]} ended early: ${motion.about.status}`]
    : [`${study.titles[models[k]]}: ${motion.about ? motion.about.error_message || motion.about.status : "no motion is stored at this phase pair"}`]);
  plots.replaceChildren(...notes.map(note => element("p", "note", ...indexed(note))), ...motionFigures(scene, models, motions));
  startFilm(scene, models.map(key => study.titles[key]), motions);
}

// every plot has both models: the first solid, the second dashed
function motionFigures(scene, models, motions) {
  const { body } = state, shown = motions.map((motion, k) => ({ motion, k })).filter(({ motion }) => motion.time.length);
  const line = k => ({ name: study.titles[models[k]], color: k, dash: k ? "5 3" : "", width: k ? 1.4 : 1.8 });
  const over = (title, unit, pick, extra = {}) => plotFigure(title, {
    label: `${title} over time, ${scene.title}, ${models.map(key => study.titles[key]).join(" and ")}`, height: 200,
    x: { title: "t, s", range: [0, scene.duration] }, y: { title: unit }, series: shown.map(({ motion, k }) => ({ ...line(k), x: [...motion.time], y: [...pick(motion)], ...extra })),
  });
  const name = body === 1 ? "platform" : `body ${body}`;
  const figures = [
    over(`displacement of the ${name} in x`, "mm", motion => motion.position(body, 0)),
    over(`displacement of the ${name} in y`, "mm", motion => motion.position(body, 1)),
    over(`absolute acceleration of the ${name}`, "m/s²", motion => size(motion.acceleration(body, 0), motion.acceleration(body, 1))),
  ];
  figures.push(plotFigure("path of the contact", {
    label: `path of the contact seen from above, ${scene.title}`, height: 260, equal: true, x: { title: "x₁, mm" }, y: { title: "y₁, mm" },
    series: shown.map(({ motion, k }) => ({ ...line(k), x: [...motion.position(1, 0)], y: [...motion.position(1, 1)] })),
  }));
  figures.push(plotFigure("rest of the platform", {
    label: `when the platform rests, ${scene.title}`, height: 110, x: { title: "t, s", range: [0, scene.duration] }, legend: true,
    y: { title: "", range: [-0.6, 1.6], ticks: [[0, "2nd"], [1, "1st"]] },
    series: shown.map(({ motion, k }) => ({ ...line(k), dash: "", width: 9, x: motion.about.stick.flatMap(([a, b]) => [a, b, b]), y: motion.about.stick.flatMap(() => [1 - k, 1 - k, null]) })),
  }));
  return figures;
}
