// Puts the page together, and links its parts: what is picked lights up everywhere.
let PICKED = null;

/** Picks a block: `from` is the part of the page that asked for it. */
function pick(place, from) {
  PICKED = place;
  const own = block(place);
  details(own);
  light(own);
  if (from !== "chart" && from !== "start") reveal(own);
  redraw();
  for (const node of document.querySelectorAll("[data-block]")) {
    const same = Number(node.dataset.block) === place;
    if (node.tagName === "TR") node.classList.toggle("picked", same);
    else node.setAttribute("aria-pressed", String(same));
  }
}

/** Zooms out or moves where the block is not in sight. */
function reveal(own) {
  const first = CHARTS.find((it) => span(own, it.which));
  if (!first) return;
  const when = span(own, first.which);
  const { min, max } = first.plot.scales.x;
  if (when[0] >= min && when[1] <= max) return;
  const wide = Math.max(max - min, (when[1] - when[0]) * 1.5);
  const middle = (when[0] + when[1]) / 2;
  zoom([Math.max(0, middle - wide / 2), middle + wide / 2], first.which);
}

function step(by) {
  if (BARS.count === 0) return;
  const bar = PICKED === null ? (by > 0 ? -1 : BARS.count) : barOf(block(PICKED).row);
  const next = Math.min(BARS.count - 1, Math.max(0, bar + by));
  pick(BARS.lead[next], "step");
}

function largest(from) {
  const later = COMPARED ? HEAD.after.peak_w > HEAD.before.peak_w : LIMITED && HEAD.before.unfit_count === 0;
  const side = later ? "after" : "before";
  const [first] = DATA.moments[side];
  if (first) pick(first.block, from);
  else if (DATA.worst.length > 0) pick(DATA.worst[0], from);
}

function notes() {
  const bound = Array.isArray(BARS.bound) ? BARS.bound.includes(true) : BARS.bound;
  const power = [];
  if (COMPARED) power.push("Block by block the second machine’s peaks stand where the same blocks are on the first one.");
  if (bound) power.push("Dashed: a bound for any way in which the control may blend moves; the areas show such moves with stops.");
  if (SIDES.some((it) => !it.shares)) power.push("The planned power by axis is not at hand for this program; the peaks are.");
  if (SIDES.some((it) => it.shares && !it.shares.whole)) power.push("The program has more moves than can be drawn one by one: neighbours share a bar as high as the highest, and areas show the largest power of each span.");
  const limits = SIDES.flatMap((which) => which.limits);
  if (SIDES.some((it) => it.limits.length > 1)) power.push("With several converters the line is the peak of the one that is loaded most; the areas are all of them together.");
  if (limits.some((it) => it.credit_regen)) power.push("What is fed back feeds the other axes: the line is the difference of both areas.");
  power.push(...voltageNotes());
  element("power-note").textContent = power.join(" ");
  const path = [`Machine coordinates${SPACE ? `, ${SPACE.size.map((it) => digits(it)).join(" × ")} mm` : ""}, drawn to within ${PATH.error_mm < 0.01 ? "0.01" : digits(PATH.error_mm)} mm.`];
  if (PATH.independent) path.push("Rapids of axes that move each for itself are drawn as lines from start to end.");
  if (COMPARED) path.push("The path is that of the first machine, with moves that only the second one makes.");
  if (PATH.unknown > 0) path.push(`${PATH.unknown} moves are not drawn, since their start is not known.`);
  path.push("Turn by dragging, zoom by the wheel after a click.");
  element("space-note").textContent = path.join(" ");
}

function conditions() {
  const list = element("condition-list");
  const reasons = HEAD.limited ? HEAD.limited.reasons.slice(0, 50).map(([line, text]) => (line > 0 ? `line ${line}: ${text}` : text)) : [];
  for (const text of [...reasons, ...HEAD.notes, ...HEAD.conditions]) list.append(make("li", {}, text));
  list.append(make("li", {}, "gwatt works with a model and protects nothing: the drives’ own limits stay on."));
}

function start() {
  document.title = `${HEAD.program}: ${HEAD.word} (gwatt)`;
  const name = HEAD.program.split(/[\\/]/).pop() || HEAD.program;
  element("program").textContent = name;
  const on = (own) => `${own.machine}, read as ${own.controller}`;
  const where = COMPARED ? `from ${on(HEAD)}, to ${on(COMPARED)}` : `on ${on(HEAD)}`;
  element("machine").textContent = `${name === HEAD.program ? "" : `${HEAD.program} `}${where}`;
  element("verdict").textContent = HEAD.word;
  element("verdict").className = HEAD.fits ? "fits" : "misses";
  element("made").textContent = `Made by gwatt ${HEAD.gwatt}. Charts: uPlot (MIT). Path: three.js (MIT).`;
  programs();
  tiles();
  drawCharts();
  peakTables();
  worstTable();
  overTime();
  conditions();
  details(null);
  element("largest").addEventListener("click", () => largest("step"));
  element("previous").addEventListener("click", () => step(-1));
  element("next").addEventListener("click", () => step(1));
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
    redraw();
    if (SPACE) paint(SPACE.paint);
    show();
  });
  largest("start");
  // What takes longest comes once all else is seen.
  requestAnimationFrame(() => setTimeout(later));
}

function later() {
  drawSpace();
  notes();
  if (PICKED !== null) light(block(PICKED));
  document.documentElement.dataset.ready = "";
}

start();
