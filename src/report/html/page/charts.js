// Power over time: axes, zoom and cursor by uPlot, areas and lines drawn here.
const CHARTS = [];
const HIDDEN = new Set();
/** The cursor of one chart goes along in the other charts of the same program; nothing else does. */
const FOLLOWED = { pub: (type) => type === "mousemove" || type === "mouseleave", sub: () => true };
const css = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

/** The same range of power in all charts, W. */
function range() {
  const known = (list) => list.filter((value) => value !== null);
  const limits = SIDES.flatMap((which) => which.limits).flatMap((it) => [it.limit_w ?? 0, -(it.regen_limit_w ?? 0)]);
  const overloads = HEAD.over_time.map((it) => it.above_w ?? 0);
  let [least, most] = [Math.min(0, ...limits), Math.max(1, ...limits, ...overloads)];
  for (const which of SIDES) {
    for (const value of known(which.peak)) most = Math.max(most, value);
    for (const value of known(which.back)) least = Math.min(least, -value);
  }
  const room = 0.05 * (most - least);
  return [least - room, most + room];
}

/** What a chart of power shows: its range, its unit, its drawing, and what it says of a bar. */
const POWER = { range, space: 30, label: (value) => (value === 0 ? "0" : power(value)), draw, say: (which, place) => power(which.peak[place]) };

/** One chart. */
function chart(which, box, what = POWER) {
  const end = Math.max(...SIDES.map((it) => it.to[it.to.length - 1] ?? 0), 1e-3);
  const [least, most] = what.range();
  const axis = () => ({
    stroke: () => css("--quiet"),
    grid: { stroke: () => css("--grid"), width: 1 },
    ticks: { stroke: () => css("--grid"), width: 1 },
    font: "12px system-ui, sans-serif",
  });
  const labels = (_, values) => values.map((value) => (value === null ? "" : clock(value)));
  const options = {
    width: box.clientWidth,
    height: box.clientHeight,
    legend: { show: false },
    scales: { x: { time: false, range: (_, from, to) => [from, to] }, y: { range: () => [least, most] } },
    series: [{}, { show: true, paths: () => null, points: { show: false } }],
    axes: [
      { ...axis(), values: labels },
      { ...axis(), size: 76, space: what.space, values: (_, values) => values.map(what.label) },
    ],
    cursor: { drag: { x: true, y: false, setScale: false }, points: { show: false }, y: false, sync: { key: which.overlay ? "overlay" : which.name, scales: ["x", null], setSeries: false, filters: FOLLOWED } },
    hooks: { draw: [(plot) => what.draw(plot, which)], setSelect: [(plot) => zoomed(plot, which)], setCursor: [(plot) => hover(plot, which, what)] },
  };
  const plot = new uPlot(options, [[0, end], [least, most]], box);
  plot.over.addEventListener("dblclick", () => zoom(null));
  click(plot, which);
  return { plot, which, box, end };
}

function clock(seconds) {
  const value = Number(seconds.toFixed(6));
  if (seconds < 120) return `${value} s`;
  const [minutes, rest] = [Math.floor(seconds / 60), Number((seconds % 60).toFixed(3))];
  if (minutes < 60) return `${minutes}:${String(rest).padStart(2, "0")}`;
  return `${Math.floor(minutes / 60)}:${String(minutes % 60).padStart(2, "0")}:${String(rest).padStart(2, "0")}`;
}

function draw(plot, which) {
  const { ctx } = plot;
  const { left, top, width, height: high } = plot.bbox;
  ctx.save();
  ctx.beginPath();
  ctx.rect(left, top, width, high);
  ctx.clip();
  const x = (seconds) => plot.valToPos(seconds, "x", true);
  const y = (value) => plot.valToPos(value, "y", true);
  mark(ctx, which, x, top, high);
  if (which.overlay && !IN_STEP) mark(ctx, SIDES[1], x, top, high);
  if (which.shares && !which.overlay) areas(ctx, which.shares, plot.scales.x, x, y);
  line(ctx, [left, left + width], y(0), css("--quiet"), []);
  if (which.overlay) {
    overlay(ctx, [left, left + width], plot.scales.x, x, y);
  } else {
    outline(ctx, which, plot.scales.x, x, y);
    limits(ctx, which, [left, left + width], y);
  }
  ctx.restore();
}

