// Every plot of the page: axes, lines, marks and a cursor on a canvas that keeps the screen's own pixels.

export const kColours = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#b37700", "#56b4e9", "#5c5c5c"];
const kDashes = [[], [7, 4], [2, 3], [9, 3, 2, 3]];

// So that no two of 28 curves look alike, colours seen or not.
export function curveStyle(i) {
  return { colour: kColours[i % kColours.length], dash: kDashes[Math.floor(i / kColours.length) % kDashes.length] };
}

export const kVerdicts = {
  "structural": { colour: "#0072b2", shape: "disc", say: "mode of the structure" },
  "harmonic": { colour: "#d55e00", shape: "cross", say: "harmonic: rotor, machine" },
  "camera motion": { colour: "#cc79a7", shape: "diamond", say: "camera motion" },
  "input peak": { colour: "#b37700", shape: "triangle", say: "peak of the input" },
  "ambiguous": { colour: "#009e73", shape: "square", say: "ambiguous" },
  "candidate": { colour: "#56b4e9", shape: "square", say: "candidate: record too short for a verdict" },
  "numerical": { colour: "#777777", shape: "dot", say: "numerical" },
};
export const verdictStyle = (name) => kVerdicts[name] || kVerdicts.numerical;

export function cssColour(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}

// The canvas's context, in CSS pixels.
export function fitted(canvas, width = canvas.clientWidth, height = canvas.clientHeight) {
  const ratio = Math.min(3, window.devicePixelRatio || 1);
  const w = Math.max(1, Math.round(width * ratio)), h = Math.max(1, Math.round(height * ratio));
  if (canvas.width !== w) canvas.width = w;
  if (canvas.height !== h) canvas.height = h;
  const context = canvas.getContext("2d");
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  context.clearRect(0, 0, width, height);
  return context;
}

export function drawMark(c, x, y, shape, colour, r = 5) {
  c.save();
  c.setLineDash([]);
  c.fillStyle = c.strokeStyle = colour;
  c.lineWidth = 2.2;
  c.beginPath();
  if (shape === "disc") c.arc(x, y, r, 0, 7);
  else if (shape === "dot") c.arc(x, y, r * 0.45, 0, 7);
  else if (shape === "square") c.rect(x - r * 0.85, y - r * 0.85, r * 1.7, r * 1.7);
  else if (shape === "diamond") { c.moveTo(x, y - r * 1.2); c.lineTo(x + r, y); c.lineTo(x, y + r * 1.2); c.lineTo(x - r, y); c.closePath(); }
  else if (shape === "triangle") { c.moveTo(x, y - r); c.lineTo(x + r, y + r * 0.8); c.lineTo(x - r, y + r * 0.8); c.closePath(); }
  else { c.moveTo(x - r, y - r); c.lineTo(x + r, y + r); c.moveTo(x + r, y - r); c.lineTo(x - r, y + r); c.stroke(); c.restore(); return; }
  if (shape === "square" || shape === "triangle") c.stroke(); else c.fill();
  c.restore();
}

// At most `most` round numbers within [low, high].
export function ticks(low, high, most) {
  const span = high - low;
  if (!(span > 0) || !isFinite(span)) return [];
  const raw = span / Math.max(1, most), unit = Math.pow(10, Math.floor(Math.log10(raw)));
  const step = [1, 2, 5, 10].map((m) => m * unit).find((s) => s >= raw * 0.999);
  const out = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * span && out.length < 50; ++k) out.push(k * step);
  return out;
}

const superscripts = "⁰¹²³⁴⁵⁶⁷⁸⁹";
const raised = (n) => (n < 0 ? "⁻" : "") + Array.from(String(Math.abs(n))).map((d) => superscripts[Number(d)]).join("");
export const plain = (v) => String(Number(v.toPrecision(6)));

