"use strict";
// the platform and the bodies above it in motion: both models beside each other, seen from the side
const film = { time: 0, playing: false, frame: null, last: 0, draw: () => {} };
function startFilm(scene, titles, motions) {
  const slider = part("time"), canvas = viewer.querySelector("canvas.film");
  slider.max = String(scene.duration);
  film.time = Math.min(film.time, scene.duration);
  const shown = motions.map((motion, k) => ({ motion, title: titles[k], k })).filter(({ motion }) => motion.time.length);
  const moves = shown.map(({ motion }) => Array.from({ length: scene.bodies }, (_, i) => [motion.position(i + 1, 0), motion.position(i + 1, 1)]));
  const most = Math.max(1e-6, ...moves.flat(2).map(values => values.reduce((a, b) => Math.max(a, Math.abs(b)), 0)));
  const at = (k, body, axis) => {  // between two instants in proportion
    const { time } = shown[k].motion, list = moves[k][body][axis];
    let low = 0, high = time.length - 1;
    while (high - low > 1) { const middle = (low + high) >> 1; if (time[middle] <= film.time) low = middle; else high = middle; }
    const w = time[high] > time[low] ? Math.min(1, Math.max(0, (film.time - time[low]) / (time[high] - time[low]))) : 0;
    return (1 - w) * list[low] + w * list[high];
  };
  film.draw = () => {
    const [pen, width, height] = prepared(canvas), ink = variable("--ink"), soft = variable("--soft"), each = width / Math.max(1, shown.length), bowl = scene.flat ? 0 : 22;
    pen.clearRect(0, 0, width, height);
    shown.forEach(({ title, k }, column) => {
      const middle = each * (column + 0.5), reach = each * 0.3, ground = height - 34, color = variable(`--c${k}`), tall = Math.min(34, (ground - 60) / scene.bodies);
      pen.fillStyle = soft;
      pen.textAlign = "center";
      pen.fillText(title.replaceAll("_", " "), middle, 14);
      pen.strokeStyle = soft;
      pen.lineWidth = 2;
      pen.beginPath();  // the bowl, deeper than it is, or the plane
      for (let x = -reach * 1.25; x <= reach * 1.25; x += 4) pen.lineTo(middle + x, ground - bowl * (x / reach) ** 2);
      pen.stroke();
      pen.lineWidth = 1;
      let above = null;
      for (let body = 0; body < scene.bodies; body++) {
        const x = middle + reach * at(column, body, 0) / most, rise = body ? 0 : bowl * ((x - middle) / reach) ** 2, y = ground - 10 - rise - body * (tall + 8) - (body ? 8 : 0), wide = body ? each * 0.11 : each * 0.17;
        pen.strokeStyle = color;
        if (above) strokeLine(pen, [[above[0], above[1] - 6], [x, y + 6]]);
        pen.fillStyle = color;
        pen.globalAlpha = body ? 0.55 : 1;
        pen.fillRect(x - wide, y - 6, 2 * wide, 12);
        pen.globalAlpha = 1;
        if (body === 0) dot(pen, x, y + 8, 3, ink);
        above = [x, y];
      }
      const size = Math.min(34, each * 0.12), [cx, cy] = [middle + each / 2 - size - 6, 20 + size];  // seen from above: the platform's path
      pen.strokeStyle = soft;
      pen.strokeRect(cx - size, cy - size, 2 * size, 2 * size);
      dot(pen, cx + size * at(column, 0, 0) / most, cy - size * at(column, 0, 1) / most, 4, color);
    });
    pen.fillStyle = soft;
    pen.textAlign = "left";
    pen.fillText(`horizontal: ${digits(most, 2)} mm to either side`, 6, height - 8);
    part("clock").textContent = `${film.time.toFixed(2)} s`;
    slider.value = String(film.time);
  };
  slider.oninput = () => { film.time = Number(slider.value); film.draw(); };
  part("start").onclick = () => setPlaying(!film.playing, scene.duration);
  film.draw();
}
function setPlaying(playing, duration) {
  film.playing = playing;
  part("start").textContent = playing ? "pause" : "play";
  if (film.time >= duration) film.time = 0;
  film.last = performance.now();
  const tick = now => {
    if (!film.playing) return;
    film.time += (now - film.last) / 1000;
    film.last = now;
    if (film.time >= duration) { film.time = duration; setPlaying(false, Infinity); }
    film.draw();
    if (film.playing) requestAnimationFrame(tick);
  };
  if (playing) requestAnimationFrame(tick);
}
