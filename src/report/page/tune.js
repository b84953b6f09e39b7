"use strict";
// Complex numbers are pairs [re, im]. Frequencies in Hz, times in s.
const TAU = 2 * Math.PI;
const mul = ([a, b], [c, d]) => [a * c - b * d, a * d + b * c];
const div = ([a, b], [c, d]) => {
  const n = c * c + d * d;
  return [(a * c + b * d) / n, (b * c - a * d) / n];
};
const abs = ([a, b]) => Math.hypot(a, b);
const deg = ([a, b]) => Math.atan2(b, a) * 180 / Math.PI;
const turn = (angle) => [Math.cos(angle), Math.sin(angle)];
const db = (gain) => 20 * Math.log10(gain);

// A factor that is 1 at rest: a pair of roots, or a single one.
function factor(root, hz) {
  if (root.time_constant_s !== undefined) return [1, TAU * hz * root.time_constant_s];
  const x = hz / root.frequency_hz;
  return [1 - x * x, 2 * root.damping * x];
}
const product = (roots, hz) => roots.reduce((p, root) => mul(p, factor(root, hz)), [1, 0]);

function transfer(zeros, poles, delay_s, gain, hz) {
  const ratio = div(product(zeros, hz), product(poles, hz));
  return mul(mul(ratio, [gain, 0]), turn(-TAU * hz * delay_s));
}
function model(axis, hz) {
  const zeros = axis.zeros.concat(axis.further_zeros);
  return transfer(zeros, axis.poles, axis.delay_ms * 1e-3, axis.inertia ? 1 / axis.inertia : 1, hz);
}
// How the load follows the command, as far as it is known.
function follows(axis, hz) {
  if (axis.input === "command") return model(axis, hz);
  const gain = axis.position_gain_1_s;
  return transfer(axis.zeros, gain ? [{ time_constant_s: 1 / gain }] : [], axis.delay_ms * 1e-3, 1, hz);
}

// The poles of the low-pass (Butterworth); none without one.
function lowPass(wish) {
  if (!wish.order) return [];
  const poles = [];
  for (let k = 0; k < Math.floor(wish.order / 2); k++) {
    const steps = k + (wish.order % 2 ? 1 : 0.5);
    poles.push({ frequency_hz: wish.bandwidth_hz, damping: Math.cos(Math.PI * steps / wish.order) });
  }
  if (wish.order % 2) poles.push({ time_constant_s: 1 / (TAU * wish.bandwidth_hz) });
  return poles;
}
// A factor by Tustin's rule, pre-warped; coefficients of 1, 1/z, 1/z².
function tustin(root, period) {
  if (root.time_constant_s !== undefined) {
    const t = 1 / Math.tan(0.5 * period / root.time_constant_s);
    return [1 + t, 1 - t, 0];
  }
  const t = 1 / Math.tan(0.5 * TAU * root.frequency_hz * period);
  return [1 + 2 * root.damping * t + t * t, 2 - 2 * t * t, 1 - 2 * root.damping * t + t * t];
}
// A pair of zeros by second differences, one period late.
function differences(zero, period) {
  const w = TAU * zero.frequency_hz * period;
  const square = Math.sin(w / 2) ** 2;
  const second = 0.25 / square;
  const first = zero.damping * (1 - square / 3) / Math.sin(w);
  return [second + first, 1 - 2 * second, second - first];
}
// Second-order sections [b0, b1, b2, a1, a2] of an axis.
function sections(axes, index, wish) {
  const others = axes.flatMap((axis, n) => (n === index ? [] : axis.zeros));
  const degree = 2 * Math.max(...axes.map((_, n) =>
    axes.reduce((sum, axis, m) => sum + (m === n ? 0 : axis.zeros.length), 0)));
  if (degree === 0) return [];
  const poles = lowPass(wish);
  const period = wish.period_ms * 1e-3;
  const plain = (pole) => (pole && pole.time_constant_s !== undefined ? [1, 1, 0] : [1, 2, 1]);
  const list = [];
  for (let k = 0; k < others.length || k < poles.length || 2 * k < degree; k++) {
    const [zero, pole] = [others[k], poles[k]];
    let n;
    if (wish.discretize === "tustin") n = zero ? tustin(zero, period) : plain(pole);
    else if (zero) n = differences(zero, period);
    else n = 2 * k < degree ? [1 / 12, 10 / 12, 1 / 12] : plain(pole);
    const d = pole ? tustin(pole, period) : [1, 0, 0];
    const gain = (d[0] + d[1] + d[2]) / (n[0] + n[1] + n[2]) / d[0];
    list.push([n[0] * gain, n[1] * gain, n[2] * gain, d[1] / d[0], d[2] / d[0]]);
  }
  return list;
}
function response(list, hz, period) {
  const back = turn(-TAU * hz * period);
  const twice = mul(back, back);
  const sum = (a, b, c) => [a + b * back[0] + c * twice[0], b * back[1] + c * twice[1]];
  return list.reduce((p, [b0, b1, b2, a1, a2]) => mul(p, div(sum(b0, b1, b2), sum(1, a1, a2))), [1, 0]);
}

