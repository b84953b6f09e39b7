// Runs the script of a page that gwatt tune has written, with as much of a
// document as it needs: changes the first zero by its field, the first inertia by
// its slider, and prints the TOML that the button saves, then the filters' table
// and how many curves there are, as JSON.
//
//     node tests/tune/page.js page.html
"use strict";
const fs = require("fs");
const page = fs.readFileSync(process.argv[2], "utf8");
if (/(src|href)=|@import|url\(|fetch|XMLHttpRequest/.test(page.replace(/const link[^\n]*/, ""))) throw new Error("the page wants the network");

class Node {
  constructor(name) {
    Object.assign(this, { name, attributes: {}, children: [], listeners: {}, textContent: "", value: "", disabled: false });
  }
  setAttribute(key, value) { this.attributes[key] = String(value); }
  append(...children) { this.children.push(...children); }
  replaceChildren(...children) { this.children = children; }
  addEventListener(kind, listener) { this.listeners[kind] = listener; }
  setCustomValidity() {}
  remove() {}
  click() { (this.listeners.click || (() => {}))(); }
  all(test, found = []) {
    if (test(this)) found.push(this);
    for (const child of this.children) if (child instanceof Node) child.all(test, found);
    return found;
  }
}
const part = (id) => page.split(`id="${id}"`)[1].split(">").slice(1).join(">").split("</script>")[0];
const byId = {};
for (const [, id] of page.matchAll(/id="([\w-]+)"/g)) byId[id] = new Node(id);
byId.data.textContent = part("data");
let saved = null;
global.document = {
  createElement: (name) => new Node(name),
  createElementNS: (_, name) => new Node(name),
  getElementById: (id) => byId[id],
  body: new Node("body"),
};
global.Blob = class { constructor(parts) { saved = parts.join(""); } };
URL.createObjectURL = () => "blob:";
URL.revokeObjectURL = () => {};
const scripts = page.split("<script>");
(0, eval)(scripts[scripts.length - 1].split("</script>")[0]);

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
console.log(JSON.stringify({
  toml: saved,
  curves: after.length,
  redrawn: after.filter((d, k) => d !== before[k]).length,
  broken: after.filter((d) => d === "" || /NaN|Infinity/.test(d)).length,
  rows,
  match: byId.match.all((n) => n.name === "p").map((n) => n.children[0]),
}));
