// The path in space: three.js draws, turns and zooms; what is hit is found here.
let SPACE = null;
/** From no load to the limit, and beyond it. */
const RAMP = [[0, "#3b6fb6"], [0.35, "#2aa5a0"], [0.65, "#b9c043"], [0.9, "#f0a030"], [1, "#e8542f"], [1.0001, "#d0124b"], [2, "#8b0045"]];

function ramp(load) {
  const value = Math.min(Math.max(load ?? 2, 0), 2);
  const next = RAMP.findIndex(([place]) => place >= value);
  const [[from, a], [to, b]] = [RAMP[Math.max(0, next - 1)], RAMP[next]];
  return new THREE.Color(a).lerp(new THREE.Color(b), to > from ? (value - from) / (to - from) : 1);
}

/** By what the path may be coloured. */
const PAINTS = [
  { name: COMPARED ? `power on ${COMPARED.names[0]}` : LIMITED ? "power before" : "power", of: (place) => ramp(at(BLOCKS.load, place)) },
  TWO && { name: COMPARED ? `power on ${COMPARED.names[1]}` : "power after", of: (place) => ramp(at(BLOCKS.load_after, place)) },
  LIMITED && { name: "what was changed", of: (place) => new THREE.Color(at(BLOCKS.action, place) ? css("--changed") : css("--faint")) },
  COMPARED && { name: "what begins or ceases to fit", of: (place) => new THREE.Color(css({ "begins to fit": "--good", "ceases to fit": "--changed" }[at(BLOCKS.action, place)] ?? "--faint")) },
  { name: "rapids and feeds", of: (place) => new THREE.Color(at(BLOCKS.kind, place) === "rapid" ? "#e3891b" : "#4269d0") },
].filter(Boolean);

/** The corners of all lines, in mm around their middle. */
function corners() {
  const { points, ends, cell_mm: cell } = PATH;
  const boxes = [0, 1, 2].map(() => [Infinity, -Infinity]);
  points.forEach((value, place) => {
    const box = boxes[place % 3];
    box[0] = Math.min(box[0], value);
    box[1] = Math.max(box[1], value);
  });
  const middle = boxes.map(([low, high]) => (low + high) / 2);
  const place = new Float32Array(ends.length * 3);
  ends.forEach((end, index) => {
    for (let axis = 0; axis < 3; axis += 1) place[3 * index + axis] = (points[3 * end + axis] - middle[axis]) * cell;
  });
  return { place, size: boxes.map(([low, high]) => (high - low) * cell) };
}

function drawSpace() {
  const scene = element("scene");
  if (PATH.ends.length === 0) return nothing("No axis moves in space.");
  let renderer;
  try {
    renderer = new THREE.WebGLRenderer({ antialias: true, alpha: true });
  } catch {
    return nothing("This browser has no WebGL, so that the path is not drawn. All else is here.");
  }
  const { place, size } = corners();
  const radius = Math.max(Math.hypot(...size) / 2, 1e-3);
  const camera = new THREE.OrthographicCamera(-1, 1, 1, -1, 0, 20 * radius);
  camera.up.set(0, 0, 1);
  const world = new THREE.Scene();
  const geometry = new THREE.LineSegmentsGeometry();
  geometry.setPositions(place);
  const material = new THREE.LineMaterial({ linewidth: 1.8, vertexColors: true });
  world.add(new THREE.LineSegments2(geometry, material));
  const picked = new THREE.LineSegmentsGeometry();
  const bright = new THREE.LineSegments2(picked, new THREE.LineMaterial({ linewidth: 5, depthTest: false, transparent: true, opacity: 0.9 }));
  bright.visible = false;
  bright.renderOrder = 1;
  world.add(bright);
  const canvas = renderer.domElement;
  canvas.setAttribute("role", "img");
  canvas.setAttribute("aria-label", "The path of the tool in space; the buttons below turn and zoom it, tables and charts pick pieces of it");
  scene.append(canvas);
  const controls = new THREE.OrbitControls(camera, canvas);
  controls.zoomToCursor = true;
  // Else nobody could scroll past it.
  controls.enableZoom = false;
  canvas.addEventListener("pointerdown", () => { controls.enableZoom = true; });
  canvas.addEventListener("pointerleave", () => { controls.enableZoom = false; });
  SPACE = { renderer, camera, world, geometry, bright, picked, controls, place, size, radius, canvas, half: [radius, radius] };
  scene.append(make("div", { class: "triad", "aria-hidden": "true" }));
  controls.addEventListener("change", show);
  paint(0);
  view("oblique");
  new ResizeObserver(fit).observe(scene);
  hitting(canvas);
  const select = element("colour");
  PAINTS.forEach((own, index) => select.append(make("option", { value: index }, own.name)));
  select.addEventListener("change", () => { paint(Number(select.value)); show(); });
  for (const button of document.querySelectorAll("#views button")) {
    button.addEventListener("click", () => {
      if (button.dataset.view) return view(button.dataset.view);
      camera.zoom *= Number(button.dataset.zoom);
      camera.updateProjectionMatrix();
      show();
    });
  }
  element("scale").append("0 %", make("i"), "limit", make("b"), "above");
}

function nothing(text) {
  element("scene").append(make("p", { class: "empty" }, text));
  element("views").hidden = true;
  document.querySelector("#space label").hidden = true;
}

function paint(index) {
  const colours = new Float32Array(PATH.lead.length * 6);
  PATH.lead.forEach((place, line) => {
    const { r, g, b } = PAINTS[index].of(place);
    colours.set([r, g, b, r, g, b], 6 * line);
  });
  SPACE.geometry.setColors(colours);
  SPACE.paint = index;
  element("scale").style.visibility = PAINTS[index].name.startsWith("power") ? "visible" : "hidden";
}

