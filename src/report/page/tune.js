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
// The largest degree of a numerator: the order that a low-pass must have.
const needed = (axes) => 2 * Math.max(...axes.map((_, n) =>
  axes.reduce((sum, axis, m) => sum + (m === n ? 0 : axis.zeros.length), 0)));
// Second-order sections [b0, b1, b2, a1, a2] of an axis.
function sections(axes, index, wish) {
  const others = axes.flatMap((axis, n) => (n === index ? [] : axis.zeros));
  const degree = needed(axes);
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