// The file that `gwatt tune --from` reads.
function toml(data) {
  const number = (x) => (Number.isInteger(x) ? x.toFixed(1) : String(x));
  const root = (r) => (r.time_constant_s !== undefined
    ? `  { time_constant_s = ${number(r.time_constant_s)} },\n`
    : `  { frequency_hz = ${number(r.frequency_hz)}, damping = ${number(r.damping)} },\n`);
  const wish = data.wish;
  let text = "# gwatt tune: read it back with --from\nschema = 1\n";
  text += `period_ms = ${number(wish.period_ms)}\ndiscretize = "${wish.discretize}"\n`;
  if (wish.no_low_pass) text += 'low_pass = "none"\n';
  else if (wish.order) text += `low_pass = "butterworth"\norder = ${wish.order}\nbandwidth_hz = ${number(wish.bandwidth_hz)}\n`;
  text += `band_hz = ${number(data.band_hz)}\n`;
  for (const axis of data.axes) {
    text += `\n[axes.${axis.letter}]\ninput = "${axis.input}"\n`;
    if (axis.inertia) text += `${axis.inertia_key} = ${number(axis.inertia)}\n`;
    text += `delay_ms = ${number(axis.delay_ms)}\n`;
    if (axis.position_gain_1_s) text += `position_gain_1_s = ${number(axis.position_gain_1_s)}\n`;
    for (const key of ["zeros", "further_zeros", "poles"]) text += `${key} = [\n${axis[key].map(root).join("")}]\n`;
  }
  return text;
}

