"use strict";
// Without this script the page is complete; it adds moving shapes, a cursor with values, and curves that can be hidden.
(function () {
  const all = (selector, root) => Array.from((root || document).querySelectorAll(selector));
  const numbers = (text) => text.trim().split(/\s+/).map(Number);

  // ---- Shapes: every moving part has its complex amplitude in page pixels as an attribute.
  const groups = all("[data-move]").map((node) => ({ node, at: numbers(node.dataset.move) }));
  const lines = all("[data-line]").map((node) => ({ node, at: numbers(node.dataset.line) }));
  let redraw = () => {};

  function animate() {
    const controls = document.querySelector(".controls.motion");
    if (!controls) return;
    const play = document.getElementById("play");
    const amplitude = document.getElementById("amplitude");
    const still = window.matchMedia("(prefers-reduced-motion: reduce)");
    const period_ms = 2400;
    let playing = false, phase = 0, last = 0;

    function draw() {
      const a = Number(amplitude.value), c = a * Math.cos(phase), s = a * Math.sin(phase);
      for (const { node, at } of groups) {
        node.setAttribute("transform", "translate(" + (at[0] * c - at[2] * s).toFixed(2) + " " +
          (at[1] * c - at[3] * s).toFixed(2) + ")");
      }
      for (const { node, at } of lines) {
        let d = "";
        for (let i = 0; i + 5 < at.length; i += 6) {
          d += (i ? "L" : "M") + (at[i] + at[i + 2] * c - at[i + 4] * s).toFixed(1) + " " +
            (at[i + 1] + at[i + 3] * c - at[i + 5] * s).toFixed(1);
        }
        node.setAttribute("d", d);
      }
    }
    function tick(now) {
      if (!playing) return;
      phase = (phase + 2 * Math.PI * Math.min(100, now - last) / period_ms) % (2 * Math.PI);
      last = now;
      draw();
      requestAnimationFrame(tick);
    }
    function set(on) {
      playing = on;
      play.textContent = on ? "Pause" : "Play";
      last = performance.now();
      if (on) requestAnimationFrame(tick);
    }
    play.addEventListener("click", () => set(!playing));
    amplitude.addEventListener("input", draw);
    still.addEventListener("change", () => { if (still.matches) set(false); });
    window.addEventListener("beforeprint", () => { set(false); phase = 0; draw(); });
    controls.hidden = false;
    redraw = draw;
    set(!still.matches);
  }

  // ---- Operating deflection shape: the components of every line are bytes of 1/127, real and imaginary part.
  function deflection() {
    const root = document.getElementById("deflection");
    if (!root) return;
    const hz = numbers(root.dataset.hz), share = numbers(root.dataset.share);
    const bytes = Int8Array.from(atob(root.dataset.shapes), (c) => c.charCodeAt(0));
    const n = bytes.length / hz.length;
    const slider = document.getElementById("line"), words = document.getElementById("line-words");
    const rows = all("table.deflection tbody tr", root);
    const parts = groups.filter(({ node }) => root.contains(node));
    const paths = lines.filter(({ node }) => root.contains(node));

    // Motion of one part: its channels' components times page pixels per unit.
    function move(part, values) {
      const via = numbers(part.node.dataset.via || ""), at = [0, 0, 0, 0];
      for (let i = 0; i + 2 < via.length; i += 3) {
        const re = values[2 * via[i]] / 127, im = values[2 * via[i] + 1] / 127;
        at[0] += re * via[i + 1];
        at[1] += re * via[i + 2];
        at[2] += im * via[i + 1];
        at[3] += im * via[i + 2];
      }
      part.at = at;
    }
    function show(k) {
      const values = bytes.subarray(k * n, (k + 1) * n);
      for (const part of parts) move(part, values);
      for (const path of paths) parts.forEach((part, i) => path.at.splice(6 * i + 2, 4, ...part.at));
      rows.forEach((row, c) => {
        const re = values[2 * c] / 127, im = values[2 * c + 1] / 127;
        row.cells[1].textContent = Math.hypot(re, im).toFixed(2);
        row.cells[2].textContent = (Math.round(Math.atan2(im, re) * 180 / Math.PI) || 0) + "°";
      });
      words.textContent = "At " + hz[k] + " Hz this shape holds " + share[k] + " % of the motion.";
      slider.setAttribute("aria-valuetext", hz[k] + " Hz");
      redraw();
    }
    slider.addEventListener("input", () => show(Number(slider.value)));
    for (const pick of all(".pick", root)) {
      pick.addEventListener("click", () => {
        slider.value = pick.dataset.lineAt;
        show(Number(slider.value));
      });
    }
    slider.closest(".controls").hidden = false;
  }

  // ---- The table as text. Where the clipboard is not allowed, the text is selected.
  function copies() {
    const button = document.getElementById("copy"), text = document.getElementById("modes-text");
    if (!button) return;
    const said = document.getElementById("copied");
    button.addEventListener("click", () => {
      getSelection().selectAllChildren(text);
      const kept = () => { said.textContent = "Selected: copy it with the keyboard or the menu."; };
      if (!navigator.clipboard) return kept();
      navigator.clipboard.writeText(text.textContent).then(() => { said.textContent = "Copied."; }, kept);
    });
    button.parentNode.hidden = false;
  }

  // Printed, folded parts would be lost.
  window.addEventListener("beforeprint", () => {
    for (const part of all("details:not([open])")) {
      part.open = true;
      part.dataset.folded = "";
    }
  });
  window.addEventListener("afterprint", () => {
    for (const part of all("details[data-folded]")) {
      part.open = false;
      delete part.dataset.folded;
    }
  });

  // ---- Curves: show and hide by the legend's keys.
  function toggles() {
    for (const key of all(".key")) {
      key.addEventListener("click", () => {
        const on = key.getAttribute("aria-pressed") !== "true";
        key.setAttribute("aria-pressed", String(on));
        for (const curve of all("path[data-k=\"" + key.dataset.k + "\"]", key.closest("figure"))) {
          curve.classList.toggle("off", !on);
        }
      });
    }
  }

  // ---- Cursor. Values are read back from the drawn curves, to a tenth of a pixel.
  const superscripts = "⁰¹²³⁴⁵⁶⁷⁸⁹";
  function rounded(value) {
    if (!isFinite(value)) return "–";
    if (value === 0 || (Math.abs(value) >= 0.01 && Math.abs(value) < 10000)) return String(Number(value.toPrecision(3)));
    const [mantissa, exponent] = value.toExponential(1).split("e");
    const digits = Array.from(String(Math.abs(Number(exponent)))).map((d) => superscripts[Number(d)]).join("");
    return mantissa + "·10" + (Number(exponent) < 0 ? "⁻" : "") + digits;
  }

  // Converts "M1 2l1-.5M5 5h0" to points; gaps are left out.
  function points_of(path) {
    const out = [];
    let x = 0, y = 0;
    for (const part of path.getAttribute("d").match(/[Mlh][^Mlh]*/g) || []) {
      const v = (part.slice(1).match(/-?(?:\d+\.?\d*|\.\d+)/g) || []).map(Number);
      if (part[0] === "h") continue;
      x = part[0] === "M" ? v[0] : x + v[0];
      y = part[0] === "M" ? v[1] : y + v[1];
      out.push([x, y]);
    }
    return out;
  }

  function nearest(list, distance) {
    let best = null, least = Infinity;
    for (const item of list) {
      const d = distance(item);
      if (d < least) { least = d; best = item; }
    }
    return [best, least];
  }

  class Cursor {
    constructor(svg, group, out) {
      const box = numbers(group.dataset.box), ax = numbers(group.dataset.x), ay = group.dataset.y.split(" ");
      Object.assign(this, { svg, group, out, left: box[0], top: box[1], right: box[2], bottom: box[3] });
      this.x_low = ax[0];
      this.x_high = ax[1];
      this.y_low = Number(ay[0]);
      this.y_high = Number(ay[1]);
      this.is_log = ay[2] === "log";
      this.x = (this.left + this.right) / 2;
      this.y = (this.top + this.bottom) / 2;
      this.line = document.createElementNS("http://www.w3.org/2000/svg", "line");
      this.line.setAttribute("class", "cursor off");
      svg.appendChild(this.line);
      svg.dataset.live = "";
      svg.setAttribute("tabindex", "0");
      const point = (event) => {
        const at = new DOMPoint(event.clientX, event.clientY).matrixTransform(svg.getScreenCTM().inverse());
        this.move(at.x, at.y);
      };
      svg.addEventListener("pointermove", point);
      svg.addEventListener("pointerdown", point);
      svg.addEventListener("keydown", (event) => this.key(event));
      svg.addEventListener("focus", () => this.move(this.x, this.y));
    }
    key(event) {
      const step = event.shiftKey ? 20 : 2;
      const by = { ArrowLeft: [-step, 0], ArrowRight: [step, 0], ArrowUp: [0, -step], ArrowDown: [0, step] }[event.key];
      if (!by) return;
      event.preventDefault();
      this.move(this.x + by[0], this.y + by[1]);
    }
    move(x, y) {
      this.x = Math.min(this.right, Math.max(this.left, x));
      this.y = Math.min(this.bottom, Math.max(this.top, y));
      const ends = { x1: this.x, x2: this.x, y1: this.top, y2: this.bottom };
      for (const name in ends) this.line.setAttribute(name, ends[name]);
      this.line.classList.remove("off");
      this.out.textContent = this[this.group.dataset.read]();
    }
    hz() { return this.x_low + (this.x_high - this.x_low) * (this.x - this.left) / (this.right - this.left); }
    value(y) {
      const share = (this.bottom - y) / (this.bottom - this.top);
      return this.is_log ? this.y_low * Math.pow(this.y_high / this.y_low, share)
        : this.y_low + (this.y_high - this.y_low) * share;
    }
    // Text of the nearest mark within a finger's reach.
    mark() {
      const width = this.right - this.left, span = this.x_high - this.x_low;
      const place = (node) => this.left + width * (Number(node.dataset.f) - this.x_low) / span;
      const [node, off] = nearest(all("[data-say]", this.group), (n) => Math.abs(place(n) - this.x));
      return node && off < 6 ? " · " + node.dataset.say : "";
    }
    curves() {
      this.paths = this.paths || all("path[data-k]", this.group)
        .map((node) => ({ node, points: points_of(node) })).sort((a, b) => a.node.dataset.k - b.node.dataset.k);
      const figure = this.svg.closest("figure"), said = [];
      for (const { node, points } of this.paths) {
        if (node.classList.contains("off")) continue;
        const [at, off] = nearest(points, (p) => Math.abs(p[0] - this.x));
        const key = figure.querySelector(".key[data-k=\"" + node.dataset.k + "\"]");
        if (at && off < 6) said.push((key ? key.textContent.trim() : "") + " " + rounded(this.value(at[1])));
      }
      const values = said.length ? " · " + said.join(" · ") + " " + this.group.dataset.unit : "";
      return this.hz().toFixed(3) + " Hz" + this.mark() + values;
    }
    marks() {
      const half = this.x_high, seen = this.hz(), could = [];
      for (let k = 0; k * half < this.y_high - 1e-9 && k < 24; ++k) {
        could.push((k % 2 ? (k + 1) * half - seen : k * half + seen).toFixed(2));
      }
      return "seen at " + seen.toFixed(2) + " Hz" + this.mark() + " · could be " + could.join(", ") + " Hz";
    }
    poles() {
      this.places = this.places || all("[data-p]", this.group).map((node) => {
        const box = node.getBBox();
        return { x: box.x + box.width / 2, y: box.y + box.height / 2, facts: numbers(node.dataset.p) };
      });
      const [pole, off] = nearest(this.places, (p) => Math.hypot(p.x - this.x, p.y - this.y));
      const at = this.hz().toFixed(3) + " Hz";
      if (!pole || off > 24) return at + this.mark();
      const [order, hz, damping, mpc, kept] = pole.facts;
      return at + " · pole of order " + order + ": " + hz + " Hz, damping " + damping + " %, MPC " + mpc +
        (kept ? ", of a mode" : "");
    }
  }

  function cursors() {
    for (const figure of all("figure")) {
      const groups = all("[data-read]", figure);
      if (!groups.length) continue;
      const out = document.createElement("p");
      out.className = "readout";
      out.setAttribute("role", "status");
      out.textContent = "Point at the plot for its values, or select it and use the arrow keys (with Shift: faster).";
      figure.insertBefore(out, figure.querySelector("figcaption"));
      for (const group of groups) new Cursor(group.ownerSVGElement, group, out);
    }
  }

  animate();
  deflection();
  copies();
  toggles();
  cursors();
})();
