// Curves that can be zoomed, all of them over the same stretch of time; light and dark.
(() => {
  "use strict";
  const HEIGHT = 280; // px, of a chart
  const ZOOM = 0.5; // of the stretch shown, for a press of the button
  const SHIFT = 0.25;

  const floats = (text, Kind) => {
    const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
    return new Kind(bytes.buffer);
  };

  const probe = document.body.appendChild(document.createElement("span"));
  probe.hidden = true;
  const paint = (word) => {
    probe.style.color = `var(--${word})`;
    return getComputedStyle(probe).color;
  };

  const element = (tag, parent, text = "") => {
    const made = parent.appendChild(document.createElement(tag));
    made.textContent = text;
    return made;
  };

  const button = (parent, text, label, act) => {
    const made = element("button", parent, text);
    made.type = "button";
    if (label) made.setAttribute("aria-label", label);
    made.addEventListener("click", act);
    return made;
  };

  // -- charts ----------------------------------------------------------------------------------------

  const charts = [];
  let shared = null; // [first, last] time shown, s

  const show = (from, to) => {
    shared = [from, to];
    for (const chart of charts) chart.show(from, to);
  };

  const readable = (value) => (value == null ? "–" : Number(value.toPrecision(5)).toString());

  const FONT = "12px system-ui, sans-serif";
  const axis = (label, more) => ({
    stroke: () => paint("ink"),
    grid: { stroke: () => paint("line"), width: 1 },
    ticks: { stroke: () => paint("line"), size: 4 },
    font: FONT,
    labelFont: FONT,
    labelSize: 20,
    labelGap: 0,
    gap: 4,
    label,
    ...more,
  });

  const options = (data, width, moved) => ({
    width,
    height: HEIGHT,
    legend: { live: true },
    cursor: { drag: { x: true, y: false, uni: 20 }, sync: { key: "time" }, points: { size: 5 } },
    scales: { x: { time: false } },
    axes: [
      axis("time from the shutdown [s]", { size: 34 }),
      axis(data.axis, { size: 52, values: (_, ticks) => ticks.map(readable) }),
    ],
    series: [
      { label: "time [s]", value: (_, v) => readable(v) },
      ...data.lines.map((line) => ({
        label: line.label,
        stroke: () => paint(line.colour),
        width: 1.25,
        points: { show: line.dot, size: 8, fill: () => paint(line.colour) },
        value: (_, v) => readable(v),
      })),
    ],
    hooks: {
      setScale: [(plot, key) => { if (key === "x") moved(plot); }],
      draw: [(plot) => data.events.forEach(([time, what], k) => mark(plot, time, what, (k % 3) / 3))],
    },
  });

  const mark = (plot, time, what, up) => {
    const { min, max } = plot.scales.x;
    if (time < min || max < time) return;
    const { ctx, bbox } = plot;
    const x = plot.valToPos(time, "x", true);
    ctx.save();
    ctx.fillStyle = paint("ink");
    for (let y = bbox.top; y < bbox.top + bbox.height; y += 10) ctx.fillRect(x, y, 1, 6);
    ctx.translate(x + 4, bbox.top + bbox.height * (1 - up) - 4);
    ctx.rotate(-Math.PI / 2);
    Object.assign(ctx, { textAlign: "left", textBaseline: "top" });
    ctx.fillText(what, 0, 0);
    ctx.restore();
  };

  const build = (figure) => {
    const data = JSON.parse(figure.querySelector("script").textContent);
    const holder = figure.querySelector(".chart");
    const time = Array.from(floats(data.time, Float64Array));
    const values = data.lines.map((line) => Array.from(floats(line.values, Float32Array), (v) => (Number.isNaN(v) ? null : v)));
    const first = Math.min(0, time[time.length - 1]);
    const last = time[time.length - 1];

    holder.hidden = false;
    figure.querySelector(".drawn").hidden = true;
    const tools = element("div", holder);
    tools.className = "tools";
    const now = () => shared || [first, last];
    const scaled = (factor) => () => {
      const [from, to] = now();
      const half = (0.5 * factor) * (to - from);
      show(Math.max(first, 0.5 * (from + to) - half), Math.min(last, 0.5 * (from + to) + half));
    };
    const shifted = (part) => () => {
      const [from, to] = now();
      const by = part * (to - from);
      show(from + by, to + by);
    };
    if (data.impact) button(tools, "First impact", "", () => show(...data.impact));
    button(tools, "Whole run", "", () => show(first, last));
    button(tools, "+", "Zoom in", scaled(ZOOM));
    button(tools, "−", "Zoom out", scaled(1 / ZOOM));
    button(tools, "←", "Earlier", shifted(-SHIFT));
    button(tools, "→", "Later", shifted(SHIFT));

    let quiet = false;
    const moved = (plot) => {
      if (quiet || plot.status === 0) return;
      const { min, max } = plot.scales.x;
      if (min != null && (!shared || Math.abs(min - shared[0]) + Math.abs(max - shared[1]) > 1e-12)) show(min, max);
    };
    const plot = new uPlot(options(data, holder.clientWidth, moved), [time, ...values], holder);
    plot.over.addEventListener("dblclick", () => show(first, last));
    charts.push({
      figure,
      plot,
      show: (from, to) => {
        quiet = true;
        plot.batch(() => plot.setScale("x", { min: from, max: to }));
        quiet = false;
      },
      fit: () => plot.setSize({ width: holder.clientWidth, height: HEIGHT }),
      redraw: () => plot.redraw(false),
    });
    if (first < time[0] || time[0] < first) show(first, last);
  };

  document.querySelectorAll("figure.series").forEach(build);
  window.touchdownCharts = charts; // for tests, and for whoever wants to look at the numbers

  let waiting = 0;
  window.addEventListener("resize", () => {
    cancelAnimationFrame(waiting);
    waiting = requestAnimationFrame(() => charts.forEach((chart) => chart.fit()));
  });

  // -- light and dark --------------------------------------------------------------------------------

  const root = document.documentElement;
  const theme = document.getElementById("theme");
  const dark = window.matchMedia("(prefers-color-scheme: dark)");
  let night = dark.matches;
  const light = () => {
    root.style.colorScheme = night ? "dark" : "light";
    theme.setAttribute("aria-pressed", String(night));
    charts.forEach((chart) => chart.redraw());
    window.dispatchEvent(new Event("repaint"));
  };
  theme.hidden = false;
  theme.addEventListener("click", () => { night = !night; light(); });
  dark.addEventListener("change", () => { night = dark.matches; light(); });
  theme.setAttribute("aria-pressed", String(night));

  // -- print -----------------------------------------------------------------------------------------

  const folded = [];
  window.addEventListener("beforeprint", () => {
    root.style.colorScheme = "light";
    document.querySelectorAll("details:not([open])").forEach((d) => { d.open = true; folded.push(d); });
  });
  window.addEventListener("afterprint", () => {
    folded.splice(0).forEach((d) => { d.open = false; });
    light();
  });
})();
