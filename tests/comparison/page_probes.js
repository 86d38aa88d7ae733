// what the tests of the page ask its scripts; each answer is read in report/test_page_in_a_browser.py
globalThis.probe = {
  // all that a body could borrow from the first is made another one; the second model has two phases per axis
  surfacesOfSecondBody() {
    const scene = sceneNow(), [total, surfaces] = scene.pairs, model = scene.models[total.second], seen = [], two = value => [[value, value], [value, value]];
    const tell = changes => { change(changes); seen.push(shown.map(({ rows, sheet, points, lines, notes }) => ({ rows, sheet, points, lines, notes }))); };
    Object.assign(model, { phases: 2, mu: [1, 9].map(two), error: [two(0.1), [[0.3, 0.4], [0.5, null]]], completed: [null, null] });
    total.uncertainty = [0.01, 0.07].map(two);
    surfaces.contours = [[], [[[1, 2], [3, 4]]]];
    scene.worst[total.first] = [[0, 0, 1, total.first], [Math.PI / 2, Math.PI, 8.25, total.first]];
    total.user = true;
    chooseScene(0, 2);
    const opened = [state.pair, state.place];
    total.user = false;
    scene.places[1].motions = scene.places[1].motions.filter(motion => motion.model !== surfaces.second);
    chooseScene(0, 2);
    opened.push(state.pair, state.place);
    tell({ pair: total.key, cursor: [Math.PI, Math.PI] });
    const readout = part("readout").textContent;
    tell({ grid: "second" });
    model.completed[1] = { through: "exact", certificate: "", reason: "", difference: false, mu: scene.models.exact.mu[1] };
    tell({ grid: "own" });
    model.completed[1].difference = true;
    tell({});
    tell({ pair: surfaces.key });
    return { opened, readout, name: canvases[1].closest("figure").querySelector("b").textContent, seen };
  },
  async notesOfMotions() {
    const { motions } = sceneNow().places[state.place], of = key => motions.find(({ model }) => model === key);
    Object.assign(of(pairNow().first), { status: "rim reached" });
    Object.assign(of(pairNow().second), { count: 0, status: "solver failed", error_message: "it broke" });
    await showMotions();
    return [...part("plots").querySelectorAll(".note")].map(note => note.textContent);
  },
  // every column of the motion begins at zero and ends at a number of its own; the first model has none
  motionOfSecondBody() {
    const columns = [1, 11, 12, 13, -14, 1, 2, 3, 4, 21, 22], scene = sceneNow(), models = ["exact", "spatial"];
    const about = { model: "spatial", status: "ok", stick: [], start: 0, count: 2, exponents: columns.map(() => 0), spectra: [[[10], [11]], [[20], [21]]],
      blocks: { time: [0, 1], position: [1, 4], acceleration: [5, 4], isolator_force: [9, 2] } };
    const motions = models.map(key => motionOf(Int32Array.from(columns.flatMap(end => [0, end])), { motions: [about] }, key));
    state.body = 2;
    const last = motionFigures(scene, models, motions).map(figure => [figure.querySelector("figcaption").firstChild.textContent, ...figure.querySelector(".plot").spec.series.map(({ x, y }) => [x.at(-1), y.at(-1)])]);
    const drawn = [], above = [], texts = [], frames = [], { fillRect, fillText, arc } = CanvasRenderingContext2D.prototype;
    CanvasRenderingContext2D.prototype.arc = (x, y, radius) => { if (radius === 4) above.push([x, y]); };
    CanvasRenderingContext2D.prototype.fillRect = function (x, y, width) { drawn.push([x + width / 2, this.fillStyle]); };
    CanvasRenderingContext2D.prototype.fillText = text => texts.push(text);
    startFilm(scene, models, motions);
    for (film.time of [0, 1]) film.draw();
    Object.assign(CanvasRenderingContext2D.prototype, { fillRect, fillText, arc });
    requestAnimationFrame = tick => frames.push(tick);
    film.time = scene.duration;
    const played = [film.time, ...[0, 1].map(number => {
      part("start").click();
      frames[number]?.(film.last + 500);
      return [part("start").textContent, film.time, frames.length];
    })].slice(1);
    return { last, middles: drawn.slice(-4).map(([x]) => x), colors: [drawn.at(-1)[1], variable("--c1")], said: texts.at(-1), played, above: above.slice(1, 3) };
  },
  demands() {
    const one = { displacement: [0.2, 0.03], base_shear: [4, 0.1] }, other = { displacement: [0.25, 0.021], travel_share: [0.5, 0], base_shear: [3, 0.1] }, models = ["exact", "spatial"];
    const rows = (...both) => demandsTable(sceneNow(), { motions: models.map((model, k) => ({ model, demands: both[k] })) }, models)[0].querySelectorAll("tbody tr");
    const none = demandsTable(sceneNow(), { motions: models.map(model => ({ model, demands: { displacement: null } })) }, models);
    return [...[rows(one, other), rows(null, other)].map(list => [...list].map(row => [...row.cells].map(cell => cell.textContent))), none];
  },
  // a value without a logarithm is left out; a bar and a band that reach below zero
  plotWithLogarithms() {
    const box = element("div"), x = [1, 2, 3, 4], y = [10, -1, null, 30], low = [-5, 1, 1, 20], high = [20, 2, 2, 40], all = name => [...box.querySelectorAll(name)];
    const one = { name: "a", x, y, low, high, marks: 1, color: 0, titles: ["p", "q", "r", "s"] };
    drawPlot(box, { x: { title: "v_reg, m/s" }, y: { log: true, range: [1, 100] }, legend: false, series: [one, { ...one, low: [5, 1, 1, 20], band: true, marks: false }] });
    return { titles: all("polygon.mark title").map(each => each.textContent), legends: all(".legend").length, text: box.innerHTML, bars: all("line.line").map(bar => bar.getAttribute("y1") - bar.getAttribute("y2")), path: all("g path")[0].getAttribute("d"),
      around: all("polygon.area")[0].getAttribute("points").split(" ").map(point => point.split(",")[0]), shifts: all("tspan[dy]").map(each => each.getAttribute("dy")) };
  },
  contactPaths() {
    const columns = { yaw: [0, 0.2] }, motion = { position: (body, axis) => axis ? [30, 40] : [10, 20], column: name => columns[name] };
    return [contactPaths({ contact: { lever: 0.5, supports: [[1, 2], [-3, 4]] } }, motion), contactPaths({ contact: { lever: null, supports: null } }, motion)];
  },
  ranges: () => [[3, 3], [-2, 1, 4, null]].map(values => [true, false].map(log => rangeOf({ log }, values))),
  corner: () => nearestVertex({ rows: [[1, 2], [3, 4]], range: [0, 4] }, (a, b) => [100 * a, 100 * b, 0], 100 * turn, 100 * turn),
};