// --- drawing ---
function el(name, attributes = {}, ...children) {
  const svg = ["svg", "path", "text"].includes(name);
  const node = svg ? document.createElementNS("http://www.w3.org/2000/svg", name) : document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
  node.append(...children);
  return node;
}
// Round marks inside a range, about six.
function marks(least, most) {
  const rough = (most - least) / 6;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((d) => d * power).find((s) => s >= rough) || rough;
  const list = [];
  for (let k = Math.ceil(least / step); k * step <= most; k++) list.push(Number((k * step).toPrecision(12)));
  return list;
}
// One plot: curves are {kind, points: [[hz, value], …]}.
function plot(title, curves, range, height) {
  const [width, left, right, top, bottom] = [760, 60, 18, 22, 38];
  const values = curves.flatMap((c) => c.points.map((p) => p[1])).filter(Number.isFinite);
  let least = Math.min(...values), most = Math.max(...values);
  if (!(most - least > 1e-3)) [least, most] = [least - 1 || -1, least + 1 || 1];
  const room = 0.05 * (most - least);
  [least, most] = [least - room, most + room];
  const [from, to] = range.map(Math.log10);
  const x = (hz) => left + (Math.log10(hz) - from) / (to - from) * (width - left - right);
  const y = (v) => top + (most - v) / (most - least) * (height - top - bottom);
  const svg = el("svg", { viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": title });
  svg.append(el("text", { x: left, y: 14, "font-weight": "bold" }, title));
  for (const mark of marks(least, most)) {
    svg.append(el("path", { class: "grid", d: `M${left} ${y(mark)}H${width - right}` }));
    svg.append(el("text", { x: left - 6, y: y(mark) + 4, "text-anchor": "end" }, String(mark)));
  }
  for (let decade = Math.floor(from); decade <= to; decade++) {
    for (let digit = 1; digit < 10; digit++) {
      const hz = digit * 10 ** decade;
      if (hz < range[0] || hz > range[1]) continue;
      svg.append(el("path", { class: "grid", d: `M${x(hz)} ${top}V${height - bottom}` }));
      if ([1, 2, 5].includes(digit)) svg.append(el("text", { x: x(hz), y: height - 22, "text-anchor": "middle" }, String(Number(hz.toPrecision(3)))));
    }
  }
  svg.append(el("text", { x: (left + width - right) / 2, y: height - 6, "text-anchor": "middle" }, "frequency, Hz"));
  for (const curve of curves) {
    let d = "", drawing = false, last = 0;
    for (const [hz, value] of curve.points) {
      if (!Number.isFinite(value)) { drawing = false; continue; }
      // Phases jump by a turn: no line there.
      if (drawing && curve.wraps && Math.abs(value - last) > 180) drawing = false;
      d += `${drawing ? "L" : "M"}${x(hz).toFixed(1)} ${y(value).toFixed(1)}`;
      drawing = true;
      last = value;
    }
    svg.append(el("path", { class: `line ${curve.kind}`, d }));
  }
  return svg;
}

const original = JSON.parse(document.getElementById("data").textContent);
let data = JSON.parse(JSON.stringify(original));
const sample = (range, count, value) => Array.from({ length: count }, (_, k) => {
  const hz = range[0] * (range[1] / range[0]) ** (k / (count - 1));
  return [hz, value(hz)];
});

function drawAxis(axis, place) {
  const measured = axis.measured;
  const found = measured ? measured.frequency_hz : [];
  const range = found.length > 1 ? [found[0], found[found.length - 1]] : [1, 0.5e3 / data.wish.period_ms];
  const list = (values) => found.map((hz, k) => [hz, values[k]]);
  const gains = [{ kind: "model", points: sample(range, 400, (hz) => db(abs(model(axis, hz)))) }];
  const phases = [{ kind: "model", wraps: true, points: sample(range, 400, (hz) => deg(mul(model(axis, hz), turn(-TAU * hz * axis.hold_s)))) }];
  if (measured) {
    gains.unshift({ kind: "measured", points: list(measured.gain_db) });
    phases.unshift({ kind: "measured", wraps: true, points: list(measured.phase_deg) });
  }
  place.replaceChildren(plot(`${axis.letter}: gain, dB`, gains, range, 240), plot("phase, degrees", phases, range, 180));
}
function drawRest() {
  const wish = data.wish;
  const period = wish.period_ms * 1e-3;
  const filters = data.axes.map((_, index) => sections(data.axes, index, wish));
  const held = wish.discretize === "zoh";
  document.getElementById("filter-note").textContent = held
    ? "Filters by zero-order hold are made by gwatt tune --from; these are Tustin's."
    : `${wish.discretize}, period ${wish.period_ms} ms, ` + (wish.order ? `low-pass of order ${wish.order} at ${wish.bandwidth_hz.toFixed(1)} Hz` : "no low-pass");
  const head = el("tr", {}, ...["axis", "section", "b0", "b1", "b2", "a1", "a2"].map((name) => el("th", {}, name)));
  const rows = filters.flatMap((list, index) => list.map((section, k) =>
    el("tr", {}, ...[data.axes[index].letter, String(k + 1), ...section.map((c) => c.toFixed(9))].map((cell) => el("td", {}, cell)))));
  document.getElementById("filters").replaceChildren(head, ...rows);
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
  document.getElementById("headline").textContent = worst ? worst.said : `How ${data.axes.map((axis) => axis.letter).join(", ")} answers`;
  document.getElementById("match").replaceChildren(...plots);
}

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
function build() {
  const cards = data.axes.map((axis) => {
    const place = el("div");
    const redraw = () => { drawAxis(axis, place); drawRest(); };
    const controls = el("div");
    if (axis.inertia) {
      const name = axis.inertia_key === "mass_kg" ? "mass, kg" : "inertia, kg·m²";
      controls.append(el("fieldset", {}, control(name, axis, "inertia", redraw)));
    }
    for (const [key, title] of [["zeros", "zero"], ["further_zeros", "further zero"], ["poles", "pole"]]) {
      axis[key].forEach((root, k) => {
        const inputs = root.time_constant_s === undefined
          ? [control("frequency, Hz", root, "frequency_hz", redraw), control("damping", root, "damping", redraw)]
          : [control("time constant, s", root, "time_constant_s", redraw)];
        controls.append(el("fieldset", {}, el("legend", {}, `${title} ${k + 1}`), ...inputs));
      });
    }
    drawAxis(axis, place);
    const heading = el("h2", {}, `${axis.letter} `, el("span", { class: "source" }, axis.source));
    return el("div", { class: "axis" }, heading, place, controls);
  });
  document.getElementById("axes").replaceChildren(...cards);
  drawRest();
}
document.getElementById("save").addEventListener("click", () => {
  const url = URL.createObjectURL(new Blob([toml(data)], { type: "application/toml" }));
  const link = el("a", { href: url, download: "tune.toml" });
  document.body.append(link);
  link.click();
  link.remove();
  URL.revokeObjectURL(url);
});
document.getElementById("reset").addEventListener("click", () => {
  data = JSON.parse(JSON.stringify(original));
  build();
});
build();
