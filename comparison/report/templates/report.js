"use strict";
const data = JSON.parse(document.getElementById("data").textContent);
let pair = "total";
const chosen = {};  // by scene: the stored phase pair whose motions are shown

// the plotting library is unpacked when the page stands: reading, links and tables do not wait for it
let library = null;
const plotting = () => library ??= unpacked("plotly").then(buffer => {
  const script = document.createElement("script");
  script.textContent = new TextDecoder().decode(buffer);
  document.head.append(script);
});

// a browser keeps only about sixteen drawing contexts: draw what is in view, drop what is not
const boxes = [...document.querySelectorAll(".surfaces, .record")];
const visible = new Set();
async function show(box) {
  try {
    await plotting();
    if (!visible.has(box)) return;
    if (box.classList.contains("record")) {  // no surface: its one motion of each model, at once
      if (box.parentElement.querySelector(".motions").hidden && data.scenes[box.dataset.scene].places.length) await choose(box, 0);
      return;
    }
    await drawSurfaces(box, data, pairOf(box), chosen[box.dataset.scene]);
    if (box.linked) return;
    box.linked = true;
    linkCameras(box);
    box.on("plotly_hover", ({ points: [point] }) => { box.under = point; });
    box.on("plotly_unhover", () => { box.under = null; });
  } catch (fault) {
    box.replaceChildren(`The surfaces could not be drawn (${fault.message}): see the static figure below.`);
    box.parentElement.querySelector("details").open = true;
  }
}
const pairOf = box => data.scenes[box.dataset.scene].pairs[pair] ? pair : "total";
const watcher = new IntersectionObserver(entries => entries.forEach(({ target, isIntersecting }) => {
  if (isIntersecting && !visible.has(target)) { visible.add(target); show(target); }
  if (!isIntersecting && visible.delete(target) && target.linked) {
    target.querySelectorAll("canvas").forEach(canvas => canvas.getContext("webgl")?.getExtension("WEBGL_lose_context")?.loseContext());
    Plotly.purge(target);
    target.linked = false;
  }
}), { rootMargin: "150px" });
boxes.forEach(box => watcher.observe(box));
addEventListener("load", () => (window.requestIdleCallback ?? setTimeout)(plotting));

// the motions below a surface: of the phase pair that was clicked or selected there
async function choose(box, index) {
  const scene = data.scenes[box.dataset.scene], place = scene.places[index], own = box.parentElement;
  chosen[box.dataset.scene] = index;
  own.querySelector("select").value = String(index);
  const plot = own.querySelector(".motions");
  plot.hidden = false;
  await plotting();
  const notes = await drawMotions(plot, scene, Number(box.dataset.body), place, scene.pairs[pairOf(box)], data.titles);
  own.querySelector(".notes").textContent = [...notes, place.why].filter(Boolean).join("; ");
  boxes.filter(other => other.dataset.scene === box.dataset.scene && visible.has(other)).forEach(show);
}
boxes.forEach(box => {
  let pressed = null;  // a turn also begins with a press on a surface: only a press that stays in its place is a click
  box.addEventListener("pointerdown", press => { pressed = { x: press.clientX, y: press.clientY, under: box.under }; }, true);
  box.addEventListener("pointerup", lift => {
    const places = data.scenes[box.dataset.scene].places;
    if (!pressed?.under || !places.length || Math.hypot(lift.clientX - pressed.x, lift.clientY - pressed.y) > 4) return;
    choose(box, nearest(places, pressed.under.x, pressed.under.y));
  }, true);
  const select = box.parentElement.querySelector("select");
  data.scenes[box.dataset.scene].places.forEach((place, index) => select.add(new Option([named(place), place.why].filter(Boolean).join(", "), index)));
  select.addEventListener("change", () => { if (select.value !== "") choose(box, Number(select.value)); });
});

const buttons = [...document.querySelectorAll("button[data-pair]")];
buttons.forEach(button => button.addEventListener("click", () => {
  pair = button.dataset.pair;
  buttons.forEach(other => other.setAttribute("aria-pressed", String(other === button)));
  visible.forEach(show);
  boxes.filter(box => !box.parentElement.querySelector(".motions").hidden).forEach(box => choose(box, chosen[box.dataset.scene]));
}));

document.querySelectorAll("table.sortable").forEach(table => {
  const headings = [...table.tHead.rows[0].cells];
  headings.forEach((heading, column) => heading.addEventListener("click", () => {
    const down = heading.getAttribute("aria-sort") === "ascending";
    headings.forEach(other => other.removeAttribute("aria-sort"));
    heading.setAttribute("aria-sort", down ? "descending" : "ascending");
    const key = row => row.cells[column].dataset.value ?? row.cells[column].textContent;
    const order = (one, other) => {
      const a = key(one), b = key(other), x = Number(a), y = Number(b);
      return Number.isNaN(x) || Number.isNaN(y) ? a.localeCompare(b) : x - y;
    };
    const rows = [...table.tBodies[0].rows].sort(order);
    table.tBodies[0].append(...(down ? rows.reverse() : rows));
  }));
});

addEventListener("beforeprint", () => document.querySelectorAll("details.static").forEach(part => { part.open = true; }));
