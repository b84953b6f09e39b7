// --- the page ---
const original = JSON.parse(document.getElementById("data").textContent);
const copy = (value) => JSON.parse(JSON.stringify(value));
let data = copy(original);
// The circle that is drawn: radius in mm, path speed in mm/min, and which two axes.
const circle = { radius_mm: 20, feed_mm_min: 3000, pair: [0, 1] };
const IDEAL = { letter: "an ideal axis", input: "command", inertia: null, delay_ms: 0, zeros: [], further_zeros: [], poles: [] };
const ROOTS = { zeros: "zero", further_zeros: "further zero", poles: "pole" };
const ROOTS_MAX = 32;
const sample = (range, count, value) => Array.from({ length: count }, (_, k) => {
  const hz = range[0] * (range[1] / range[0]) ** (k / (count - 1));
  return [hz, value(hz)];
});
const place = (id) => document.getElementById(id);
const filtersOf = () => data.axes.map((_, index) => sections(data.axes, index, data.wish));

// How far the model is from what was measured, in dB, where the recording shows something.
function apart(axis) {
  const { frequency_hz, gain_db, coherence } = axis.measured;
  let sum = 0, weights = 0;
  frequency_hz.forEach((hz, k) => {
    const weight = coherence?.[k] ?? 1;
    const off = gain_db[k] - db(abs(model(axis, hz)));
    if (!Number.isFinite(off) || weight < 0.5) return;
    sum += weight * off * off / hz;
    weights += weight / hz;
  });
  return weights > 0 ? Math.sqrt(sum / weights) : null;
}

function drawAxis(axis, box) {
  const measured = axis.measured;
  const found = measured ? measured.frequency_hz : [];
  const range = found.length > 1 ? [found[0], found[found.length - 1]] : [1, 0.5e3 / data.wish.period_ms];
  const list = (values) => found.map((hz, k) => [hz, values[k], measured.coherence?.[k] ?? 1]);
  const gains = [{ kind: "model", points: sample(range, 400, (hz) => db(abs(model(axis, hz)))) }];
  const phases = [{ kind: "model", wraps: true, points: sample(range, 400, (hz) => deg(mul(model(axis, hz), turn(-TAU * hz * axis.hold_s)))) }];
  const nodes = [];
  if (measured) {
    gains.unshift({ kind: "measured", points: list(measured.gain_db) });
    phases.unshift({ kind: "measured", wraps: true, points: list(measured.phase_deg) });
    const off = apart(axis);
    if (off !== null) nodes.push(el("p", { class: "apart" }, `Model and measurement are ${off.toFixed(2)} dB apart (rms by octave, where the recording shows the axis).`));
  }
  box.replaceChildren(plot(`${axis.letter}: gain, dB`, gains, range, 240), plot("phase, degrees", phases, range, 180), ...nodes);
}

function drawFilters(filters) {
  const wish = data.wish;
  const held = wish.discretize === "zoh";
  const said = held ? ["Filters by zero-order hold are made by gwatt tune --from; these are Tustin's."]
    : [`${wish.discretize}, period ${wish.period_ms} ms, ` + (wish.order ? `low-pass of order ${wish.order} at ${wish.bandwidth_hz.toFixed(1)} Hz.` : "no low-pass.")];
  const least = needed(data.axes);
  if (data.axes.length === 1) said.push("A filter has the zeros of the other axes: with one axis there is none. Give a recording of each axis that moves with it.");
  else if (least === 0) said.push("No axis has a zero: nothing is to be evened out.");
  else if (!wish.no_low_pass && wish.order < least) said.push(`The order must be ${least} or more: the filter would not be causal.`);
  else if (wish.no_low_pass && wish.discretize !== "matched") said.push("Without a low-pass only matched filters are causal.");
  const most = 400 / wish.period_ms;
  if (wish.order && wish.bandwidth_hz > most) said.push(`The low-pass must be at ${most.toFixed(1)} Hz or lower.`);
  place("filter-note").textContent = said.join(" ");
  const head = el("tr", {}, ...["axis", "section", "b0", "b1", "b2", "a1", "a2"].map((name) => el("th", {}, name)));
  const rows = filters.flatMap((list, index) => list.map((section, k) =>
    el("tr", {}, ...[data.axes[index].letter, String(k + 1), ...section.map((c) => c.toFixed(9))].map((cell) => el("td", {}, cell)))));
  place("filters").replaceChildren(head, ...rows);
}

