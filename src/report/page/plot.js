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
// One plot: curves are {kind, points: [[hz, value, weight], …]}; where there are weights from 0
// to 1 the line fades with them. `time` has an axis of times in place of frequencies.
const LAID = [760, 60, 18, 22, 38];
function plot(title, curves, range, height, time = false) {
  const [width, left, right, top, bottom] = LAID;
  const values = curves.flatMap((c) => c.points.map((p) => p[1])).filter(Number.isFinite);
  let least = Math.min(...values), most = Math.max(...values);
  if (!(most - least > 1e-3)) [least, most] = [least - 1 || -1, least + 1 || 1];
  const room = 0.05 * (most - least);
  [least, most] = [least - room, most + room];
  const scale = time ? (t) => t : Math.log10;
  const [from, to] = range.map(scale);
  const x = (hz) => left + (scale(hz) - from) / (to - from) * (width - left - right);
  const y = (v) => top + (most - v) / (most - least) * (height - top - bottom);
  const svg = el("svg", { viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": title });
  svg.append(el("text", { x: left, y: 14, "font-weight": "bold" }, title));
  for (const mark of marks(least, most)) {
    svg.append(el("path", { class: "grid", d: `M${left} ${y(mark)}H${width - right}` }));
    svg.append(el("text", { x: left - 6, y: y(mark) + 4, "text-anchor": "end" }, String(mark)));
  }
  const mark = (at, named) => {
    svg.append(el("path", { class: "grid", d: `M${x(at)} ${top}V${height - bottom}` }));
    if (named) svg.append(el("text", { x: x(at), y: height - 22, "text-anchor": "middle" }, String(Number(at.toPrecision(6)))));
  };
  if (time) marks(from, to).forEach((at) => mark(at, true));
  for (let decade = Math.floor(from); !time && decade <= to; decade++) {
    for (let digit = 1; digit < 10; digit++) {
      const hz = digit * 10 ** decade;
      if (hz >= range[0] && hz <= range[1]) mark(hz, [1, 2, 5].includes(digit));
    }
  }
  svg.append(el("text", { x: (left + width - right) / 2, y: height - 6, "text-anchor": "middle" }, time ? "time, s" : "frequency, Hz"));
  for (const curve of curves) {
    // A path for each strength of the line.
    const paths = new Map();
    let last = null, level = null;
    for (const [at, value, weight] of curve.points) {
      if (!Number.isFinite(value)) { last = null; continue; }
      const point = `${x(at).toFixed(1)} ${y(value).toFixed(1)}`;
      const own = weight === undefined ? 1 : Math.round(6 * Math.min(1, Math.max(0, weight))) / 6;
      // Phases jump by a turn: no line there.
      const goes = last && !(curve.wraps && Math.abs(value - last.value) > 180);
      const before = paths.get(own) ?? "";
      if (!goes) paths.set(own, `${before}M${point}`);
      else paths.set(own, own === level ? `${before}L${point}` : `${before}M${last.point}L${point}`);
      [last, level] = [{ value, point }, own];
    }
    for (const [own, d] of paths) svg.append(el("path", { class: `line ${curve.kind}`, d, ...(own < 1 ? { opacity: (0.12 + 0.88 * own).toFixed(2) } : {}) }));
  }
  return svg;
}

