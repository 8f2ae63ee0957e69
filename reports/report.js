"use strict";
(() => {
  // 180 mm, what an A4 page leaves between its margins, in CSS pixels.
  const PRINT_WIDTH = 680;
  const PRINT_HEIGHT = 930;
  // Plotly offers by default to send the chart to its maker's server.
  const CONFIG = { responsive: true, displaylogo: false, showSendToCloud: false, plotlyServerURL: "" };

  const plots = Array.from(document.querySelectorAll(".plot"));
  const drawn = new Map();

  const KINDS = { u1: Uint8Array, u2: Uint16Array, u4: Uint32Array, f4: Float32Array };

  function numbers({ dtype, bdata }) {
    return new KINDS[dtype](Uint8Array.from(atob(bdata), (letter) => letter.charCodeAt(0)).buffer);
  }

  // Samples of a record stand packed in the page; of an area the way back follows the way there.
  function unpack({ packed, ...own }) {
    const trace = { type: "scatter", mode: "lines", ...own };
    if (!packed) return trace;
    const skip = numbers(packed.skip);
    const edges = ["y", "lower", "upper"].filter((name) => name in packed).map((name) => numbers(packed[name]));
    const x = [], y = [];
    let begin = 0, places = [], values = edges.map(() => []);
    function close() {
      if (x.length) { x.push(places[0]); y.push(null); }
      x.push(...places);
      y.push(...values[0]);
      if (values[1]) { x.push(...places.reverse()); y.push(...values[1].reverse()); }
      places = [];
      values = edges.map(() => []);
    }
    for (const [first, step, count, goesOn] of packed.pieces) {
      if (begin && !goesOn) close();
      let number = 0;
      for (let k = begin; k < begin + count; k++) {
        places.push(first + step * (number += skip[k]));
        values.forEach((edge, which) => edge.push(isNaN(edges[which][k]) ? null : edges[which][k]));
      }
      begin += count;
    }
    close();
    return { ...trace, x, y };
  }

  function draw(plot) {
    if (drawn.has(plot)) return;
    const figure = JSON.parse(document.getElementById(plot.dataset.figure).textContent);
    drawn.set(plot, figure.layout.height);
    plot.replaceChildren();
    const name = plot.closest("section").dataset.test;
    const config = { ...CONFIG, toImageButtonOptions: { filename: name } };
    Plotly.newPlot(plot, figure.data.map(unpack), figure.layout, config);
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
