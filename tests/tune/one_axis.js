// Runs the script of a page of one axis, and prints its headline, its circle and what it saves.
//
//     node tests/tune/one_axis.js page.html
"use strict";
const { byId, saved } = require("./document.js");

byId.save.click();
console.log(JSON.stringify({
  headline: byId.headline.textContent,
  circle: byId["circle-note"].textContent,
  note: byId["filter-note"].textContent,
  toml: saved(),
}));
