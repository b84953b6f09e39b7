// Opens a page that gwatt has written in Chromium, wide and narrow, light and dark:
//
//     node tests/html/page.mjs PAGE.html [FOLDER for pictures]
//
// Picks a peak, a row of a table and a piece of the path, and looks that all light up with
// the same line; nothing may be loaded, stick out or be thrown. With axe-core there are no
// serious findings. Needs Chromium, playwright-core and, for the last, axe-core, by
// NODE_PATH or next to this file; says that it skipped where they are not there.
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
const ARGUMENTS = ["--no-sandbox", "--disable-gpu", "--enable-unsafe-swiftshader", "--disable-quic", "--no-first-run",
  "--disable-background-networking", "--disable-component-update", "--disable-sync"];
const running = await chromium.launch({ executablePath: browser, args: ARGUMENTS, headless: true });

async function look(width, height, colorScheme) {
  const name = `${width} ${colorScheme}`;
  const context = await running.newContext({ viewport: { width, height }, colorScheme });
  const tab = await context.newPage();
  tab.on("pageerror", (error) => problems.push(`${name}: ${error.stack}`));
  tab.on("console", (message) => message.type() === "error" && problems.push(`${name}: ${message.text()}`));
  tab.on("request", (request) => expect(/^(file|data|blob):/.test(request.url()), `${name}: loads ${request.url()}`));
  await tab.goto(`file://${resolve(page)}`);
  await tab.waitForSelector("html[data-ready]");
  await tab.waitForTimeout(300);
  const opened = await tab.evaluate(() => performance.getEntriesByType("navigation")[0].loadEventEnd);
  const wide = await tab.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);
  expect(wide <= 0, `${name}: the page is ${wide} px too wide`);
  if (pictures) await tab.screenshot({ path: `${pictures}/${width}-${colorScheme}.png`, fullPage: true });
  await links(tab, name);
  if (axe) await accessible(tab, name);
  await context.close();
  return `${name}: opened in ${Math.round(opened)} ms`;
}

/** What is picked in one place lights up in the others. */
async function links(tab, name) {
  const line = () => tab.textContent("#details .source span");
  const lit = () => tab.evaluate(() => [PICKED, SPACE ? SPACE.bright.visible : null, document.querySelectorAll("tr.picked").length]);
  const button = tab.locator("#worst-table button").first();
  await button.click();
  expect((await line()) === (await button.textContent()), `${name}: a row of the table picks another line`);
  const [place, bright, rows] = await lit();
  const moves = await tab.evaluate(() => /[XYZ]/.test(block(PICKED).axes) && PATH.ends.length > 0);
  expect(rows >= 1, `${name}: its row is not marked`);
  expect(bright === null || bright === moves, `${name}: its path is not lit`);
  // The highest point of the first chart.
  const peak = await tab.evaluate(() => {
    const { plot, which } = CHARTS[0];
    const bar = which.peak.reduce((best, value, at) => (value > which.peak[best] ? at : best), 0);
    const box = plot.over.getBoundingClientRect();
    plot.over.scrollIntoView({ block: "center" });
    const middle = (which.from[bar] + which.to[bar]) / 2;
    // Where both machines are drawn the nearer line counts.
    const high = COMPARED ? plot.valToPos(which.peak[bar], "y") : box.height / 2;
    return { left: plot.valToPos(middle, "x"), high, lead: BARS.lead[bar] };
  });
  await tab.locator(".u-over").first().click({ position: { x: peak.left, y: peak.high } });
  const picked = await tab.evaluate((lead) => [block(PICKED).load >= block(lead).load - 1e-9, block(PICKED).where, block(PICKED).text], peak.lead);
  expect(picked[0], `${name}: a click on the largest peak picks a smaller one`);
  expect((await line()) === picked[1], `${name}: a click on a peak shows another line`);
  expect((await tab.textContent("#details .source code")) === (picked[2] || "no text at hand"), `${name}: its text is not shown`);
  if (moves && bright !== null) await onPath(tab, name, place);
  await voltage(tab, name);
  if (await tab.evaluate(() => COMPARED !== null)) await both(tab, name);
  if (await tab.evaluate(() => SET !== null)) await programs(tab, name);
}

/** The voltage below the power: a click picks a block, the cursor and the zoom go along. */
async function voltage(tab, name) {
  const shown = await tab.evaluate(() => {
    const low = CHARTS.findIndex((it) => it.box.classList.contains("volts"));
    if (low < 0) return { low, any: SIDES.some((which) => DATA.voltage[which.name].length > 0) };
    const { plot, which } = CHARTS[low];
    plot.over.scrollIntoView({ block: "center" });
    const lead = which.bar.findIndex((bar, place) => which.to[place] > which.from[place]);
    const middle = (which.from[lead] + which.to[lead]) / 2;
    const { width, height } = plot.ctx.canvas;
    const pixels = plot.ctx.getImageData(0, 0, width, height).data;
    let drawn = 0;
    for (let at = 3; at < pixels.length; at += 4) drawn += pixels[at] > 0;
    const titles = voltages(which).map((curve) => curve.title);
    return { low, left: plot.valToPos(middle, "x"), drawn, titles, label: CHARTS[low].box.getAttribute("aria-label"), any: true };
  });
  expect(shown.low >= 0 || !shown.any, `${name}: a voltage is known and not drawn`);
  if (shown.low < 0) return;
  expect(shown.drawn > 500, `${name}: the chart of the voltage is empty`);
  expect(shown.titles.every((title) => shown.label.includes(title)), `${name}: the label of the voltage is ${shown.label}`);
  const over = tab.locator(".u-over").nth(shown.low);
  await over.click({ position: { x: shown.left, y: 20 } });
  const [line, power, tip] = await tab.evaluate((low) => {
    const { plot, which } = CHARTS[low];
    const above = CHARTS.find((it) => it.which === which && !it.box.classList.contains("volts"));
    const own = block(PICKED);
    const when = span(own, which);
    const at = plot.posToVal(plot.cursor.left, "x");
    return [when[0] - 1e-3 * CHARTS[low].end <= at && at <= when[1] + 1e-3 * CHARTS[low].end, Math.abs(above.plot.cursor.left - plot.cursor.left), plot.over.querySelector(".tip").textContent];
  }, shown.low);
  expect(line, `${name}: a click on the voltage picks a block of another time`);
  expect(power < 1, `${name}: the cursor of the power is ${power} px from that of the voltage`);
  expect(/\d V/.test(tip), `${name}: the voltage is not said: ${tip}`);
  await tab.evaluate(() => near());
  const scales = await tab.evaluate((low) => {
    const { which } = CHARTS[low];
    return CHARTS.filter((it) => it.which === which).map((it) => [it.plot.scales.x.min, it.plot.scales.x.max].join());
  }, shown.low);
  expect(new Set(scales).size === 1, `${name}: charts of one program show other times: ${scales.join("; ")}`);
  await tab.evaluate(() => zoom(null));
}

