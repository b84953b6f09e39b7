// Opens a page of `gwatt tune` or `gwatt identify` in Chromium, wide and narrow:
//
//     node tests/html/instruments.mjs PAGE.html [FOLDER for pictures]
//
// Of a tuning it adds and removes a zero, moves the low-pass and the circle, and looks that
// filters, match and circle follow; of an identification it reads the curves at another
// frequency. Nothing may be loaded, stick out or be thrown; with axe-core there are no serious
// findings. Says that it skipped where Chromium or playwright-core are not there.
import { existsSync, readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { resolve } from "node:path";

const [page, pictures] = process.argv.slice(2);
const require = createRequire(import.meta.url);
const skip = (why) => {
  console.log(`skipped: ${why}`);
  process.exit(0);
};
const found = (name) => {
  try {
    return require.resolve(name);
  } catch {
    return null;
  }
};
const browser = ["/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"].find(existsSync);
if (!browser) skip("there is no Chromium");
if (!found("playwright-core")) skip("there is no playwright-core");
const { chromium } = require("playwright-core");
const axe = found("axe-core");

const problems = [];
const expect = (holds, what) => {
  if (!holds) problems.push(what);
};
const running = await chromium.launch({ executablePath: browser, args: ["--no-sandbox", "--disable-gpu", "--no-first-run"], headless: true });

async function look(width, height) {
  const context = await running.newContext({ viewport: { width, height } });
  const tab = await context.newPage();
  tab.on("pageerror", (error) => problems.push(`${width}: ${error.stack}`));
  tab.on("console", (message) => message.type() === "error" && problems.push(`${width}: ${message.text()}`));
  tab.on("request", (request) => expect(/^(file|data|blob):/.test(request.url()), `${width}: loads ${request.url()}`));
  await tab.goto(`file://${resolve(page)}`);
  const wide = await tab.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);
  expect(wide <= 0, `${width}: the page is ${wide} px too wide`);
  if (pictures) await tab.screenshot({ path: `${pictures}/${width}.png`, fullPage: true });
  const broken = await tab.evaluate(() => [...document.querySelectorAll("svg path")].filter((it) => /NaN|Infinity/.test(it.getAttribute("d"))).length);
  expect(broken === 0, `${width}: ${broken} curves are broken`);
  if ((await tab.locator("#circle").count()) > 0) await tuned(tab, width);
  else await identified(tab, width);
  if (axe) await accessible(tab, width);
  await context.close();
}

/** Figures are moved: what depends on them follows at once. */
async function tuned(tab, width) {
  const seen = () => tab.evaluate(() => ({
    circle: document.querySelector("#circle svg").outerHTML,
    filters: document.getElementById("filters").textContent,
    match: document.getElementById("match").textContent,
    zeros: document.querySelectorAll("legend").length,
  }));
  const slide = async (name, value) => tab.locator(`input[type=range][aria-label="${name}"]`).first().fill(value);
  let before = await seen();
  await slide("frequency, Hz", "0.3");
  let after = await seen();
  expect(after.circle !== before.circle, `${width}: the circle does not follow a zero`);
  const compared = (await tab.locator("#match svg").count()) > 0;
  expect(!compared || after.match !== before.match, `${width}: the match does not follow a zero`);
  before = after;
  await tab.locator("button", { hasText: /^Add a zero$/ }).first().click();
  after = await seen();
  expect(after.zeros === before.zeros + 1, `${width}: no zero is added`);
  expect(after.circle !== before.circle, `${width}: the circle does not follow a further zero`);
  await tab.locator("button", { hasText: /^Remove$/ }).first().click();
  expect((await seen()).zeros === before.zeros, `${width}: no zero is removed`);
  if ((await tab.locator('input[aria-label="low-pass, Hz"]').count()) > 0) {
    before = await seen();
    await slide("low-pass, Hz", "-0.5");
    after = await seen();
    expect(after.filters !== before.filters && after.circle !== before.circle, `${width}: the filters do not follow the low-pass`);
  }
  before = await seen();
  await slide("feed, mm/min", "0.5");
  expect((await seen()).circle !== before.circle, `${width}: the circle does not follow its feed`);
  await tab.locator("#reset").click();
}

/** The curves are read at another frequency, by the slider and by the pointer. */
async function identified(tab, width) {
  const read = () => tab.textContent("#readout");
  const before = await read();
  await tab.locator('input[aria-label="read at frequency"]').fill("3");
  const low = await read();
  expect(low !== before, `${width}: the slider reads nothing else`);
  const box = await tab.locator("#response svg").first().boundingBox();
  await tab.mouse.move(box.x + 0.7 * box.width, box.y + 0.5 * box.height);
  expect((await read()) !== low, `${width}: the pointer reads nothing else`);
}

async function accessible(tab, width) {
  await tab.evaluate(readFileSync(axe, "utf8"));
  const { violations } = await tab.evaluate(() => axe.run({ exclude: ["svg path"] }));
  for (const own of violations.filter((it) => ["serious", "critical"].includes(it.impact))) {
    problems.push(`${width}: ${own.id}: ${own.help}: ${own.nodes.map((node) => node.target).join("; ")}`);
  }
}

for (const [width, height] of [[1280, 900], [390, 844]]) await look(width, height);
await running.close();
if (!axe) console.log("not looked at: there is no axe-core");
for (const problem of problems) console.error(problem);
if (problems.length > 0) process.exit(1);
