// Runs the script of a page that gwatt tune has written, with as much of a
// document as it needs: changes the first zero by its field, the first inertia by
// its slider, and prints the TOML that the button saves, then the filters' table
// and how many curves there are, as JSON. Then it adds two zeros to the first axis,
// takes the low-pass away and back, removes what it added, and prints what became of it.
//
//     node tests/tune/page.js page.html
"use strict";
const { byId, saved } = require("./document.js");

const inputs = (label) => byId.axes.all((n) => n.name === "input" && n.attributes["aria-label"] === label);
const curves = () => byId.axes.all((n) => /^line/.test(n.attributes.class || "")).map((n) => n.attributes.d);
const before = curves();
const [, field] = inputs("frequency, Hz");
field.value = "42.5";
field.listeners.input();
const slider = byId.axes.all((n) => n.attributes.type === "range")[0];
slider.value = "0.5";
slider.listeners.input();
const after = curves();
byId.save.click();
const rows = byId.filters.children.slice(1).map((row) => row.children.map((cell) => cell.children[0]));
const first = saved();
const circle = byId["circle-note"].textContent;
const [, letter] = first.match(/\[axes\.(\w)\]/);
const press = (label) => byId.axes.all((n) => n.attributes["aria-label"] === label)[0].click();
const toml = () => { byId.save.click(); return saved(); };
const zeros = byId.axes.all((n) => n.name === "legend" && /^zero/.test(n.children[0])).length;
const own = byId.axes.children[0].all((n) => n.name === "legend" && /^zero/.test(n.children[0])).length;
press(`Add a zero of ${letter}`);
press(`Add a zero of ${letter}`);
const added = toml();
const box = byId.wish.all((n) => n.attributes.type === "checkbox")[0];
box.checked = true;
box.listeners.change();
const plain = toml();
const again = byId.wish.all((n) => n.attributes.type === "checkbox")[0];
again.checked = false;
again.listeners.change();
const back = toml();
press(`Remove zero ${own + 2} of ${letter}`);
press(`Remove zero ${own + 1} of ${letter}`);
press(`Add a real pole of ${letter}`);
const removed = toml();
console.log(JSON.stringify({
  toml: first,
  headline: byId.headline.textContent,
  note: byId["filter-note"].textContent,
  circle, zeros, added, plain, back, removed,
  apart: byId.axes.all((n) => n.attributes.class === "apart").map((n) => n.children[0]),
  curves: after.length,
  redrawn: after.filter((d, k) => d !== before[k]).length,
  broken: after.filter((d) => d === "" || /NaN|Infinity/.test(d)).length,
  rows,
  match: byId.match.all((n) => n.name === "p").map((n) => n.children[0]),
}));