/** Where the block that is picked runs. */
function mark(ctx, which, x, top, high) {
  if (PICKED === null) return;
  const own = span(block(PICKED), which);
  if (!own) return;
  const [from, to] = own.map(x);
  const wide = Math.max(3 * devicePixelRatio, to - from);
  ctx.fillStyle = css("--mark");
  const left = (from + to - wide) / 2;
  ctx.fillRect(left, top, wide, high);
  ctx.fillStyle = css("--picked");
  for (const edge of [left, left + wide - devicePixelRatio]) ctx.fillRect(edge, top, devicePixelRatio, high);
}

function line(ctx, [from, to], y, colour, dash) {
  ctx.beginPath();
  ctx.setLineDash(dash.map((it) => it * devicePixelRatio));
  ctx.lineWidth = 1.5 * devicePixelRatio;
  ctx.strokeStyle = colour;
  ctx.moveTo(from, y);
  ctx.lineTo(to, y);
  ctx.stroke();
  ctx.setLineDash([]);
}

/** What a line stands for, at one of its ends. */
function label(ctx, ends, text, at, colour, left) {
  ctx.font = `${11 * devicePixelRatio}px system-ui, sans-serif`;
  ctx.textAlign = left ? "left" : "right";
  const edge = left ? ends[0] + 6 * devicePixelRatio : ends[1] - 6 * devicePixelRatio;
  const place = [text, edge, at - 5 * devicePixelRatio];
  ctx.strokeStyle = css("--card");
  ctx.lineWidth = 4 * devicePixelRatio;
  ctx.strokeText(...place);
  ctx.fillStyle = css(colour);
  ctx.fillText(...place);
}

/** The limits with the margin taken off, and the powers that are permitted for a time. */
function limits(ctx, which, ends, y, colour = "--limit", left = false) {
  for (const limit of which.limits) {
    const name = limit.name ? ` ${limit.name}` : "";
    const margin = limit.margin > 0 ? `, ${percent(limit.margin)} margin` : "";
    if (limit.limit_w !== null) {
      line(ctx, ends, y(limit.limit_w), css(colour), [7, 4]);
      label(ctx, ends, `limit${name} ${power(limit.limit_w)}${margin}`, y(limit.limit_w), colour, left);
    }
    if (limit.regen_limit_w !== null) {
      line(ctx, ends, y(-limit.regen_limit_w), css(colour), [7, 4]);
      label(ctx, ends, `fed back${name} ${power(limit.regen_limit_w)}`, y(-limit.regen_limit_w), colour, left);
    }
  }
  for (const found of HEAD.over_time) {
    if (COMPARED && found.machine !== COMPARED.names[which.name === "after" ? 1 : 0]) continue;
    if (found.above_w === null) continue;
    line(ctx, ends, y(found.above_w), css(colour), [2, 5]);
    label(ctx, ends, found.label, y(found.above_w), colour, !left);
  }
}

/** What each draws, one on top of the other. */
function areas(ctx, shares, visible, x, y) {
  const first = Math.max(0, above(shares.to, visible.min) - 1);
  const last = Math.min(shares.from.length, above(shares.from, visible.max) + 1);
  for (const lists of [shares.up, shares.down]) {
    const sign = lists === shares.up ? 1 : -1;
    const edge = new Float64Array(Math.max(0, last - first));
    CHANNELS.forEach((name, channel) => {
      if (HIDDEN.has(name)) return;
      const list = lists[channel];
      ctx.beginPath();
      let any = false;
      const back = [];
      for (let place = first; place < last; place += 1) {
        const inner = edge[place - first];
        const outer = inner + sign * list[place];
        any ||= outer !== inner;
        edge[place - first] = outer;
        const [from, to] = [x(shares.from[place]), x(shares.to[place])];
        ctx.lineTo(from, y(outer));
        back.push(from, y(inner));
        if (to > from) {
          ctx.lineTo(to, y(outer));
          back.push(to, y(inner));
        }
      }
      for (let place = back.length - 2; place >= 0; place -= 2) ctx.lineTo(back[place], back[place + 1]);
      if (!any) return;
      ctx.fillStyle = COLOURS[name];
      ctx.globalAlpha = 0.82;
      ctx.fill();
      ctx.globalAlpha = 1;
    });
  }
}

