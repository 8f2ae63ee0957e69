"use strict";
(() => {
  // 180 mm, what an A4 page leaves between its margins, in CSS pixels.
  const PRINT_WIDTH = 680;
  const PRINT_HEIGHT = 930;
  // Plotly offers by default to send the chart to its maker's server.
  const CONFIG = { responsive: true, displaylogo: false, showSendToCloud: false, plotlyServerURL: "" };

  const plots = Array.from(document.querySelectorAll(".plot"));
  const drawn = new Map();

  function draw(plot) {
    if (drawn.has(plot)) return;
    const figure = JSON.parse(document.getElementById(plot.dataset.figure).textContent);
    drawn.set(plot, figure.layout.height);
    plot.replaceChildren();
    const name = plot.closest("section").dataset.test;
    const config = { ...CONFIG, toImageButtonOptions: { filename: name } };
    Plotly.newPlot(plot, figure.data, figure.layout, config);
  }

  function forPrint() {
    for (const details of document.querySelectorAll("details")) details.open = true;
    for (const plot of plots) {
      draw(plot);
      Plotly.relayout(plot, { width: PRINT_WIDTH, height: Math.min(drawn.get(plot), PRINT_HEIGHT) });
    }
  }

  function forScreen() {
    for (const [plot, height] of drawn) {
      Plotly.relayout(plot, { width: null, height, autosize: true });
    }
  }

  const seen = new IntersectionObserver((entries) => {
    for (const entry of entries) {
      if (!entry.isIntersecting) continue;
      seen.unobserve(entry.target);
      draw(entry.target);
    }
  }, { rootMargin: "400px" });
  for (const plot of plots) seen.observe(plot);

  window.addEventListener("beforeprint", forPrint);
  window.addEventListener("afterprint", forScreen);
})();
