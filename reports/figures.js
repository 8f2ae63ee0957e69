"use strict";
(() => {
  // Plotly offers by default to send the chart to its maker's server.
  const CONFIG = { responsive: true, displaylogo: false, showSendToCloud: false, plotlyServerURL: "", doubleClick: "reset" };
  const KINDS = { u1: Uint8Array, u2: Uint16Array, u4: Uint32Array };
  const GAP = 65535;
  const NO_POINTS = { type: "scatter", mode: "lines", x: [null], y: [null] };
  const FULL_PX = 680, BELOW_PX = 44, CHARACTER_PX = 6.2; // of a figure as frame.py lays it out; axis; of words
  const CLEAR_PX = 16, LEAST_OPACITY = 0.12; // of a period drawn in full, and of waves however close

  function bytesOf(id) {
    const text = atob(document.getElementById(id).textContent);
    const bytes = new Uint8Array(text.length);
    for (let k = 0; k < text.length; k++) bytes[k] = text.charCodeAt(k);
    return bytes;
  }

  function inflated(id) {
    const stream = new Blob([bytesOf(id)]).stream().pipeThrough(new DecompressionStream("deflate"));
    return new Response(stream).arrayBuffer();
  }

  let plotly = null;
  function plotlyReady() {
    plotly ??= inflated("plotly").then((code) => {
      const script = document.createElement("script");
      script.textContent = new TextDecoder().decode(code);
      document.head.append(script);
    });
    return plotly;
  }

  // packing.py says how figures are packed: JSON, then the numbers of all arrays in it.
  async function figuresIn(id) {
    const whole = await inflated(id);
    const begin = 4 + new DataView(whole).getUint32(0, true);
    const figures = JSON.parse(new TextDecoder().decode(whole.slice(4, begin)));
    return { figures, numbers: (array) => numbers(whole, begin, array) };
  }

  function numbers(whole, begin, { dtype, at, count, low, step }) {
    if (dtype !== "q2") {
      const size = KINDS[dtype].BYTES_PER_ELEMENT * count;
      return new KINDS[dtype](whole.slice(begin + at, begin + at + size));
    }
    const bytes = new Uint8Array(whole, begin + at, 2 * count);
    let level = 0;
    return Array.from({ length: count }, (_, k) => {
      level = (level + bytes[k] + 256 * bytes[count + k]) % 65536;
      return level === GAP ? null : low + step * level;
    });
  }

  function listed(values, numbers) {
    return Array.isArray(values) ? values : numbers(values);
  }

  // Samples of a record stand packed in the page; of an area the way back follows the way there.
  function unpack({ packed, ...own }, numbers) {
    const trace = own.type ? own : { type: "scatter", mode: "lines", ...own };
    if (!packed) return { ...trace, x: listed(trace.x, numbers), y: listed(trace.y, numbers) };
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
        values.forEach((edge, which) => edge.push(edges[which][k]));
      }
      begin += count;
    }
    close();
    return { ...trace, x, y };
  }

  // Colours are those of a light ground; the page's style has a variable for each, by its theme.
  const probe = document.createElement("span");
  probe.hidden = true;
  document.body.append(probe);
  let known = new Map();
  function ofTheme(colour) {
    if (!known.has(colour)) {
      probe.style.color = `var(--f${colour.slice(1)}, ${colour})`;
      known.set(colour, getComputedStyle(probe).color.match(/[\d.]+/g).slice(0, 3).map(Number));
    }
    return known.get(colour);
  }

  function themed(part) {
    if (Array.isArray(part)) return part.map(themed);
    if (part && typeof part === "object") return Object.fromEntries(Object.entries(part).map(([k, v]) => [k, themed(v)]));
    if (typeof part !== "string") return part;
    if (/^#[0-9a-fA-F]{6}$/.test(part)) return `rgb(${ofTheme(part.toLowerCase())})`;
    const clear = part.match(/^rgba\((\d+),(\d+),(\d+),([\d.]+)\)$/);
    if (!clear) return part;
    const plain = "#" + clear.slice(1, 4).map((x) => Number(x).toString(16).padStart(2, "0")).join("");
    return `rgba(${ofTheme(plain)},${clear[4]})`;
  }

  // The static picture of a figure, which is text until then.
  function picture(plot) {
    const text = plot.querySelector("noscript");
    if (!text) return;
    const still = document.createElement("div");
    still.className = "still";
    still.innerHTML = text.textContent;
    text.replaceWith(still);
  }

  // Waves may be faint, so that in the legend something else stands for them.
  function ofWave(look) {
    return look.meta ? { ...look, showlegend: false } : look;
  }
  function forLegend({ meta, opacity, ...look }) {
    return { ...look, legendrank: 999, hoverinfo: "skip" };
  }

  // The figures of one test: those over time show the same part of it, those not drawn yet, too.
  class Figures {
    constructor(box) {
      this.box = box;
      this.plots = Array.from(box.querySelectorAll(".plot"));
      this.drawn = new Map(); // by its plot, what plotly draws in
      this.asked = new Set();
      this.span = null;
      for (const unseen of box.querySelectorAll(".zooms, .on-screen")) unseen.hidden = false;
      for (const button of box.querySelectorAll(".zooms button")) {
        button.addEventListener("click", () => this.zoom([Number(button.dataset.begin), Number(button.dataset.end)]));
      }
    }

    async draw(plot) {
      if (this.asked.has(plot)) return;
      this.asked.add(plot);
      this.data ??= figuresIn(this.box.dataset.figures);
      const [{ figures, numbers }] = await Promise.all([this.data, plotlyReady()]);
      const { data, layout } = figures[this.plots.indexOf(plot)];
      const looks = data.map(({ packed, x, y, ...look }) => look);
      const named = looks.filter((look) => look.meta && look.showlegend).map(forLegend);
      const live = document.createElement("div");
      live.className = "live";
      live.given = { looks: [...looks.map(ofWave), ...named], layout };
      live.overTime = plot.dataset.over === "time";
      plot.append(live);
      const config = { ...CONFIG, toImageButtonOptions: { filename: this.box.dataset.name } };
      const points = [...data.map((trace) => unpack(trace, numbers)), ...named.map(() => NO_POINTS)];
      const traces = points.map((trace, k) => ({ ...trace, ...themed(live.given.looks[k]) }));
      plot.classList.add("drawn");
      await Plotly.newPlot(live, traces, this.within(live), config);
      this.drawn.set(plot, live);
      await this.fit(live);
      await this.clear(live);
      if (live.overTime) live.on("plotly_relayout", (change) => this.follow(change));
    }

    // Its layout in the colours of the theme, and with the part of the time that all show.
    within(live) {
      const layout = themed(live.given.layout);
      if (this.span && live.overTime) layout.xaxis.range = [...this.span];
      return layout;
    }

    repaint() {
      for (const live of this.drawn.values()) {
        const traces = live.data.map((trace, k) => ({ ...trace, ...themed(live.given.looks[k]) }));
        Plotly.react(live, traces, this.within(live)).then(() => this.fit(live)).then(() => this.clear(live));
      }
    }

    // On a phone a legend has more rows than the layout has room for, and words would leave the figure.
    async fit(live) {
      const { _size: size, legend, xaxis, annotations = [] } = live._fullLayout;
      if (live.clientWidth >= FULL_PX) return;
      const least = -size.l, most = live.clientWidth - size.l;
      const moved = annotations.map((words, k) => {
        const at = xaxis.d2p(words.x), length = CHARACTER_PX * words.text.length;
        const begin = at - { left: 0, center: 0.5, right: 1 }[words.xanchor] * length;
        const shift = Math.max(Math.min(begin, most - length), least) - begin;
        return { ...live.layout.annotations[k], ...(words.showarrow ? { ax: shift } : { xshift: shift }) };
      });
      const below = BELOW_PX + (legend._height ?? 0);
      const given = live.given.layout;
      await Plotly.relayout(live, {
        annotations: moved,
        "margin.b": Math.max(below, given.margin.b),
        height: given.height + Math.max(below - given.margin.b, 0),
      });
    }

    // Waves (`meta` is their period) that are close are faint, else their lines would cover everything.
    async clear(live) {
      const waves = live.data.flatMap((trace, k) => (trace.meta ? [k] : []));
      if (!waves.length || !live.overTime) return;
      const [from, to] = live.layout.xaxis.range, pixels = live._fullLayout.xaxis._length / (to - from);
      const opacity = waves.map((k) => {
        const usual = live.given.looks[k].opacity ?? 1;
        return usual * Math.min(1, Math.max(LEAST_OPACITY, (live.data[k].meta * pixels) / CLEAR_PX));
      });
      if (opacity.some((value, n) => value !== live.data[waves[n]].opacity)) await Plotly.restyle(live, { opacity }, waves);
    }

    follow(change) {
      const from = change["xaxis.range[0]"] ?? change["xaxis.range"]?.[0];
      const to = change["xaxis.range[1]"] ?? change["xaxis.range"]?.[1];
      if (from !== undefined && to !== undefined) this.zoom([from, to]);
    }

    // What is told of a change of the range that is the one already leads to no other.
    zoom(span) {
      if (this.span && this.span[0] === span[0] && this.span[1] === span[1]) return;
      this.span = span;
      for (const live of this.drawn.values()) {
        if (!live.overTime) continue;
        const [from, to] = live.layout.xaxis.range;
        const moved = from !== span[0] || to !== span[1];
        Promise.resolve(moved && Plotly.relayout(live, { "xaxis.range": [...span] })).then(() => this.clear(live));
      }
    }
  }

  const owners = new Map();
  for (const box of document.querySelectorAll(".figures")) {
    const figures = new Figures(box);
    for (const plot of figures.plots) owners.set(plot, figures);
  }

  const seen = new IntersectionObserver((entries) => {
    for (const entry of entries) {
      if (!entry.isIntersecting) continue;
      seen.unobserve(entry.target);
      picture(entry.target);
      owners.get(entry.target).draw(entry.target);
    }
  }, { rootMargin: "400px" });
  for (const plot of owners.keys()) seen.observe(plot);

  window.addEventListener("beforeprint", () => {
    for (const plot of owners.keys()) picture(plot);
  });

  document.addEventListener("themechange", () => {
    known = new Map();
    for (const figures of new Set(owners.values())) figures.repaint();
  });
})();