function drawMatch(filters) {
  const period = data.wish.period_ms * 1e-3;
  const range = [data.band_hz / 100, data.band_hz];
  const plots = [];
  // Of the two axes that differ most without filters, what they come to with them.
  let worst = null;
  for (let i = 0; i < data.axes.length; i++) {
    for (let j = i + 1; j < data.axes.length; j++) {
      const [a, b] = [data.axes[i], data.axes[j]];
      const before = (hz) => div(follows(a, hz), follows(b, hz));
      const after = (hz) => mul(before(hz), div(response(filters[i], hz, period), response(filters[j], hz, period)));
      const largest = (ratio, part) => Math.max(...sample(range, 500, (hz) => Math.abs(part(ratio(hz)))).map((p) => p[1]));
      const gain = (c) => db(abs(c));
      if (!worst || largest(before, gain) > worst.apart) {
        worst = { apart: largest(before, gain), said: `${a.letter} and ${b.letter} answer ${largest(before, gain).toFixed(2)} dB apart up to ${data.band_hz} Hz, with the filters ${largest(after, gain).toFixed(2)} dB` };
      }
      const say = (ratio) => `${largest(ratio, gain).toFixed(3)} dB and ${largest(ratio, deg).toFixed(2)}°`;
      plots.push(el("p", {}, `${a.letter} by ${b.letter}, up to ${data.band_hz} Hz: ${say(before)} apart; with the filters ${say(after)} (grey: without, green: with).`));
      for (const [title, part] of [[`${a.letter}/${b.letter}: gain, dB`, gain], ["phase, degrees", deg]]) {
        plots.push(plot(title, [
          { kind: "before", wraps: part === deg, points: sample(range, 400, (hz) => part(before(hz))) },
          { kind: "after", wraps: part === deg, points: sample(range, 400, (hz) => part(after(hz))) },
        ], range, 170));
      }
    }
  }
  if (plots.length === 0) plots.push(el("p", {}, "One axis: there is no other to be compared with."));
  place("headline").textContent = worst ? worst.said : `How ${data.axes.map((axis) => axis.letter).join(", ")} answers`;
  place("match").replaceChildren(...plots);
}

// --- the test circle ---
// Where the load goes, of a circle that has settled: x = R·|A|·cos(ωt + ∠A), y = R·|B|·sin(ωt + ∠B).
function run([a, b], radius) {
  const [x, y] = [[abs(a), Math.atan2(a[1], a[0])], [abs(b), Math.atan2(b[1], b[0])]];
  const points = Array.from({ length: 720 }, (_, k) => {
    const t = TAU * k / 720;
    return [radius * x[0] * Math.cos(t + x[1]), radius * y[0] * Math.sin(t + y[1])];
  });
  const distances = points.map(([u, v]) => Math.hypot(u, v));
  const [least, most] = [Math.min(...distances), Math.max(...distances)];
  return { points, roundness_mm: most - least, shrinkage_mm: radius - distances.reduce((p, q) => p + q, 0) / 720, off_mm: Math.max(most - radius, radius - least) };
}
const micro = (mm) => {
  const um = Math.abs(1e3 * mm);
  return um >= 9999.5 ? `${(um / 1e3).toFixed(2)} mm` : `${um.toFixed(2)} µm`;
};
function drawCircle(filters) {
  const period = data.wish.period_ms * 1e-3;
  const { radius_mm, feed_mm_min } = circle;
  const hz = feed_mm_min / 60 / (TAU * radius_mm);
  const [i, j] = circle.pair;
  const axes = [data.axes[i], data.axes[j] ?? IDEAL];
  const plain = axes.map((axis) => follows(axis, hz));
  const filtered = [i, j].map((index, k) => mul(plain[k], response(filters[index] ?? [], hz, period)));
  const has = filters.some((list) => list.length > 0);
  const runs = [{ kind: "before", ...run(plain, radius_mm) }];
  if (has) runs.push({ kind: "after", ...run(filtered, radius_mm) });
  // Errors are drawn larger, by a round factor, so that the largest is about a quarter of the radius.
  const off = Math.max(...runs.map((it) => it.off_mm), 1e-12);
  const wanted = 0.25 * radius_mm / off;
  const power = 10 ** Math.floor(Math.log10(wanted));
  const times = Math.max([1, 2, 5].map((digit) => digit * power).filter((it) => it <= wanted).pop() ?? power, 1e-6);
  const size = 420;
  const scale = 0.36 * size / radius_mm;
  const at = ([u, v]) => `${(size / 2 + scale * u).toFixed(1)} ${(size / 2 - scale * v).toFixed(1)}`;
  const larger = ([u, v]) => {
    const distance = Math.hypot(u, v) || 1;
    const factor = (radius_mm + times * (distance - radius_mm)) / distance;
    return [u * factor, v * factor];
  };
  const around = (points) => `M${points.map(at).join("L")}Z`;
  const svg = el("svg", { viewBox: `0 0 ${size} ${size}`, role: "img", "aria-label": "Test circle, with the error drawn larger" });
  const nominal = Array.from({ length: 180 }, (_, k) => [radius_mm * Math.cos(TAU * k / 180), radius_mm * Math.sin(TAU * k / 180)]);
  svg.append(el("path", { class: "line nominal", d: around(nominal) }));
  for (const it of runs) svg.append(el("path", { class: `line ${it.kind}`, d: around(it.points.map(larger)) }));
  svg.append(el("text", { x: size - 8, y: size / 2 - 6, "text-anchor": "end" }, axes[0].letter), el("text", { x: size / 2 + 6, y: 16 }, axes[1].letter));
  const say = (it) => `${micro(it.roundness_mm)} out of round, ${micro(it.shrinkage_mm)} ${it.shrinkage_mm < 0 ? "larger" : "smaller"}`;
  const said = `${axes[0].letter} with ${axes[1].letter}, ${hz.toFixed(2)} turns a second: ${say(runs[0])} (grey)` + (has ? `; with the filters ${say(runs[1])} (green)` : "") + `. Dotted: as programmed. The error is drawn ${times >= 1 ? `${times} times larger` : `${1 / times} times smaller`}. Friction and backlash are not in it.`;
  place("circle").replaceChildren(svg);
  place("circle-note").textContent = said;
}

