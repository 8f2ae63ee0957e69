"use strict";
(() => {
  const root = document.documentElement;
  const tools = document.querySelector(".tools");
  const output = tools.querySelector(".shown");

  // ---- Light and dark: by the system, until a reader chooses.
  const system = matchMedia("(prefers-color-scheme: dark)");
  const themeButton = tools.querySelector(".theme");
  let chosen = null;

  function showTheme() {
    root.dataset.theme = chosen ?? (system.matches ? "dark" : "light");
    themeButton.setAttribute("aria-pressed", String(root.dataset.theme === "dark"));
    document.dispatchEvent(new Event("themechange"));
  }

  themeButton.addEventListener("click", () => {
    chosen = root.dataset.theme === "dark" ? "light" : "dark";
    showTheme();
  });
  system.addEventListener("change", showTheme);

  // ---- The tests, each with what it can be found by, and the rows and entries that stand for some of them.
  const plain = (text) => text.normalize("NFD").replace(/\p{M}/gu, "").toLowerCase();
  const tests = Array.from(document.querySelectorAll("section.test"), (section) => ({
    number: section.dataset.number,
    section,
    verdicts: Array.from(section.querySelectorAll("tr[data-check]"), (row) => ({
      check: row.dataset.check, status: row.dataset.status, marginal: "marginal" in row.dataset,
      known: "known" in row.dataset, worse: "worse" in row.dataset,
    })),
  }));
  const standIns = Array.from(document.querySelectorAll("[data-of]"), (element) => ({
    element, numbers: element.dataset.of.split(" "),
  }));
  const frames = Array.from(document.querySelectorAll(".profile"));

  // Words of a test, not the data of its figures; read when the first text is looked for.
  function wordsOf(test) {
    if (test.words === undefined) {
      const parts = Array.from(test.section.querySelectorAll("h2, .title, .facts, .checks"));
      test.words = plain(parts.map((part) => part.textContent).join(" "));
    }
    return test.words;
  }

  const MEANS = {
    all: () => true,
    failed: ({ status }) => status === "fail" || status === "error",
    news: ({ status, known, worse }) => worse || status === "error" || (status === "fail" && !known),
    marginal: ({ marginal }) => marginal,
    unjudged: ({ status }) => status === "not_evaluated" || status === "error",
  };

  function isShown(test, { status, check, text }) {
    const means = MEANS[status];
    const found = check
      ? test.verdicts.some((verdict) => verdict.check === check && verdict.status !== "not_applicable" && means(verdict))
      : status === "all" || test.verdicts.some(means);
    return found && (!text || wordsOf(test).includes(plain(text)));
  }

  // What is filtered out leaves the screen, and stays on paper.
  function filter(wanted) {
    const shown = new Set();
    for (const test of tests) {
      const isIn = isShown(test, wanted);
      if (isIn) shown.add(test.number);
      test.section.classList.toggle("out", !isIn);
    }
    for (const { element, numbers } of standIns) {
      element.classList.toggle("out", !numbers.some((number) => shown.has(number)));
    }
    for (const frame of frames) frame.classList.toggle("out", !frame.querySelector("[data-of]:not(.out)"));
    const says = tools.dataset.shown.replace("{shown}", shown.size).replace("{total}", tests.length);
    if (output.textContent !== says) output.textContent = says;
  }

  // ---- The filter stands in the address behind the place: #test-3&status=failed&check=ride_through&text=VD1
  const NONE = { status: "all", check: "", text: "" };

  function read() {
    return { status: tools.elements.status.value, check: tools.elements.check.value, text: tools.elements.text.value.trim() };
  }

  function write({ status, check, text }) {
    const choices = Array.from(tools.elements.status, (choice) => choice.value);  // not all pages have all
    tools.elements.status.value = choices.includes(status) ? status : "all";
    tools.elements.check.value = check;
    if (tools.elements.check.selectedIndex < 0) tools.elements.check.value = "";
    tools.elements.text.value = text;
  }

  function parse(hash) {
    const parts = hash.replace(/^#/, "").split("&").filter(Boolean);
    const place = parts.filter((part) => !part.includes("="))[0] ?? "";
    const wanted = new URLSearchParams(parts.filter((part) => part.includes("=")).join("&"));
    return { place, wanted: wanted.size ? { ...NONE, ...Object.fromEntries(wanted) } : null };
  }

  function remember(place) {
    const wanted = Object.entries(read()).filter(([name, value]) => value !== NONE[name]);
    const hash = [place, new URLSearchParams(wanted).toString()].filter(Boolean).join("&");
    history.replaceState(null, "", hash ? `#${hash}` : location.pathname + location.search);
  }

  // A link leads to what it names, even where the filter or a fold has put it away.
  function goTo(place) {
    const target = place && document.getElementById(place);
    if (!target) return;
    if (target.closest(".out")) {
      write(NONE);
      filter(NONE);
    }
    for (let fold = target.closest("details"); fold; fold = fold.parentElement.closest("details")) fold.open = true;
    target.scrollIntoView();
  }

  function follow() {
    const { place, wanted } = parse(location.hash);
    if (wanted) {
      write(wanted);
      filter(read());
    }
    goTo(place);
    remember(place);
  }

  function change() {
    filter(read());
    remember("");
  }

  tools.addEventListener("input", change);
  tools.addEventListener("submit", (event) => event.preventDefault());
  tools.addEventListener("reset", () => setTimeout(change));
  window.addEventListener("hashchange", follow);

  // ---- Groups of runs that differ only in the point on wave.
  for (const button of document.querySelectorAll(".opens")) {
    button.hidden = false;
    button.addEventListener("click", () => {
      const isOpen = button.getAttribute("aria-expanded") !== "true";
      button.setAttribute("aria-expanded", String(isOpen));
      button.textContent = isOpen ? "−" : "+";
      for (const run of button.closest("tbody").querySelectorAll(".run")) run.hidden = !isOpen;
    });
  }

  // ---- On paper nothing stays folded; afterwards the folds are as they were.
  let unfolded = [];
  window.addEventListener("beforeprint", () => {
    unfolded = Array.from(document.querySelectorAll("details:not([open])"));
    for (const fold of unfolded) fold.open = true;
  });
  window.addEventListener("afterprint", () => {
    for (const fold of unfolded) fold.open = false;
  });

  tools.hidden = false;
  new ResizeObserver(() => {
    const sticks = getComputedStyle(tools).position === "sticky";
    root.style.setProperty("--bar", sticks ? `${tools.offsetHeight}px` : "0px");
  }).observe(tools);
  showTheme();
  filter(NONE);
  follow();
})();
