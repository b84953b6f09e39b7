// Figures, tables and the block that is picked.
const THEAD = (names) => make("thead", {}, make("tr", {}, ...names.map((name) => make("th", { scope: "col" }, name))));

/** A table that scrolls by itself where the page is narrow. */
function table(caption, names, rows) {
  const body = make("tbody", {}, ...rows);
  const own = make("table", {}, make("caption", {}, caption), THEAD(names), body);
  // A column of numbers has its name above them.
  [...own.querySelectorAll("thead th")].forEach((name, place) => {
    if (rows[0]?.children[place]?.classList.contains("number")) name.className = "number";
  });
  return make("div", { class: "scroll", role: "region", tabindex: "0", "aria-label": caption }, own);
}

/** A button that picks a block. */
function picker(own) {
  const button = make("button", { type: "button", class: "link", onclick: () => pick(own.place, "table") }, own.where);
  button.dataset.block = own.place;
  return button;
}

const tile = (name, value, ...more) => make("div", {}, make("dt", {}, name), make("dd", {}, make("strong", {}, value), ...more));

/** The programs of a set, of which one is shown at a time. */
function programs() {
  if (!SET) return;
  const fitting = SET.programs.filter((it) => it.fits).length;
  element("set").hidden = false;
  element("set-title").textContent = `${SET.programs.length} programs, limited together: ${fitting} fit`;
  const number = (text) => make("td", { class: "number" }, text);
  const rows = SET.programs.map((it, place) => {
    const link = make("a", { href: `#program=${place + 1}`, "aria-current": place === CHOSEN ? "true" : null }, it.program);
    const row = make("tr", {}, make("th", { scope: "row" }, link), make("td", { class: it.fits ? "" : "over" }, it.word),
      number(power(it.peak_w[0])), number(power(it.peak_w[1])), number(duration(it.duration_s[0])), number(duration(it.duration_s[1])), number(`${it.unfit_count[0]} → ${it.unfit_count[1]}`));
    row.classList.toggle("chosen", place === CHOSEN);
    return row;
  });
  const names = ["Program", "", "Peak", "after", "Time", "after", "Over the limit"];
  element("set-table").append(table("Programs: choose one to see it below", names, rows));
  const files = SET.files.map(([name, lines]) => `${name} (${lines === 0 ? "as it was" : `${lines} ${lines === 1 ? "line" : "lines"} edited`})`);
  const fate = SET.written ? "" : "Nothing is written, since not all of them fit. ";
  element("set-note").textContent = fate + (files.length > 0 ? `Files of subprograms: ${files.join(", ")}. A line that several programs run gets what is right for all of them.` : "No files of subprograms are called.");
  addEventListener("hashchange", () => location.reload());
}

/** The figures of two machines, as in the text of the comparison. */
function compared() {
  const { before, after } = HEAD;
  const pair = (print, figure) => `${print(before[figure])} → ${print(after[figure])}`;
  const share = (which) => {
    const [limit] = which.limits;
    const one = which.limits.length === 1 && limit.limit_w !== null;
    return one ? `${rough(which.figures.peak_w / limit.limit_w)} of ${power(limit.limit_w)}` : power(which.figures.peak_w);
  };
  const joule = (value) => (value === null ? "not known" : scaled(value, "J"));
  const more = after.duration_s - before.duration_s;
  const part = before.duration_s > 0 ? ` (${((100 * more) / before.duration_s).toFixed(2)} %)` : "";
  const back = SIDES.map((which) => DATA.shares[which.name]).map((it) => (it && it.fed_back_j !== null ? joule(it.fed_back_j) : "not known"));
  const over = (count) => (count > 0 ? make("small", {}, ` moves, and ${count} limits over time`) : make("small", {}, " moves"));
  element("tiles").className = "pairs";
  element("tiles").append(
    tile("Peak", pair(power, "peak_w"), make("small", {}, SIDES.map(share).join(" → "))),
    tile("Time", pair(duration, "duration_s"), make("small", {}, `${more >= 0 ? "" : "−"}${duration(Math.abs(more))} ${more >= 0 ? "longer" : "shorter"}${part}`)),
    tile("Energy drawn", pair(joule, "energy_j"), make("small", {}, pair(energy, "energy_j"))),
    tile("Fed back", back.join(" → "), make("small", {}, `peak ${pair(power, "regen_w")}`)),
    tile("Over the limit", pair(String, "unfit_count"), make("small", {}, ` of ${before.moves} → ${after.moves} moves`)),
    tile("Begin to fit", `${COMPARED.begin}`, over(COMPARED.limits_begin)),
    tile("Cease to fit", `${COMPARED.cease}`, over(COMPARED.limits_cease)),
  );
}

