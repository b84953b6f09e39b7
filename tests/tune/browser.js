// Put at the end of a page that gwatt tune has written, and run by a browser:
// changes the first zero by its field, the first inertia by its slider, saves,
// measures what overlaps or sticks out, and leaves it as JSON in the page.
"use strict";
(() => {
  let saved = null;
  window.Blob = class { constructor(parts) { saved = parts.join(""); } };
  URL.createObjectURL = () => "blob:";
  HTMLAnchorElement.prototype.click = () => {};
  const all = (selector) => [...document.querySelectorAll(selector)];
  const curves = () => all("#axes .line").map((line) => line.getAttribute("d"));
  const before = curves();
  const field = all('input[type=number][aria-label="frequency, Hz"]')[0];
  field.value = "42.5";
  field.dispatchEvent(new Event("input"));
  const slider = all("input[type=range]")[0];
  slider.value = "0.5";
  slider.dispatchEvent(new Event("input"));
  const after = curves();
  document.getElementById("save").click();
  const box = (node) => node.getBoundingClientRect();
  const outside = all("fieldset input").filter((input) => box(input).right > box(input.closest("fieldset")).right - 2).length;
  const overlaps = all("svg text").filter((text) => {
    const svg = box(text.closest("svg"));
    return box(text).left < svg.left - 1 || box(text).right > svg.right + 1;
  }).length;
  const buttons = Math.max(...all("header button").map((button) => box(button).bottom));
  const found = {
    toml: saved,
    redrawn: after.filter((d, k) => d !== before[k]).length,
    broken: after.filter((d) => d === "" || /NaN|Infinity/.test(d)).length,
    rows: all("#filters tr").slice(1).map((row) => [...row.children].map((cell) => cell.textContent)),
    outside,
    overlaps,
    wide: document.documentElement.scrollWidth - document.documentElement.clientWidth,
    under_buttons: box(all(".axis")[0]).top - buttons,
    outlined: all("input:invalid").length,
    network: performance.getEntriesByType("resource").length,
  };
  const probe = document.createElement("pre");
  probe.id = "probe";
  probe.textContent = JSON.stringify(found).replace(/[<>&]/g, (c) => `\\u00${c.charCodeAt(0).toString(16)}`);
  document.body.append(probe);
})();