function drawRest() {
  const filters = filtersOf();
  drawFilters(filters);
  drawMatch(filters);
  drawCircle(filters);
}

// --- controls ---
// A slider and a number field for one figure; the slider runs by factors.
function control(name, object, key, redraw) {
  const start = object[key];
  const slides = start > 0;
  const slider = el("input", { type: "range", min: -1, max: 1, step: 0.001, "aria-label": name });
  const field = el("input", { type: "number", step: "any", "aria-label": name });
  const span = key === "damping" ? 5 : 2;
  const show = () => {
    field.value = Number(object[key].toPrecision(7));
    if (slides) slider.value = Math.log(object[key] / start) / Math.log(span);
  };
  show();
  slider.disabled = !slides;
  slider.addEventListener("input", () => {
    object[key] = start * span ** Number(slider.value);
    show();
    redraw();
  });
  field.addEventListener("input", () => {
    const value = Number(field.value);
    const fits = field.value !== "" && Number.isFinite(value) && (key === "damping" || value > 0);
    field.setCustomValidity(fits ? "" : "a number above 0");
    if (!fits) return;
    object[key] = value;
    if (slides && value > 0) slider.value = Math.log(value / start) / Math.log(span);
    redraw();
  });
  return el("label", {}, name, slider, field);
}
function button(text, name, act) {
  const node = el("button", { type: "button", "aria-label": name }, text);
  node.addEventListener("click", act);
  return node;
}
// A root where the model lacks one most: a zero where less was measured, a pole where more was.
function missing(axis, key) {
  const sign = key === "poles" ? 1 : -1;
  let best = { by: -Infinity, hz: data.band_hz / 2 };
  axis.measured?.frequency_hz.forEach((hz, k) => {
    if ((axis.measured.coherence?.[k] ?? 1) < 0.3) return;
    const by = sign * (axis.measured.gain_db[k] - db(abs(model(axis, hz))));
    if (by > best.by) best = { by, hz };
  });
  return Number(best.hz.toPrecision(4));
}
// The order that the low-pass needs, after zeros were added or removed.
function keepCausal() {
  const wish = data.wish;
  const least = needed(data.axes);
  const spare = wish.discretize === "zoh" ? 2 : 0;
  if (wish.no_low_pass) return;
  if (least === 0) wish.order = 0;
  else if (wish.order < least + spare) wish.order = least + spare;
  if (wish.order && !(wish.bandwidth_hz > 0)) {
    const highest = Math.max(...data.axes.flatMap((axis) => axis.zeros.map((zero) => zero.frequency_hz)));
    wish.bandwidth_hz = Math.min(3 * highest, 400 / wish.period_ms);
  }
}
function rootsOf(axis, key, redraw) {
  const title = ROOTS[key];
  const fields = axis[key].map((root, k) => {
    const name = `${title} ${k + 1}`;
    const inputs = root.time_constant_s === undefined
      ? [control("frequency, Hz", root, "frequency_hz", redraw), control("damping", root, "damping", redraw)]
      : [control("time constant, s", root, "time_constant_s", redraw)];
    const remove = button("Remove", `Remove ${name} of ${axis.letter}`, () => {
      axis[key].splice(k, 1);
      keepCausal();
      build();
    });
    return el("fieldset", {}, el("legend", {}, name), ...inputs, remove);
  });
  const add = (text, made) => button(text, `${text} of ${axis.letter}`, () => {
    if (axis.zeros.length + axis.further_zeros.length + axis.poles.length >= ROOTS_MAX) return;
    axis[key].push(made());
    keepCausal();
    build();
  });
  const pair = add(`Add a ${title}`, () => ({ frequency_hz: missing(axis, key), damping: 0.03 }));
  const single = add(`Add a real ${title}`, () => ({ time_constant_s: Number((1 / (TAU * missing(axis, key))).toPrecision(4)) }));
  return [...fields, el("p", { class: "add" }, pair, ...(key === "zeros" ? [] : [single]))];
}
function controlsOf(axis, redraw) {
  const list = [];
  const single = [];
  if (axis.inertia) single.push(control(axis.inertia_key === "mass_kg" ? "mass, kg" : "inertia, kg·m²", axis, "inertia", redraw));
  if (axis.delay_ms > 0) single.push(control("delay, ms", axis, "delay_ms", redraw));
  if (axis.position_gain_1_s) single.push(control("loop gain, 1/s", axis, "position_gain_1_s", redraw));
  if (single.length > 0) list.push(el("fieldset", {}, ...single));
  for (const key of Object.keys(ROOTS)) list.push(...rootsOf(axis, key, redraw));
  return list;
}
function buildWish() {
  const wish = data.wish;
  const none = el("input", { type: "checkbox" });
  none.checked = wish.no_low_pass;
  none.addEventListener("change", () => {
    wish.no_low_pass = none.checked;
    if (none.checked) wish.order = 0;
    keepCausal();
    build();
  });
  const list = [el("label", { class: "check" }, none, "no low-pass: for commands without jumps of acceleration")];
  if (wish.order) {
    const order = el("input", { type: "number", min: 1, max: 24, step: 1, "aria-label": "order of the low-pass" });
    order.value = wish.order;
    order.addEventListener("input", () => {
      const value = Number(order.value);
      const fits = Number.isInteger(value) && value >= Math.max(1, needed(data.axes)) && value <= 24;
      order.setCustomValidity(fits ? "" : `a whole number from ${needed(data.axes)} to 24`);
      if (!fits) return;
      wish.order = value;
      drawRest();
    });
    list.push(el("label", {}, "low-pass order", el("span"), order), control("low-pass, Hz", wish, "bandwidth_hz", drawRest));
  }
  list.push(control("period, ms", wish, "period_ms", drawRest), control("compared up to, Hz", data, "band_hz", drawRest));
  place("wish").replaceChildren(el("fieldset", {}, el("legend", {}, "low-pass and filters"), ...list));
}
function buildCircle() {
  const list = [control("radius, mm", circle, "radius_mm", drawRest), control("feed, mm/min", circle, "feed_mm_min", drawRest)];
  if (data.axes.length > 2) {
    circle.pair.forEach((chosen, side) => {
      const options = data.axes.map((axis, index) => el("option", { value: index, ...(index === chosen ? { selected: "" } : {}) }, axis.letter));
      const select = el("select", { "aria-label": side === 0 ? "first axis of the circle" : "second axis of the circle" }, ...options);
      select.addEventListener("change", () => {
        circle.pair[side] = Number(select.value);
        drawRest();
      });
      list.push(el("label", {}, side === 0 ? "first axis" : "second axis", el("span"), select));
    });
  }
  place("circle-controls").replaceChildren(el("fieldset", {}, el("legend", {}, "circle"), ...list));
}
function build() {
  const cards = data.axes.map((axis) => {
    const box = el("div");
    const redraw = () => { drawAxis(axis, box); drawRest(); };
    const controls = el("div", {}, ...controlsOf(axis, redraw));
    drawAxis(axis, box);
    const heading = el("h2", {}, `${axis.letter} `, el("span", { class: "source" }, axis.source));
    return el("div", { class: "axis" }, heading, box, controls);
  });
  place("axes").replaceChildren(...cards);
  buildWish();
  buildCircle();
  drawRest();
}
place("save").addEventListener("click", () => {
  const url = URL.createObjectURL(new Blob([toml(data)], { type: "application/toml" }));
  const link = el("a", { href: url, download: "tune.toml" });
  document.body.append(link);
  link.click();
  link.remove();
  URL.revokeObjectURL(url);
});
place("reset").addEventListener("click", () => {
  data = copy(original);
  build();
});
build();