function tiles() {
  const { before, after } = HEAD;
  const last = after ?? before;
  if (COMPARED) return compared();
  const was = (text) => (after ? make("small", {}, ` before: ${text}`) : "");
  const [limit] = HEAD.limits;
  const one = HEAD.limits.length === 1 && limit.limit_w !== null;
  const of = one ? make("small", {}, ` of ${power(limit.limit_w)} (${rough(last.peak_w / limit.limit_w)})`) : "";
  const lost = after ? after.duration_s - before.duration_s : 0;
  const share = before.duration_s > 0 ? ` (${((100 * lost) / before.duration_s).toFixed(2)} %)` : "";
  const back = [after ? DATA.shares.after : null, DATA.shares.before].find(Boolean);
  const credited = HEAD.limits.every((it) => it.credit_regen);
  const fate = credited ? "feeds the other axes" : "counted as burnt";
  const list = [
    tile("Peak", power(last.peak_w), of, was(power(before.peak_w))),
    tile("Time", duration(last.duration_s), after ? make("small", {}, ` ${lost >= 0 ? "" : "−"}${duration(Math.abs(lost))} ${lost >= 0 ? "lost" : "gained"}${share}`) : ""),
    tile("Energy drawn", energy(last.energy_j), after && before.energy_j !== null ? was(energy(before.energy_j)) : ""),
    tile("Fed back", back && back.fed_back_j !== null ? energy(back.fed_back_j) : "not known", make("small", {}, ` ${fate}; peak ${power(last.regen_w)}`)),
    tile("Over the limit", `${last.unfit_count}`, make("small", {}, ` of ${last.moves} moves`), was(`${before.unfit_count}`)),
  ];
  if (HEAD.limited) list.push(tile("Changed", `${HEAD.limited.edited_lines}`, make("small", {}, " lines of the program")));
  element("tiles").append(...list);
}

/** The simultaneous set of each of the largest peaks. */
function peakTables() {
  const box = element("peak-tables");
  for (const which of SIDES) {
    const list = DATA.moments[which.name];
    const used = CHANNELS.map((_, channel) => channel).filter((channel) => list.some((it) => it.values_w && Math.abs(it.values_w[channel]) >= 0.005));
    const rows = list.map((it) => {
      const own = block(it.block);
      const sum = it.values_w ? it.values_w.reduce((a, b) => a + Math.max(0, b), 0) : 0;
      const cells = used.map((channel) => {
        const value = it.values_w ? it.values_w[channel] : null;
        if (value === null || Math.abs(value) < 0.005) return make("td", { class: "number none" }, "–");
        const part = value > 0 && sum > 0 ? percent(value / sum) : "fed back";
        return make("td", { class: "number" }, power(value), make("small", {}, ` ${part}`));
      });
      const row = make("tr", {}, make("th", { scope: "row" }, picker(own)), make("td", {}, make("code", {}, own.text)), make("td", { class: "number" }, moment(it.time_s)), make("td", { class: "number" }, power(it.peak_w)), make("td", { class: "number" }, it.planned_w === null ? "not known" : power(it.planned_w)), ...cells);
      row.dataset.block = own.place;
      return row;
    });
    const names = ["Block", "Text", "Moment", "Peak (report)", "Planned", ...used.map((channel) => CHANNELS[channel])];
    box.append(table(which.title ? `${which.title}: the largest peaks` : "The largest peaks", names, rows));
  }
  box.append(make("p", { class: "hint" }, "“Planned” is the power at that moment at 100 % override; the peak of the report also covers higher overrides, servo factors, and bounds where corners are not modelled. Shares are of what is drawn."));
}

/** The blocks that take most of their limits. */
function worstTable() {
  const names = TWO
    ? ["Block", "Text", "Move", "Peak", LATER, "Load", LATER, "Time", LATER, COMPARED ? "What changes" : "What was done"]
    : ["Block", "Text", "Move", "Peak", "Fed back", "Load", "Time", "Energy", "What helps"];
  const load = (value, plain) => {
    const over = value === null || value > 1.000001;
    const level = plain ? "" : make("span", { class: "level", "aria-hidden": "true" }, make("i", { style: `width:${50 * Math.min(value ?? 2, 2)}%` }));
    return make("td", { class: `number${over ? " over" : ""}` }, level, make("span", { class: "share" }, value === null ? "over" : rough(value)));
  };
  const number = (text) => make("td", { class: "number" }, text);
  const unknown = (value, print) => number(value === null ? "–" : print(value));
  const row = (place) => {
    const own = block(place);
    const first = own.start_s !== null;
    const loads = COMPARED ? [first ? load(own.load) : number("–"), own.peak_after_w === null ? number("–") : load(own.load_after)] : [load(own.load), load(own.load_after, true)];
    const cells = TWO
      ? [unknown(own.peak_w, power), unknown(own.peak_after_w, power), ...loads, first ? number(duration(own.duration_s)) : number("–"), unknown(own.duration_after_s, duration)]
      : [number(power(own.peak_w)), number(power(own.regen_w)), load(own.load), number(duration(own.duration_s)), number(energy(own.energy_j))];
    const row = make("tr", {}, make("th", { scope: "row" }, picker(own)), make("td", {}, make("code", {}, own.text)), make("td", {}, `${own.kind} ${own.axes}`), ...cells, make("td", { class: "words" }, TWO ? done(own) : own.help));
    row.dataset.block = own.place;
    return row;
  };
  if (DATA.differ.length > 0) {
    const count = COMPARED.begin + COMPARED.cease;
    const rows = DATA.differ.map(row);
    const caption = count > rows.length ? `The ${rows.length} lines of most load of ${count} moves that fit on one machine only` : "Lines with moves that fit on one machine only";
    element("worst-table").append(table(caption, names, rows));
  }
  const rows = DATA.worst.map(row);
  const caption = HEAD.rows > rows.length ? `The ${rows.length} lines nearest to the limit, of ${HEAD.rows} moves` : "All lines, the one nearest to the limit first";
  element("worst-table").append(table(caption, names, rows));
}