/** The peak of each block; bounds are dashed. */
function outline(ctx, which, visible, x, y, colour = "--ink") {
  const first = Math.max(0, above(which.to, visible.min) - 2);
  const last = Math.min(BARS.count, above(which.from, visible.max) + 2);
  const top = y(range()[1]);
  for (const [list, sign] of [[which.peak, 1], [which.back, -1]]) {
    let bound = null;
    for (let place = first; place < last; place += 1) {
      const value = list[place];
      const height = value === null ? top : y(sign * value);
      const dashed = Boolean(at(BARS.bound, which.bar[place]));
      if (dashed !== bound) {
        if (bound !== null) ctx.stroke();
        ctx.beginPath();
        ctx.setLineDash(dashed ? [4 * devicePixelRatio, 3 * devicePixelRatio] : []);
        ctx.lineWidth = 1.5 * devicePixelRatio;
        ctx.strokeStyle = css(colour);
        bound = dashed;
        if (place > first) ctx.moveTo(x(which.from[place]), y(sign * (list[place - 1] ?? 0)));
      }
      ctx.lineTo(x(which.from[place]), height);
      ctx.lineTo(x(which.to[place]), height);
    }
    if (bound !== null) ctx.stroke();
    ctx.setLineDash([]);
  }
}

/** The bar under the cursor: of those that are too narrow to distinguish, the one with the most load. */
function nearest(plot, which, left) {
  if (BARS.count === 0) return null;
  const reach = Math.abs(plot.posToVal(left + 4, "x") - plot.posToVal(left, "x"));
  const seconds = plot.posToVal(left, "x");
  const first = Math.max(0, above(which.to, seconds - reach) - 1);
  let best = null;
  for (let place = first; place < BARS.count && which.from[place] <= seconds + reach; place += 1) {
    if (which.to[place] < seconds - reach) continue;
    const load = at(which.name === "after" ? BLOCKS.load_after : BLOCKS.load, BARS.lead[which.bar[place]]) ?? Infinity;
    const inside = which.from[place] <= seconds && seconds <= which.to[place] && which.to[place] - which.from[place] > 2 * reach;
    if (inside) return place;
    if (best === null || load > best.load) best = { place, load };
  }
  return best === null ? null : best.place;
}

/** The bar under a point of a chart, with the side that it is of. */
function under(plot, which, left, top) {
  if (which.overlay) return nearestOfBoth(plot, left, top);
  const place = nearest(plot, which, left);
  return place === null ? null : { which, place };
}

function hover(plot, shown, what) {
  const { left, top } = plot.cursor;
  const tip = plot.over.querySelector(".tip") ?? plot.over.appendChild(make("div", { class: "tip" }));
  const found = left >= 0 ? under(plot, shown, left, top) : null;
  tip.hidden = found === null;
  if (found === null) return;
  const { which, place } = found;
  const own = block(BARS.lead[which.bar[place]]);
  const rows = at(BARS.rows, which.bar[place]);
  const more = rows > 1 ? ` and ${rows - 1} more` : "";
  tip.replaceChildren(
    make("strong", {}, `${shown.overlay ? `${which.title}: ` : ""}${what.say(which, place, plot.posToVal(left, "x"))}`), ` at ${moment(plot.posToVal(left, "x"))}`,
    make("br"), `${own.where}${more}`, make("br"), make("code", {}, own.text),
  );
  const right = left > plot.over.clientWidth / 2;
  tip.style.left = right ? "" : `${left + 12}px`;
  tip.style.right = right ? `${plot.over.clientWidth - left + 12}px` : "";
}

