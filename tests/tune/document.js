// As much of a document as the scripts of pages of gwatt tune need, and a page run in it.
"use strict";
const fs = require("fs");
const page = fs.readFileSync(process.argv[2], "utf8");
if (/(src|href)=|@import|url\(|fetch|XMLHttpRequest/.test(page.replace(/const link[^\n]*/, ""))) throw new Error("the page wants the network");

class Node {
  constructor(name) {
    Object.assign(this, { name, attributes: {}, children: [], listeners: {}, textContent: "", value: "", disabled: false });
  }
  setAttribute(key, value) { this.attributes[key] = String(value); }
  getAttribute(key) { return this.attributes[key] ?? null; }
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

module.exports = { byId, saved: () => saved };