/** Programs that were limited together: a link shows the other one, with its own figures. */
async function programs(tab, name) {
  const links = await tab.locator("#set-table a").allTextContents();
  const title = () => tab.textContent("#program");
  for (let place = links.length - 1; place >= 0; place -= 1) {
    const row = tab.locator("#set-table tbody tr").nth(place);
    await tab.evaluate(() => delete document.documentElement.dataset.ready);
    await row.locator("a").click();
    await tab.waitForSelector("html[data-ready]");
    expect(links[place].endsWith(await title()), `${name}: a link shows ${await title()} in place of ${links[place]}`);
    const peak = await tab.evaluate(() => power(HEAD.before.peak_w));
    expect((await row.locator("td").nth(1).textContent()) === peak, `${name}: its row has another peak`);
    expect(await row.evaluate((own) => own.classList.contains("chosen")), `${name}: its row is not marked`);
  }
}

/** Two machines: the chart of both draws both lines, in each one's time and block by block. */
async function both(tab, name) {
  for (const lay of ["time", "step"]) {
    await tab.locator("#lay").selectOption(lay);
    const seen = await tab.evaluate(() => {
      const { plot } = CHARTS[0];
      const { width, height } = plot.ctx.canvas;
      const pixels = plot.ctx.getImageData(0, 0, width, height).data;
      const near = (colour) => {
        const probe = document.createElement("canvas").getContext("2d");
        probe.fillStyle = css(colour);
        probe.fillRect(0, 0, 1, 1);
        const own = probe.getImageData(0, 0, 1, 1).data;
        let count = 0;
        for (let at = 0; at < pixels.length; at += 4) {
          if ([0, 1, 2].every((part) => Math.abs(pixels[at + part] - own[part]) < 12)) count += 1;
        }
        return count;
      };
      return [...LINES.map(near), laid().peak.length === BARS.count && !laid().peak.includes(undefined)];
    });
    expect(seen[0] > 20 && seen[1] > 20, `${name}: the chart of both has ${seen[0]} and ${seen[1]} pixels of its lines`);
    expect(seen[2], `${name}: a bar has no place on the other machine`);
  }
  // What only one machine does is picked as well, and says so.
  const alone = await tab.evaluate(() => DATA.worst.concat(BARS.lead).find((place) => block(place).start_s === null) ?? null);
  if (alone === null) return;
  await tab.evaluate((place) => pick(place, "test"), alone);
  expect((await tab.textContent("#details")).includes("no such move"), `${name}: a move of one machine alone has figures on both`);
}

/** A click on a piece of the path picks its block. */
async function onPath(tab, name, place) {
  const [x, y] = await tab.evaluate((wanted) => {
    pick(wanted, "test");
    const at = PATH.lead.indexOf(wanted);
    const line = at < 0 ? 0 : at;
    SPACE.canvas.scrollIntoView({ block: "center" });
    const point = new THREE.Vector3().fromArray(SPACE.place, 6 * line).lerp(new THREE.Vector3().fromArray(SPACE.place, 6 * line + 3), 0.5).project(SPACE.camera);
    const box = SPACE.canvas.getBoundingClientRect();
    return [((point.x + 1) / 2) * box.width, ((1 - point.y) / 2) * box.height];
  }, place);
  await tab.evaluate(() => { PICKED = null; });
  await tab.locator("#scene canvas").click({ position: { x, y } });
  expect((await tab.evaluate(() => PICKED)) !== null, `${name}: a click on the path picks nothing`);
}

async function accessible(tab, name) {
  await tab.evaluate(readFileSync(axe, "utf8"));
  const { violations } = await tab.evaluate(() => axe.run());
  for (const own of violations.filter((it) => ["serious", "critical"].includes(it.impact))) {
    problems.push(`${name}: ${own.id}: ${own.help}: ${own.nodes.map((node) => node.target).join("; ")}`);
  }
}

for (const [width, height] of [[1280, 900], [390, 844]]) {
  for (const scheme of ["light", "dark"]) console.log(await look(width, height, scheme));
}
await running.close();
if (!axe) console.log("not looked at: there is no axe-core");
for (const problem of problems) console.error(problem);
process.exit(problems.length > 0 ? 1 : 0);