export class Plot {
  // options: {x: "Hz", log: y holds log10 values, left: room for labels}
  constructor(canvas, options = {}) {
    this.canvas = canvas;
    this.options = options;
    this.cursor = null;  // share of the plot's width
  }
  // Clears and draws the axes.
  begin(x, y) {
    const width = this.canvas.clientWidth, height = this.canvas.clientHeight;
    this.c = fitted(this.canvas, width, height);
    this.left = this.options.left ?? 52, this.top = this.options.top ?? 20;
    this.right = Math.max(this.left + 10, width - 10), this.bottom = Math.max(this.top + 10, height - 38);
    [this.x_low, this.x_high] = x;
    [this.y_low, this.y_high] = y;
    const c = this.c;
    c.font = "14px system-ui,sans-serif";
    c.lineWidth = 1;
    c.strokeStyle = cssColour("--grid");
    c.fillStyle = cssColour("--quiet");
    c.textAlign = "center";
    for (const v of ticks(x[0], x[1], (this.right - this.left) / 70)) {
      this.segment(this.x(v), this.top, this.x(v), this.bottom);
      c.fillText(plain(v), this.x(v), this.bottom + 17);
    }
    c.textAlign = "right";
    const yTicks = this.options.log ? this.decades(y) : ticks(y[0], y[1], (this.bottom - this.top) / 45);
    for (const v of this.options.noY ? [] : yTicks) {
      this.segment(this.left, this.y(v), this.right, this.y(v));
      c.fillText(this.options.log ? "10" + raised(v) : plain(v), this.left - 6, this.y(v) + 5);
    }
    c.textAlign = "right";
    if (this.options.x) c.fillText(this.options.x, this.right, this.bottom + 34);
    c.textAlign = "left";
    if (this.options.y) c.fillText(this.options.y, 2, this.bottom + 34);
    c.strokeStyle = cssColour("--quiet");
    c.strokeRect(this.left, this.top, this.right - this.left, this.bottom - this.top);
    return c;
  }
  decades([low, high]) {
    const step = Math.max(1, Math.ceil((high - low) / 6)), out = [];
    for (let v = Math.ceil(low / step) * step; v <= high; v += step) out.push(v);
    return out;
  }
  x(v) { return this.left + (this.right - this.left) * (v - this.x_low) / (this.x_high - this.x_low); }
  y(v) { return this.bottom - (this.bottom - this.top) * (v - this.y_low) / (this.y_high - this.y_low); }
  hzAt(px) { return this.x_low + (this.x_high - this.x_low) * (px - this.left) / (this.right - this.left); }
  segment(x1, y1, x2, y2) { this.c.beginPath(); this.c.moveTo(x1, y1); this.c.lineTo(x2, y2); this.c.stroke(); }
  clipped(draw) {
    this.c.save();
    this.c.beginPath();
    this.c.rect(this.left, this.top, this.right - this.left, this.bottom - this.top);
    this.c.clip();
    draw();
    this.c.restore();
  }
  // place(i) gives [x, y] of n places in units of the axes; where y is no number the line is broken.
  line(n, place, style, width = 2) {
    const c = this.c;
    this.clipped(() => {
      c.strokeStyle = style.colour;
      c.setLineDash(style.dash || []);
      c.lineWidth = width;
      c.lineJoin = "round";
      c.beginPath();
      let isDown = false;
      for (let i = 0; i < n; ++i) {
        const [x, y] = place(i);
        if (!Number.isFinite(y)) { isDown = false; continue; }
        if (isDown) c.lineTo(this.x(x), this.y(y)); else c.moveTo(this.x(x), this.y(y));
        isDown = true;
      }
      c.stroke();
    });
  }
  upright(x, style, dash = [], width = 1.5) {
    this.c.strokeStyle = style.colour;
    this.c.lineWidth = width;
    this.c.setLineDash(dash);
    this.segment(this.x(x), this.top, this.x(x), this.bottom);
    this.c.setLineDash([]);
  }
  mark(x, y, style, r) {
    if (Number.isFinite(x) && Number.isFinite(y)) drawMark(this.c, this.x(x), this.y(y), style.shape, style.colour, r);
  }
  drawCursor() {
    if (this.cursor === null) return null;
    const px = this.left + this.cursor * (this.right - this.left);
    this.c.strokeStyle = cssColour("--text");
    this.c.lineWidth = 1;
    this.segment(px, this.top, px, this.bottom);
    return this.hzAt(px);
  }
  // Pointer and arrow keys move the cursor; `redraw` follows.
  follow(redraw) {
    const to = (share) => { this.cursor = Math.min(1, Math.max(0, share)); redraw(); };
    const point = (event) => to((event.offsetX - this.left) / (this.right - this.left));
    this.canvas.addEventListener("pointermove", point);
    this.canvas.addEventListener("pointerdown", point);
    this.canvas.addEventListener("keydown", (event) => {
      const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
      if (!step) return;
      event.preventDefault();
      to((this.cursor ?? 0.5) + step * (event.shiftKey ? 0.05 : 0.004));
    });
  }
}
