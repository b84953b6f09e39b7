// What the page shows, and how it is put into words.
"use strict";
/** Programs that were limited together, or null. */
const SET = JSON.parse(document.getElementById("set-data")?.textContent ?? "null");
/** Which of them is shown: the end of the address has its place from 1. */
const CHOSEN = SET ? Math.min(SET.programs.length, Math.max(1, Number(/^#program=(\d+)$/.exec(location.hash)?.[1] ?? 1))) - 1 : 0;
const DATA = JSON.parse(document.getElementById(CHOSEN > 0 ? `data-${CHOSEN}` : "data").textContent);
const { head: HEAD, blocks: BLOCKS, bars: BARS, path: PATH, channels: CHANNELS } = DATA;
const LIMITED = HEAD.limited !== null;
/** Two machines, with their names, or null. */
const COMPARED = HEAD.compared;
const TWO = LIMITED || COMPARED !== null;
/** What the two sides are called, and the second one at the end of a name. */
const TITLES = COMPARED ? [`From ${COMPARED.names[0]}`, `To ${COMPARED.names[1]}`] : ["Before", "After"];
const LATER = COMPARED ? `on ${COMPARED.names[1]}` : "after";
const COLOURS = {
  X: "#4269d0", Y: "#e3891b", Z: "#3a9d5d", A: "#c4457a", B: "#7a5ac2", C: "#1c9aa8", U: "#a0673a",
  V: "#6b8e23", W: "#b8860b", E: "#2f7f6f", spindle: "#8f6bb8", cutting: "#d65f4d", "base load": "#9a9a9a",
  "unknown start, at most": "#d0cdbd",
};

/** A column of which all values may be the same, or one of a few names. */
const at = (column, index) => (Array.isArray(column) ? column[index] : column?.names ? column.names[column.of[index]] : column);
const all = (column, count) => (Array.isArray(column) ? column : new Array(count).fill(column));
const element = (id) => document.getElementById(id);

/** A new element with text or others in it. */
function make(name, attributes = {}, ...children) {
  const node = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (key.startsWith("on")) node.addEventListener(key.slice(2), value);
    else if (value !== null && value !== false) node.setAttribute(key, value === true ? "" : value);
  }
  node.append(...children);
  return node;
}

/** Three digits, as in the report. */
function digits(value) {
  const size = Math.abs(value);
  const text = value.toFixed(size === 0 || size >= 99.95 ? 0 : size >= 9.995 ? 1 : 2);
  return text.replace("-", "\u2212");
}

function scaled(value, unit) {
  if (value === null || value === undefined) return "not known";
  const size = Math.abs(value);
  if (size >= 999500) return `${digits(value / 1e6)} M${unit}`;
  if (size >= 999.5) return `${digits(value / 1e3)} k${unit}`;
  return `${digits(value)} ${unit}`;
}

const power = (value) => scaled(value, "W");
const energy = (joule) => (joule === null ? "not known" : scaled(joule / 3600, "Wh"));
const percent = (share) => {
  const value = 100 * share;
  const off = Math.abs(value - 100);
  return `${value.toFixed(off >= 1 || off === 0 ? 0 : off >= 0.01 ? 2 : 5)} %`;
};

function duration(seconds) {
  if (seconds === null) return "unknown time";
  if (Math.abs(seconds) < 59.95) return `${digits(seconds)} s`;
  const whole = Math.round(seconds);
  const [hours, minutes] = [Math.floor(whole / 3600), Math.floor((whole % 3600) / 60)];
  return hours > 0 ? `${hours} h ${minutes} min ${whole % 60} s` : `${minutes} min ${whole % 60} s`;
}

/** A moment, with the digits that distinguish it from its neighbours. */
function moment(seconds) {
  if (seconds === null) return "";
  if (seconds < 60) return `${seconds.toFixed(3)} s`;
  const [hours, minutes] = [Math.floor(seconds / 3600), Math.floor((seconds % 3600) / 60)];
  const rest = (seconds % 60).toFixed(2).padStart(5, "0");
  return hours > 0 ? `${hours}:${String(minutes).padStart(2, "0")}:${rest}` : `${minutes}:${rest}`;
}

const TEXTS = new Map(DATA.texts.line.map((line, place) => [line, DATA.texts.text[place]]));
const HELPS = new Map(HEAD.helps);

/** One block, with all that is known of it. */
function block(place) {
  const own = { place };
  for (const [key, column] of Object.entries(BLOCKS)) own[key] = at(column, place);
  own.text = own.file ? "" : (TEXTS.get(own.line) ?? "");
  own.where = own.file ? `line ${own.line} of ${own.file}` : `line ${own.line}`;
  own.help = own.file ? "" : (HELPS.get(own.line) ?? "");
  return own;
}

/** The first place whose value is above `value`, in a list that grows. */
function above(list, value) {
  let [low, high] = [0, list.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (list[middle] <= value) low = middle + 1;
    else high = middle;
  }
  return low;
}

/** The bar that a row is in. */
const barOf = (row) => Math.max(0, above(BARS.first, row) - 1);

/** What is shown of one program: its bars and the planned power. */
function side(name) {
  const after = name === "after";
  const column = (before, later) => all(BARS[after ? later : before], BARS.count);
  const start = column("from_s", "from_after_s");
  // A move may wait for the spindle in one program and not in the other.
  const bar = [...start.keys()].sort((a, b) => start[a] - start[b] || a - b);
  const sorted = (before, later) => {
    const list = column(before, later);
    return bar.map((place) => list[place]);
  };
  const own = {
    name,
    title: TWO ? TITLES[after ? 1 : 0] : "",
    limits: after && COMPARED ? COMPARED.limits : HEAD.limits,
    figures: after ? HEAD.after : HEAD.before,
    bar,
    from: sorted("from_s", "from_after_s"),
    to: sorted("to_s", "to_after_s"),
    peak: sorted("peak_w", "peak_after_w"),
    back: sorted("regen_w", "regen_after_w"),
    shares: null,
  };
  const shares = DATA.shares[name];
  if (shares) {
    const from = all(shares.from_s, shares.count);
    const lists = (list) => list.map((one) => all(one, shares.count));
    own.shares = { whole: shares.whole, from, to: shares.whole ? from : all(shares.to_s, shares.count), up: lists(shares.up), down: lists(shares.down) };
  }
  return own;
}

const SIDES = TWO ? [side("before"), side("after")] : [side("before")];

/** When a block runs in one of the programs, or null. */
function span(own, which) {
  const [from, lasts] = which.name === "after" ? [own.start_after_s, own.duration_after_s] : [own.start_s, own.duration_s];
  return from === null || from === undefined ? null : [from, from + (lasts ?? 0)];
}

/** The planned power by channel where most is drawn within a span of time. */
function together(which, [from, to]) {
  const { shares } = which;
  if (!shares) return null;
  const near = 1e-6 + 1e-9 * to;
  // Where the power jumps two samples have one time: the last at the beginning, the first at
  // the end are the block's own.
  let first = Math.max(0, above(shares.from, from + near) - 1);
  let last = above(shares.from, to - near);
  if (shares.from[last] > to + near) last -= 1;
  if (shares.to[first] < from - near && first < last) first += 1;
  let best = null;
  for (let place = first; place <= Math.min(Math.max(first, last), shares.from.length - 1); place += 1) {
    const values = shares.up.map((list) => list[place]);
    const sum = values.reduce((a, b) => a + b, 0);
    if (best === null || sum > best.sum) best = { sum, values };
  }
  return best;
}
