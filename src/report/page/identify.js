// --- what was identified ---
const data = JSON.parse(document.getElementById("data").textContent);
const place = (id) => document.getElementById(id);
const round = (value, digits = 4) => (Number.isFinite(value) ? String(Number(value.toPrecision(digits))) : "–");

// The measured response and the model: the same frequencies in all lists.
function curves({ frequency_hz, coherence, gain_db, phase_deg, left_db, error_db }, model) {
  const list = (values, faded) => frequency_hz.map((hz, k) => [hz, values[k] ?? NaN, ...(faded ? [coherence[k] ?? 0] : [])]);
  const range = [frequency_hz[0], frequency_hz[frequency_hz.length - 1]];
  return [
    plot(data.response.title, [{ kind: "measured", points: list(gain_db, true) }, { kind: "model", points: list(model.gain_db) }], range, 240),
    plot("phase, degrees", [{ kind: "measured", wraps: true, points: list(phase_deg, true) }, { kind: "model", wraps: true, points: list(model.phase_deg) }], range, 180),
    plot("coherence: which share of the motion the force explains", [{ kind: "measured", points: list(coherence) }], range, 140),
    plot("measured less model by model, dB; dotted: standard error of the measurement", [{ kind: "error", points: list(error_db) }, { kind: "left", points: list(left_db, true) }], range, 180),
  ];
}

// The frequency at which all plots are read.
function readAt(plots, index) {
  const { frequency_hz } = data.response;
  const hz = frequency_hz[index];
  const [width, left, right, top, bottom] = LAID;
  const [from, to] = [frequency_hz[0], frequency_hz[frequency_hz.length - 1]].map(Math.log10);
  const x = left + (Math.log10(hz) - from) / (to - from) * (width - left - right);
  for (const { marker, height } of plots) marker.setAttribute("d", `M${x.toFixed(1)} ${top}V${height - bottom}`);
  const at = (values) => round(values[index] ?? NaN);
  const rows = [
    ["frequency, Hz", round(hz, 5), ""],
    ["gain, dB", at(data.response.gain_db), at(data.model.gain_db)],
    ["phase, degrees", at(data.response.phase_deg), at(data.model.phase_deg)],
    ["coherence", at(data.response.coherence), ""],
    ["apart, dB", at(data.response.left_db), ""],
  ];
  const cells = ([name, ...values]) => el("tr", {}, el("th", { scope: "row" }, name), ...values.map((value) => el("td", {}, value)));
  const head = el("tr", {}, ...["", "measured", "model"].map((name) => el("th", { scope: "col" }, name)));
  place("readout").replaceChildren(head, ...rows.map(cells));
}

function drawResponse() {
  const { response } = data;
  if (!response || response.frequency_hz.length < 2) {
    place("response-note").textContent = "The recording is too short for a frequency response.";
    return;
  }
  place("response-note").textContent = `${response.said} Solid: measured, fainter where it is explained less. Dashed: the model.`;
  const drawn = curves(response, data.model);
  const plots = drawn.map((svg) => {
    const height = Number(svg.getAttribute("viewBox").split(" ")[3]);
    const marker = el("path", { class: "cursor", d: "" });
    svg.append(marker);
    return { svg, marker, height };
  });
  place("response").replaceChildren(...drawn);
  const last = response.frequency_hz.length - 1;
  const slider = el("input", { type: "range", min: 0, max: last, step: 1, "aria-label": "read at frequency" });
  const set = (index) => {
    slider.value = index;
    readAt(plots, index);
  };
  slider.addEventListener("input", () => readAt(plots, Number(slider.value)));
  const [width, left, right] = LAID;
  for (const { svg } of plots) {
    svg.addEventListener("pointermove", (event) => {
      const box = svg.getBoundingClientRect();
      const share = ((event.clientX - box.left) / box.width * width - left) / (width - left - right);
      const [from, to] = [response.frequency_hz[0], response.frequency_hz[last]];
      const hz = from * (to / from) ** Math.min(1, Math.max(0, share));
      const after = response.frequency_hz.findIndex((it) => it >= hz);
      set(after < 0 ? last : after);
    });
  }
  place("cursor").replaceChildren(el("label", { class: "reader" }, "read at", slider));
  set(response.mark);
}

function drawTrace() {
  const { trace } = data;
  if (!trace) {
    place("over-time").hidden = true;
    return;
  }
  // Of each stretch of time the smallest and the largest value.
  const line = (name, kind) => ({ kind, points: trace.time_s.map((t, k) => [t, trace[name][k] ?? NaN]) });
  const range = [trace.time_s[0], trace.time_s[trace.time_s.length - 1]];
  place("trace-note").textContent = trace.said;
  place("trace").replaceChildren(
    plot(`force, ${data.unit}`, [line("force", "measured"), line("modelled", "model")], range, 260, true),
    plot(`what the model leaves, ${data.unit}`, [line("left", "left")], range, 180, true),
  );
}

document.title = `${data.recording}: ${data.word} (gwatt identify)`;
place("headline").textContent = `Axis ${data.axis}, ${data.recording}`;
place("verdict").textContent = `Verdict: ${data.verdict}`;
place("verdict").className = data.good ? "good" : "bad";
place("report").textContent = data.text;
place("notes").replaceChildren(...data.notes.map((note) => el("li", {}, note)));
drawResponse();
drawTrace();
