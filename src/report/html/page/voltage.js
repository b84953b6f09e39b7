// The voltage of the bus over time, below the power: lowest and highest, with their limits.
const VOLT_COLOURS = { lowest: "--first", highest: "--second" };
const volts = (value) => (value === null ? "no end" : `${digits(value)} V`);
const voltName = (curve) => (curve.lowest ? "lowest" : "highest");

/** The curves of a program, with full columns. */
function voltages(which) {
  which.voltages ??= DATA.voltage[which.name].map((curve) => {
    const from = all(curve.from_s, curve.count);
    return { ...curve, from, to: curve.to_s === null ? from : all(curve.to_s, curve.count), volts: all(curve.volts, curve.count), bound: all(curve.bound, curve.count) };
  });
  return which.voltages;
}

/** The same range in all charts of voltage, V. */
function voltRange() {
  const list = SIDES.flatMap(voltages);
  const values = list.flatMap((curve) => [...curve.volts, curve.nominal_v, curve.limit_v, curve.beyond_v]).filter((value) => value !== null);
  const [least, most] = values.reduce(([low, high], value) => [Math.min(low, value), Math.max(high, value)], [Infinity, -Infinity]);
  const room = 0.12 * Math.max(1, most - least);
  return [least - room, most + room];
}

/** The voltage of a curve at a time: between two instants as it is drawn. */
function voltsAt(curve, seconds) {
  const next = above(curve.from, seconds);
  const last = Math.max(0, next - 1);
  const [from, to] = [curve.volts[last], curve.volts[Math.min(next, curve.count - 1)]];
  const [begun, ends] = [curve.to[last], curve.from[Math.min(next, curve.count - 1)]];
  if (from === null || to === null || seconds <= begun || ends <= begun) return from;
  return from + ((seconds - begun) / (ends - begun)) * (to - from);
}

const VOLTAGE = {
  range: voltRange,
  space: 20,
  label: (value) => `${Number(value.toFixed(3))} V`,
  draw: drawVolts,
  say: (which, _, seconds) => voltages(which).map((curve) => `${voltName(curve)} ${curve.converter ? `${curve.converter} ` : ""}${volts(voltsAt(curve, seconds))}`).join(", "),
};

function drawVolts(plot, which) {
  const { ctx } = plot;
  const { left, top, width, height } = plot.bbox;
  ctx.save();
  ctx.beginPath();
  ctx.rect(left, top, width, height);
  ctx.clip();
  const x = (seconds) => plot.valToPos(seconds, "x", true);
  const y = (value) => (value === null ? top : plot.valToPos(value, "y", true));
  const ends = [left, left + width];
  mark(ctx, which, x, top, height);
  const nominal = new Set();
  for (const curve of voltages(which)) {
    const name = `${voltName(curve)}${curve.converter ? ` ${curve.converter}` : ""}`;
    if (!nominal.has(curve.nominal_v)) {
      nominal.add(curve.nominal_v);
      line(ctx, ends, y(curve.nominal_v), css("--quiet"), [2, 3]);
      label(ctx, ends, `nominal ${volts(curve.nominal_v)}`, y(curve.nominal_v), "--quiet", false);
    }
    line(ctx, ends, y(curve.limit_v), css("--limit"), [7, 4]);
    label(ctx, ends, `${name} permitted ${volts(curve.limit_v)}`, y(curve.limit_v), "--limit", false);
    const colour = VOLT_COLOURS[voltName(curve)];
    if (curve.beyond_v !== null || curve.endless) {
      line(ctx, ends, y(curve.beyond_v), css(colour), [1, 4]);
      label(ctx, ends, `${name} of the report: ${volts(curve.beyond_v)}`, y(curve.beyond_v), colour, true);
    }
    voltLine(ctx, curve, plot.scales.x, x, y, css(colour));
  }
  ctx.restore();
}

/** One curve; bounds are dashed. */
function voltLine(ctx, curve, visible, x, y, colour) {
  const first = Math.max(0, above(curve.to, visible.min) - 2);
  const last = Math.min(curve.count, above(curve.from, visible.max) + 2);
  let bound = null;
  for (let place = first; place < last; place += 1) {
    const points = [[x(curve.from[place]), y(curve.volts[place])], [x(curve.to[place]), y(curve.volts[place])]];
    if (curve.bound[place] !== bound) {
      if (bound !== null) ctx.stroke();
      ctx.beginPath();
      ctx.setLineDash(curve.bound[place] ? [4 * devicePixelRatio, 3 * devicePixelRatio] : []);
      ctx.lineWidth = 1.75 * devicePixelRatio;
      ctx.strokeStyle = colour;
      if (bound !== null) ctx.moveTo(x(curve.to[place - 1]), y(curve.volts[place - 1]));
      bound = curve.bound[place];
    }
    for (const point of points) ctx.lineTo(...point);
  }
  if (bound !== null) ctx.stroke();
  ctx.setLineDash([]);
}

/** The chart below the power of a program, if its voltage is known. */
function drawVoltage(charts, which) {
  const list = voltages(which);
  if (list.length === 0) return;
  const said = list.map((curve) => curve.title).join("; ");
  const name = which.title ? ` ${which.title.toLowerCase()}` : "";
  const box = make("div", { class: "chart volts", role: "img", "aria-label": `Bus voltage over time${name}: ${said}` });
  charts.append(make("h3", {}, `Bus voltage${name}`, make("span", {}, ` ${said}`)), box);
  CHARTS.push(chart(which, box, VOLTAGE));
}

function voltageKeys(legend) {
  const list = SIDES.flatMap(voltages);
  for (const name of ["lowest", "highest"]) {
    if (list.some((curve) => voltName(curve) === name)) legend.append(make("li", { class: "key" }, make("i", { style: `border-top-color:var(${VOLT_COLOURS[name]})` }), `${name} bus voltage`));
  }
}

/** What has to be known of these curves. */
function voltageNotes() {
  const list = SIDES.flatMap(voltages);
  if (list.length === 0) return [];
  const notes = ["The voltage is what the limits over time are worked out from: the lowest and the highest that the bus may have at the largest overrides, with the capacitance less the margin and all runs of the program counted."];
  if (list.some((curve) => curve.bound.includes(true))) notes.push("Where it is dashed it is a bound.");
  if (list.some((curve) => curve.beyond_v !== null)) notes.push("The dotted line is a worse voltage of the report, which the curve does not show: at lower overrides, or in another way through the program.");
  if (list.some((curve) => curve.endless)) notes.push("Each run leaves more than it takes off, without end: the curve is that of the first.");
  return notes;
}
