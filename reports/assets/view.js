// The viewer: one moment of the drop in the moving picture and in all curves.
(() => {
  "use strict";
  const { curves, element } = touchdown;
  const HEIGHT = 180; // px, of a curve
  const NUDGE = 10; // frames, for a step with Shift
  const ZOOM = 0.5; // of the stretch shown, for a key
  const figure = document.querySelector("figure.motion");
  const player = touchdown.motion(figure);

  // A curve's cursor is the moment shown: uPlot itself follows no pointer.
  const deaf = Object.fromEntries(["mousedown", "mouseup", "click", "dblclick", "mousemove", "mouseleave", "mouseenter"].map((name) => [name, () => null]));
  const cursor = { y: false, bind: deaf, drag: { x: false, y: false, setScale: false } };
  document.querySelectorAll("figure.series").forEach((one) => {
    const { plot } = curves.build(one, { height: HEIGHT, cursor, begin: player.first });
    const go = (event) => player.seek(plot.posToVal(event.clientX - plot.over.getBoundingClientRect().left, "x"));
    plot.over.addEventListener("pointerdown", (event) => {
      plot.over.setPointerCapture(event.pointerId);
      go(event);
    });
    plot.over.addEventListener("pointermove", (event) => { if (event.buttons & 1) go(event); });
  });

  figure.after(player.tools);
  document.querySelector("main").append(figure.querySelector("figcaption"));
  const zooms = document.querySelector(".zooms");
  element("span", zooms, "Curves:");
  curves.tools(zooms, curves.charts[0].impact, player.moment);

  const moments = [...document.querySelectorAll(".moments button")];
  const follow = (now) => {
    const [from, to] = curves.span();
    if (now < from || to < now) { // the next stretch, as long
      const begin = now < from ? Math.max(player.first, now - 0.9 * (to - from)) : Math.max(player.first, now - 0.1 * (to - from));
      curves.show(begin, Math.min(player.last, begin + to - from));
    }
    curves.charts.forEach((chart) => chart.point(now));
    const passed = moments.findLast((one) => Number(one.dataset.time) <= now);
    moments.forEach((one) => one.setAttribute("aria-current", String(one === passed)));
  };
  figure.addEventListener("moment", ({ detail }) => follow(detail));
  moments.forEach((one) => one.addEventListener("click", () => player.seek(Number(one.dataset.time))));

  const pace = (by) => {
    const to = player.pace.selectedIndex + by;
    if (to < 0 || to >= player.pace.length) return;
    player.pace.selectedIndex = to;
    player.pace.dispatchEvent(new Event("change"));
  };
  const keys = {
    " ": player.toggle,
    ArrowLeft: ({ shiftKey }) => player.step(shiftKey ? -NUDGE : -1),
    ArrowRight: ({ shiftKey }) => player.step(shiftKey ? NUDGE : 1),
    ArrowUp: () => pace(-1),
    ArrowDown: () => pace(1),
    Home: () => player.seek(player.first),
    End: () => player.seek(player.last),
    "+": () => curves.zoom(ZOOM, player.moment()),
    "=": () => curves.zoom(ZOOM, player.moment()),
    "-": () => curves.zoom(1 / ZOOM, player.moment()),
  };
  window.addEventListener("keydown", (event) => {
    const { key, target, ctrlKey, altKey, metaKey } = event;
    const pressed = target.closest?.("button, select") && (key === " " || target.matches("select"));
    if (!keys[key] || pressed || ctrlKey || altKey || metaKey) return;
    event.preventDefault();
    keys[key](event);
  });
  follow(player.moment());
})();
