// Two machines in one chart: the peaks of each block, one over the other.
const LINES = ["--first", "--second"];
/** Whether the second machine's blocks stand where those of the first are. */
let IN_STEP = false;

/** The second machine as it is laid over the first. */
function laid() {
  const [first, second] = SIDES;
  if (!IN_STEP) return second;
  const place = new Map(second.bar.map((bar, index) => [bar, index]));
  const moved = (list) => first.bar.map((bar) => list[place.get(bar)]);
  return { ...second, bar: first.bar, from: first.from, to: first.to, peak: moved(second.peak), back: moved(second.back) };
}

function drawOverlay(charts) {
  const [first] = SIDES;
  const figures = SIDES.map((which) => `${which.title}: peak ${power(which.figures.peak_w)}, ${duration(which.figures.duration_s)}`);
  const box = make("div", { class: "chart", id: "overlay", role: "img", "aria-label": `Power over time on both machines. ${figures.join("; ")}` });
  const select = make("select", { id: "lay" }, make("option", { value: "time" }, "each in its own time"), make("option", { value: "step" }, "block by block"));
  select.addEventListener("change", () => {
    IN_STEP = select.value === "step";
    redraw();
  });
  const both = SIDES.map((which, index) => make("span", { class: "machine" }, make("i", { style: `background:var(${LINES[index]})` }), which.title));
  charts.append(make("div", { class: "bar" }, make("h3", {}, "Both machines ", ...both), make("label", { for: "lay" }, "Second machine ", select)), box);
  CHARTS.push(chart({ ...first, overlay: true }, box));
}

/** Draws both, each with its limits. */
function overlay(ctx, ends, visible, x, y) {
  [SIDES[0], laid()].forEach((which, index) => {
    outline(ctx, which, visible, x, y, LINES[index]);
    limits(ctx, which, ends, y, LINES[index], index === 1);
  });
}

/** The bar under the cursor, of the machine whose line is nearer to it. */
function nearestOfBoth(plot, left, top) {
  const value = plot.posToVal(top, "y");
  const found = [SIDES[0], laid()].map((which) => {
    const place = nearest(plot, which, left);
    if (place === null) return null;
    const far = Math.min(...[which.peak[place] ?? Infinity, -(which.back[place] ?? Infinity)].map((own) => Math.abs(own - value)));
    return { which, place, far };
  }).filter(Boolean);
  return found.length === 2 && found[1].far < found[0].far ? found[1] : (found[0] ?? null);
}