function fit() {
  const { renderer, camera, half, canvas } = SPACE;
  const [width, high] = [canvas.parentElement.clientWidth, canvas.parentElement.clientHeight];
  renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
  renderer.setSize(width, high, false);
  const shape = width / Math.max(1, high);
  const y = 1.12 * Math.max(half[1], half[0] / shape);
  const x = y * shape;
  [camera.left, camera.right, camera.top, camera.bottom] = [-x, x, y, -y];
  camera.updateProjectionMatrix();
  show();
}

function view(name) {
  const { camera, controls, radius } = SPACE;
  const from = { oblique: [-0.5, -0.8, 0.6], top: [0, -1e-4, 1], front: [0, -1, 0], side: [1, 0, 0] }[name];
  controls.target.set(0, 0, 0);
  camera.position.set(...from).normalize().multiplyScalar(8 * radius);
  camera.zoom = 1;
  camera.updateProjectionMatrix();
  controls.update();
  camera.updateMatrixWorld();
  SPACE.half = extent();
  fit();
}

/** Half the width and the height of the path as the camera sees it, mm. */
function extent() {
  const { camera, size, radius } = SPACE;
  const point = new THREE.Vector3();
  const half = [1e-3 * radius, 1e-3 * radius];
  for (let corner = 0; corner < 8; corner += 1) {
    point.set(...size.map((long, axis) => ((corner >> axis) & 1 ? 0.5 : -0.5) * long));
    point.applyMatrix4(camera.matrixWorldInverse);
    half[0] = Math.max(half[0], Math.abs(point.x));
    half[1] = Math.max(half[1], Math.abs(point.y));
  }
  return half;
}

/** Which way the axes point. */
function triad() {
  const point = new THREE.Vector3();
  const arms = ["X", "Y", "Z"].map((name, axis) => {
    point.set(0, 0, 0).setComponent(axis, 1).transformDirection(SPACE.camera.matrixWorldInverse);
    const [x, y] = [26 * point.x, -26 * point.y];
    const arm = make("i", { style: `width:${Math.hypot(x, y)}px;transform:rotate(${Math.atan2(y, x)}rad);background:${COLOURS[name]}` });
    return [arm, make("b", { style: `left:${34 + 1.3 * x}px;top:${34 + 1.3 * y}px` }, name)];
  });
  document.querySelector(".triad").replaceChildren(...arms.flat());
}

let waiting = false;
function show() {
  if (waiting || !SPACE) return;
  waiting = true;
  requestAnimationFrame(() => {
    waiting = false;
    SPACE.renderer.render(SPACE.world, SPACE.camera);
    triad();
  });
}

/** A click picks the line that is nearest to it. */
function hitting(canvas) {
  let from = null;
  canvas.addEventListener("pointerdown", (event) => { from = [event.clientX, event.clientY]; });
  canvas.addEventListener("pointerup", (event) => {
    if (!from || Math.hypot(event.clientX - from[0], event.clientY - from[1]) > 4) return;
    const box = canvas.getBoundingClientRect();
    const line = hit([event.clientX - box.left, event.clientY - box.top], [box.width, box.height]);
    if (line !== null) pick(PATH.lead[line], "path");
  });
}

function hit([x, y], [width, high]) {
  const { place, camera } = SPACE;
  const point = new THREE.Vector3();
  const seen = (corner) => {
    point.fromArray(place, 3 * corner).project(camera);
    return [((point.x + 1) / 2) * width, ((1 - point.y) / 2) * high];
  };
  let best = { line: null, far: 12 };
  for (let line = 0; line < PATH.lead.length; line += 1) {
    const [a, b] = [seen(2 * line), seen(2 * line + 1)];
    const [dx, dy] = [b[0] - a[0], b[1] - a[1]];
    const long = dx * dx + dy * dy;
    const share = long > 0 ? Math.min(1, Math.max(0, ((x - a[0]) * dx + (y - a[1]) * dy) / long)) : 0;
    const far = Math.hypot(a[0] + share * dx - x, a[1] + share * dy - y);
    if (far < best.far) best = { line, far };
  }
  return best.line;
}

/** Lights up the piece of path that a block runs along. */
function light(own) {
  if (!SPACE) return;
  const lines = piece(own);
  const places = new Float32Array(lines.length * 6);
  lines.forEach((line, index) => places.set(SPACE.place.subarray(6 * line, 6 * line + 6), 6 * index));
  SPACE.bright.visible = lines.length > 0;
  if (lines.length > 0) {
    // A new one: the old one has room for as many lines as it had.
    SPACE.picked.dispose();
    SPACE.picked = new THREE.LineSegmentsGeometry();
    SPACE.picked.setPositions(places);
    SPACE.bright.geometry = SPACE.picked;
    SPACE.bright.material.color.set(css("--ink"));
  }
  show();
}

/** The lines of a block; where it shares them with others, those of its bar, or the nearest. */
function piece(own) {
  const row = (line) => at(BLOCKS.row, PATH.lead[line]);
  const lines = [...PATH.lead.keys()];
  const exact = lines.filter((line) => PATH.lead[line] === own.place);
  if (exact.length > 0 || lines.length === 0 || !/[XYZ]/.test(own.axes)) return exact;
  const bar = barOf(own.row);
  const end = at(BARS.first, bar) + at(BARS.rows, bar);
  const near = lines.filter((line) => row(line) >= BARS.first[bar] && row(line) < end);
  if (near.length > 0) return near;
  const far = (line) => Math.abs(row(line) - own.row);
  return [lines.reduce((best, line) => (far(line) < far(best) ? line : best))];
}
