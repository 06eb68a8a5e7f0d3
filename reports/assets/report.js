// The curves and the moving picture of a report.
(() => {
  "use strict";
  const { curves, motion } = touchdown;

  document.querySelectorAll("figure.series").forEach((figure) => {
    const chart = curves.build(figure);
    figure.querySelector(".drawn").hidden = true;
    curves.tools(chart.head, chart.impact);
    chart.plot.over.addEventListener("dblclick", () => curves.show(...curves.whole()));
  });
  document.querySelectorAll("figure.motion").forEach(motion);
})();