/** A click picks a block, a drag zooms. */
function click(plot, which) {
  let from = null;
  plot.over.addEventListener("pointerdown", (event) => { from = event.clientX; });
  plot.over.addEventListener("pointerup", (event) => {
    if (from === null || Math.abs(event.clientX - from) > 4) return;
    const box = plot.over.getBoundingClientRect();
    const found = under(plot, which, event.clientX - box.left, event.clientY - box.top);
    if (found) pick(BARS.lead[found.which.bar[found.place]], "chart");
  });
}

/** The same moment in another program. */
function moved(seconds, from, to) {
  if (from.name === to.name || BARS.count === 0) return seconds;
  const place = Math.min(BARS.count - 1, Math.max(0, above(from.from, seconds) - 1));
  const lasts = from.to[place] - from.from[place];
  const share = lasts > 0 ? Math.min(1, Math.max(0, (seconds - from.from[place]) / lasts)) : 0;
  const there = to.bar.indexOf(from.bar[place]);
  return to.from[there] + share * (to.to[there] - to.from[there]);
}

function zoomed(plot, which) {
  if (plot.select.width < 5) return;
  const ends = [plot.select.left, plot.select.left + plot.select.width].map((left) => plot.posToVal(left, "x"));
  plot.setSelect({ left: 0, width: 0, top: 0, height: 0 }, false);
  zoom(ends, which);
}

/** Shows a span of time in all charts, or the whole program. */
function zoom(ends, which) {
  for (const own of CHARTS) {
    const [min, max] = ends ? ends.map((seconds) => moved(seconds, which, own.which)).sort((a, b) => a - b) : [0, own.end];
    own.plot.setScale("x", { min, max: Math.max(max, min + 1e-4) });
  }
}

/** Shows the block that is picked with what is next to it. */
function near() {
  const own = PICKED === null ? null : block(PICKED);
  const first = own && CHARTS.find((it) => span(own, it.which));
  if (!first) return;
  const when = span(own, first.which);
  const room = Math.max(0.75 * (when[1] - when[0]), 1e-3 * first.end, 0.05);
  zoom([Math.max(0, when[0] - room), when[1] + room], first.which);
}

function drawCharts() {
  const charts = element("charts");
  if (COMPARED) drawOverlay(charts);
  for (const which of SIDES) {
    const figures = which.figures;
    const heading = which.title ? make("h3", {}, which.title, make("span", {}, ` peak ${power(figures.peak_w)}, ${duration(figures.duration_s)}`)) : "";
    const name = COMPARED ? `, ${which.title}` : which.title ? `, ${which.title.toLowerCase()} limiting` : "";
    const label = `Power over time${name}: peak ${power(figures.peak_w)}, ${duration(figures.duration_s)}`;
    const box = make("div", { class: "chart", role: "img", "aria-label": label });
    charts.append(heading, box);
    CHARTS.push(chart(which, box));
    drawVoltage(charts, which);
  }
  const legend = element("legend");
  CHANNELS.forEach((name, channel) => {
    const any = SIDES.some((it) => it.shares && [it.shares.up, it.shares.down].some((lists) => lists[channel].some((value) => value > 0)));
    if (!any) return;
    const toggle = (event) => {
      const off = !HIDDEN.delete(name);
      if (off) HIDDEN.add(name);
      event.currentTarget.setAttribute("aria-pressed", String(!off));
      redraw();
    };
    const button = make("button", { type: "button", "aria-pressed": "true", onclick: toggle }, make("i", { style: `background:${COLOURS[name]}` }), name);
    legend.append(make("li", {}, button));
  });
  legend.append(make("li", { class: "key" }, make("i", { class: "peak" }), "block peak"), make("li", { class: "key" }, make("i", { class: "limit" }), "limit"));
  if (HEAD.over_time.some((it) => it.above_w !== null)) legend.append(make("li", { class: "key" }, make("i", { class: "overload" }), "overload counts above"));
  voltageKeys(legend);
  element("whole").addEventListener("click", () => zoom(null));
  element("near").addEventListener("click", near);
  new ResizeObserver(() => {
    for (const own of CHARTS) own.plot.setSize({ width: own.box.clientWidth, height: own.box.clientHeight });
  }).observe(charts);
}

function redraw() {
  for (const own of CHARTS) own.plot.redraw(false);
}