/** Percent without the digits that distinguish it from 100. */
const rough = (share) => (Math.abs(share - 1) < 0.01 && share <= 1.000001 ? "100 %" : percent(share));

/** What was done to a block. */
const done = (own) => [own.action, own.words].filter(Boolean).join(": ");

function overTime() {
  if (HEAD.over_time.length === 0) return;
  element("over-time").hidden = false;
  const rows = HEAD.over_time.map((it) => make("tr", {},
    make("th", { scope: "row" }, it.machine ? `${it.machine}: ${it.title}` : it.title), make("td", { class: "number" }, it.figures),
    make("td", { class: it.fits ? "" : "over" }, it.fits ? "kept" : "missed"),
    make("td", {}, it.line > 0 ? `line ${it.line} at ${moment(it.time_s)}` : ""), make("td", {}, make("code", {}, TEXTS.get(it.line) ?? "")), make("td", {}, it.help)));
  element("over-time-table").append(table("Limits over time", ["Limit", "Value", "", "Where", "Text", "What helps"], rows));
}

/** The block that is picked, in words. */
function details(own) {
  const box = element("details");
  if (!own) return box.replaceChildren(make("p", { class: "hint" }, "Click a peak, a piece of the path or a line of a table."));
  const fact = (name, ...value) => make("div", { class: ["Helps", "Done", "Changes"].includes(name) ? "wide-fact" : null }, make("dt", {}, name), make("dd", {}, ...value));
  const bar = barOf(own.row);
  const shared = at(BARS.rows, bar) > 1 ? `one of ${at(BARS.rows, bar)} moves in this bar` : "";
  const about = [`${own.kind} ${own.axes}`.trim(), own.run > 1 ? `run ${own.run}` : "", own.bound ? "bound: corners are not modelled" : "", own.converter, shared].filter(Boolean).join(" · ");
  const of = (limit) => make("small", {}, limit === null || limit === undefined ? "" : ` of ${power(limit)}`);
  const here = own.start_s !== null;
  const there = TWO && own.peak_after_w !== null;
  const first = COMPARED ? ` on ${COMPARED.names[0]}` : "";
  const facts = here
    ? [
      fact(`Peak${first}`, power(own.peak_w), of(own.limit_w)),
      fact("Load", own.load === null ? "not known" : rough(own.load)),
      fact("Fed back", power(own.regen_w)),
      fact("Time", duration(own.duration_s), make("small", {}, ` from ${moment(own.start_s)}`)),
      fact("Energy", energy(own.energy_j)),
    ]
    : [fact(`Peak${first}`, "no such move")];
  if (there) {
    facts.push(fact(`Peak ${LATER}`, power(own.peak_after_w), COMPARED ? of(own.limit_after_w) : ""));
    if (COMPARED) facts.push(fact("Load", own.load_after === null ? "not known" : rough(own.load_after)), fact("Fed back", power(own.regen_after_w)));
    facts.push(fact(COMPARED ? "Time" : "Time after", duration(own.duration_after_s), COMPARED ? make("small", {}, ` from ${moment(own.start_after_s)}`) : ""));
  } else if (COMPARED) {
    facts.push(fact(`Peak ${LATER}`, "no such move"));
  }
  const what = TWO ? done(own) : own.help;
  if (what) facts.push(fact(COMPARED ? "Changes" : LIMITED ? "Done" : "Helps", what));
  box.replaceChildren(
    make("p", { class: "source" }, make("span", {}, own.where), make("code", {}, own.text || "no text at hand")),
    make("p", { class: "hint" }, about), make("dl", { class: "facts" }, ...facts), ...SIDES.map((which) => strip(own, which)).filter(Boolean),
  );
}

/** Who draws at the largest planned power of a block, as a strip. */
function strip(own, which) {
  const when = span(own, which);
  const set = when && together(which, when);
  if (!set || set.sum <= 0) return null;
  const parts = CHANNELS.map((name, channel) => [name, set.values[channel]]).filter(([, value]) => value >= 0.005);
  const text = parts.map(([name, value]) => `${name} ${power(value)} (${percent(value / set.sum)})`).join(", ");
  const pieces = parts.map(([name, value]) => make("i", { style: `flex-grow:${value / set.sum};background:${COLOURS[name]}` }));
  const title = which.title ? `${which.title}: ` : "";
  return make("div", { class: "strip" }, make("div", { "aria-hidden": "true" }, ...pieces), make("p", {}, `${title}planned ${power(set.sum)}: ${text}`));
}
