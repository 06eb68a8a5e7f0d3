// Curves that can be zoomed, all of them over the same stretch of time.
touchdown.curves = (() => {
  "use strict";
  const { element, button, paint, floats, readData } = touchdown;
  const HEIGHT = 280; // px, of a chart
  const ZOOM = 0.5; // of the stretch shown, for a press of the button
  const SHIFT = 0.25;
  const ZERO = 1e-15; // what is shown as 0
  const FONT = "12px system-ui, sans-serif";

  const charts = [];
  let whole = null; // [first, last] time of all, s
  let shared = null; // likewise of what is shown

  const show = (from, to) => {
    shared = [from, to];
    for (const chart of charts) chart.show(from, to);
  };

  const span = () => shared || whole;

  const zoom = (factor, about = 0.5 * (span()[0] + span()[1])) => {
    const [from, to] = span();
    const begin = Math.max(whole[0], about - factor * (about - from));
    show(begin, Math.min(whole[1], Math.max(begin, about + factor * (to - about))));
  };

  const shift = (part) => {
    const [from, to] = span();
    const by = part * (to - from);
    show(from + by, to + by);
  };

  // Buttons that zoom all curves, about the moment that `about` returns, or the middle.
  const tools = (parent, impact, about = () => undefined) => {
    if (impact) button(parent, "First impact", "", () => show(...impact));
    button(parent, "Whole run", "", () => show(...whole));
    button(parent, "+", "Zoom in", () => zoom(ZOOM, about()));
    button(parent, "−", "Zoom out", () => zoom(1 / ZOOM, about()));
    button(parent, "←", "Earlier", () => shift(-SHIFT));
    button(parent, "→", "Later", () => shift(SHIFT));
  };

  const readable = (value) => (value == null ? "–" : Number((Math.abs(value) < ZERO ? 0 : value).toPrecision(5)).toString());

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

  const options = (data, size, cursor, hooks) => ({
    ...size,
    legend: { live: true, markers: { stroke: (_, k) => (k ? `var(--${data.lines[k - 1].colour})` : "") } },
    cursor: { points: { size: 5 }, ...cursor },
    scales: { x: { time: false } },
    axes: [
      axis("time from the shutdown [s]", { size: 34 }),
      axis(data.axis, { size: 52, values: (_, ticks) => ticks.map(readable) }),
    ],
    series: [
      { label: "time [s]", value: (_, v) => readable(v) },
      ...data.lines.map((line) => ({
        label: line.label,
        class: line.dot ? "dot" : null,
        stroke: () => paint(line.colour),
        alpha: line.dot ? 1 : 0.7,  // what lies behind dense swings shows
        width: 1.25,
        points: { show: line.dot, size: 8, fill: () => paint(line.colour) },
        value: (_, v) => readable(v),
      })),
    ],
    hooks,
  });

  // By pointing: a value is read, a drag zooms, a double click shows all.
  const POINTED = { drag: { x: true, y: false, uni: 20 }, sync: { key: "time" } };

  const build = (figure, { height = HEIGHT, cursor = POINTED, begin = 0 } = {}) => {
    const data = readData(figure);
    const holder = figure.querySelector(".chart");
    const time = Array.from(floats(data.time, Float64Array));
    const values = data.lines.map((line) => Array.from(floats(line.values), (v) => (Number.isNaN(v) ? null : v)));
    const last = time[time.length - 1];
    whole = [Math.min(begin, last), last];
    holder.hidden = false;

    let quiet = false;
    const moved = (plot, key) => {
      if (key !== "x" || quiet || plot.status === 0) return;
      const { min, max } = plot.scales.x;
      if (min != null && (!shared || Math.abs(min - shared[0]) + Math.abs(max - shared[1]) > 1e-12)) show(min, max);
    };
    let moment = null; // s, where the cursor is put
    const point = (plot) => {
      if (moment !== null) plot.setCursor({ left: plot.valToPos(moment, "x"), top: 0 });
    };
    const marks = (plot) => data.events.forEach(([when, what], k) => mark(plot, when, what, (k % 3) / 3));
    const hooks = { setScale: [moved], draw: [marks, point] };
    const head = element("div", holder);
    head.className = "tools";
    const plot = new uPlot(options(data, { width: holder.clientWidth, height }, cursor, hooks), [time, ...values], holder);
    const chart = {
      figure,
      plot,
      head,
      impact: data.impact,
      show: (from, to) => {
        quiet = true;
        plot.batch(() => plot.setScale("x", { min: from, max: to }));
        quiet = false;
      },
      point: (when) => { moment = when; point(plot); },
    };
    new ResizeObserver(() => plot.setSize({ width: holder.clientWidth, height })).observe(holder);
    charts.push(chart);
    if (whole[0] < time[0] || time[0] < whole[0]) show(...whole);
    return chart;
  };

  window.addEventListener("repaint", () => charts.forEach(({ plot }) => plot.redraw(false)));

  return { charts, build, tools, show, span, zoom, whole: () => whole };
})();
