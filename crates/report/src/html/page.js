// Puts what can be zoomed, turned and played in place of a drawing when it comes near the screen. Where that fails the
// drawing stays.
(function () {
  "use strict";
  if (!window.Plotly || !window.IntersectionObserver) return;

  const coarse = window.matchMedia("(pointer: coarse)").matches;
  const still = window.matchMedia("(prefers-reduced-motion: reduce)").matches;
  const config = { responsive: true, displaylogo: false, scrollZoom: false, doubleClick: "reset",
    modeBarButtonsToRemove: ["select2d", "lasso2d", "autoScale2d"] };
  const read = (element) => JSON.parse(element.querySelector("script[type='application/json']").textContent);

  function plot(element) {
    const figure = read(element);
    figure.layout.paper_bgcolor = figure.layout.plot_bgcolor = "#fff";
    // A finger that scrolls the page must not zoom.
    figure.layout.dragmode = coarse ? false : "zoom";
    const place = document.createElement("div");
    place.style.minHeight = figure.layout.height + "px";
    element.appendChild(place);
    return window.Plotly.newPlot(place, figure.data, figure.layout, config);
  }

  function hasWebGl() {
    try {
      const context = document.createElement("canvas").getContext("webgl");
      return Boolean(context);
    } catch (error) {
      return false;
    }
  }

  // Coordinates along axis c, one array for each.
  const column = (points, c) => points.map((p) => p[c]);
  // Line segments with gaps between them.
  function polyline(points, lines, c) {
    const out = [];
    for (const [a, b] of lines) out.push(points[a][c], points[b][c], null);
    return out;
  }

  function control(label, input) {
    const element = document.createElement("label");
    element.append(label + " ", input);
    return element;
  }

  function shapes(element) {
    if (!hasWebGl()) throw new Error("no WebGL");
    const data = read(element);
    const rest = data.points;
    const span = [0, 1, 2].map((c) => {
      const values = column(rest, c);
      return [values.reduce((a, b) => Math.min(a, b)), values.reduce((a, b) => Math.max(a, b))];
    });
    const size = Math.max(...span.map(([low, high]) => high - low));

    const choice = document.createElement("select");
    data.shapes.forEach((shape, i) => choice.add(new Option(shape.name, String(i))));
    const amplitude = document.createElement("input");
    Object.assign(amplitude, { type: "range", min: "0", max: "0.25", step: "0.01", value: "0.1" });
    const button = document.createElement("button");
    button.type = "button";
    const controls = document.createElement("div");
    controls.className = "controls";
    controls.append(control("Shape", choice), control("Amplitude", amplitude), button);
    const scene = document.createElement("div");
    scene.className = "scene";
    element.append(controls, scene);

    const room = 0.25 * size;
    const axis = (title, c) => ({ title: { text: title }, range: [span[c][0] - room, span[c][1] + room],
      showbackground: false, gridcolor: "#e4e4e4", zerolinecolor: "#e4e4e4", showspikes: false, nticks: 6 });
    const axes = { xaxis: axis("x aft (m)", 0), yaxis: axis("y right (m)", 1), zaxis: axis("z up (m)", 2) };
    const length = (c) => span[c][1] - span[c][0] + 2 * room;
    // Drawn larger where the scene is wide: the frame is turned to it, not its corner.
    const scale = Math.min(1.4, Math.max(1, scene.clientWidth / scene.clientHeight)) / size;
    const ratio = { x: scale * length(0), y: scale * length(1), z: scale * length(2) };
    const layout = { margin: { l: 0, r: 0, t: 0, b: 0 }, showlegend: false, paper_bgcolor: "#fff",
      font: { family: "sans-serif", size: 11 }, uirevision: "kept",
      scene: { ...axes, aspectmode: "manual", aspectratio: ratio,
        camera: { eye: { x: -1.15, y: -1.0, z: 0.7 }, projection: { type: "orthographic" } } } };
    const [i, j, k] = [[], [], []];
    for (const [a, b, c, d] of data.faces) { i.push(a, a); j.push(b, c); k.push(c, d); }
    const line = (points, color, width) => ({ type: "scatter3d", mode: "lines", hoverinfo: "skip",
      x: polyline(points, data.lines, 0), y: polyline(points, data.lines, 1), z: polyline(points, data.lines, 2),
      line: { color, width } });
    const traces = [line(rest, data.colours.rest, 2), line(rest, data.colours.line, 6)];
    if (i.length) traces.push({ type: "mesh3d", x: column(rest, 0), y: column(rest, 1), z: column(rest, 2), i, j, k,
      color: data.colours.face, opacity: 0.55, flatshading: true, hoverinfo: "skip" });

    function moved(phase) {
      const shape = data.shapes[Number(choice.value)];
      const factor = Number(amplitude.value) * size * phase;
      return rest.map((p, n) => p.map((x, c) => x + factor * shape.displacement[n][c]));
    }
    function show(phase) {
      const points = moved(phase);
      const update = { x: [], y: [], z: [] };
      ["x", "y", "z"].forEach((name, c) => {
        update[name].push(polyline(points, data.lines, c));
        if (i.length) update[name].push(column(points, c));
      });
      return window.Plotly.restyle(scene, update, i.length ? [1, 2] : [1]);
    }

    let playing = false;
    let visible = true;
    let busy = false;
    let start = 0;
    const swing = (now) => {
      if (!playing) return;
      window.requestAnimationFrame(swing);
      if (busy || !visible || document.hidden) return;
      busy = true;
      Promise.resolve(show(Math.sin((now - start) * 2e-3 * Math.PI / 2))).finally(() => { busy = false; });
    };
    function play(on) {
      if (on && !playing) { start = performance.now(); window.requestAnimationFrame(swing); }
      playing = on;
      button.textContent = on ? "Stop" : "Play";
      if (!on) show(1);
    }
    button.addEventListener("click", () => play(!playing));
    const refresh = () => { if (!playing) show(1); };
    choice.addEventListener("change", refresh);
    amplitude.addEventListener("input", refresh);
    new IntersectionObserver((seen) => { visible = seen.some((s) => s.isIntersecting); }).observe(scene);
    return window.Plotly.newPlot(scene, traces, layout, { ...config, modeBarButtonsToRemove: ["hoverClosest3d"] })
      .then(() => play(!still));
  }

  function enliven(figure) {
    const stay = () => figure.classList.remove("alive");
    // Shown first: a plot takes the width of its place.
    figure.classList.add("alive");
    for (const element of figure.querySelectorAll(".plot, .shapes")) {
      try {
        const drawn = element.classList.contains("shapes") ? shapes(element) : plot(element);
        drawn.catch(stay);
      } catch (error) {
        stay();
      }
    }
  }

  const watcher = new IntersectionObserver((seen) => {
    for (const { target, isIntersecting } of seen) {
      if (!isIntersecting) continue;
      watcher.unobserve(target);
      enliven(target);
    }
  }, { rootMargin: "600px 0px" });
  document.querySelectorAll("figure").forEach((figure) => {
    if (figure.querySelector(".live")) watcher.observe(figure);
  });
})();
