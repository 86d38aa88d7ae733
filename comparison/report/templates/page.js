"use strict";
// the page itself: explanations at words, the switch of the bars, links into folded sections; then the data
const tip = document.getElementById("tip");
function explain(word) {
  tip.textContent = word.dataset.tip;
  tip.hidden = false;
  const box = word.getBoundingClientRect(), width = tip.offsetWidth, left = Math.min(Math.max(8, box.left), document.documentElement.clientWidth - width - 8);
  tip.style.left = `${left + scrollX}px`;
  tip.style.top = `${(box.bottom + tip.offsetHeight + 8 > innerHeight && box.top > tip.offsetHeight + 8 ? box.top - tip.offsetHeight - 6 : box.bottom + 6) + scrollY}px`;
  word.setAttribute("aria-describedby", "tip");
}
function hush(word) {
  tip.hidden = true;
  word.removeAttribute("aria-describedby");
}
document.querySelectorAll(".term").forEach(word => {
  ["mouseenter", "focus"].forEach(name => word.addEventListener(name, () => explain(word)));
  ["mouseleave", "blur"].forEach(name => word.addEventListener(name, () => hush(word)));
});
document.addEventListener("keydown", event => { if (event.key === "Escape") tip.hidden = true; });

const bars = [...document.querySelectorAll("button[data-bars]")];
bars.forEach(button => button.addEventListener("click", () => {
  bars.forEach(other => other.setAttribute("aria-pressed", String(other === button)));
  document.querySelectorAll("[data-waterfall]").forEach(table => { table.hidden = table.dataset.waterfall !== button.dataset.bars; });
}));

function openTarget() {
  const target = location.hash.length > 1 && document.getElementById(decodeURIComponent(location.hash.slice(1)));
  if (target instanceof HTMLDetailsElement) target.open = true;
  if (target) target.scrollIntoView();
}
addEventListener("hashchange", openTarget);
document.querySelectorAll("a[data-show-scene]").forEach(link => link.addEventListener("click", () => { if (study) chooseScene(Number(link.dataset.showScene)); }));
// paper has nothing folded, light colors, plots and surfaces in the size they have there, and no time to wait for them
let unfolded = [];
addEventListener("beforeprint", () => {
  paper.printing = true;
  document.documentElement.dataset.paper = "";
  unfolded = [...document.querySelectorAll("details:not([open])")];
  unfolded.forEach(details => { details.open = true; });
  document.querySelectorAll(".plot").forEach(drawStanding);
  if (study && part("scene")?.options.length) drawPaper();
});
addEventListener("afterprint", () => {
  paper.printing = false;
  delete document.documentElement.dataset.paper;
  unfolded.forEach(details => { details.open = false; });
  document.querySelectorAll(".plot").forEach(drawStanding);
  part("paper")?.replaceChildren();
});

unpacked("data").then(buffer => {
  study = JSON.parse(new TextDecoder().decode(buffer));
  for (const scene of study?.scenes ?? []) scene.places ??= [];  // a report without motions
  if (part("scene")?.options.length) startViewer();
  document.documentElement.dataset.ready = "true";
  openTarget();
});
