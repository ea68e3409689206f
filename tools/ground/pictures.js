// The pictures: camera, displacements, spectra, stabilisation, and a card for each mode.
import { Plot, cssColour, curveStyle, drawMark, fitted, kVerdicts, plain, verdictStyle } from "./plot.js";
import { hoverAdvice } from "./state.js";

const kTraces_s = 30;
const byId = (id) => document.getElementById(id);
const text = (node, value) => { if (node.textContent !== value) node.textContent = value; };
export const fixed = (value, digits = 3) => (value === null || value === undefined ? "–" : String(Number(value.toPrecision(digits))));

const kRegionStyles = {
  measuring: { colour: "#56b4e9", dash: [] },
  searching: { colour: "#ffb000", dash: [8, 5] },
  lost: { colour: "#ff7043", dash: [2, 5] },
};

// ---- Camera.
export class CameraView {
  constructor() {
    this.canvas = byId("camera");
    this.image = new Image();
    this.image.decoding = "async";
    this.image.addEventListener("load", () => { this.shown = this.asked; this.wanted(); });
    this.asked = this.shown = null;
    this.wanted = () => {};
  }
  // Pictures are asked for one at a time.
  load(preview) {
    if (!preview.has_jpeg || this.asked === preview.n) return;
    if (this.asked !== this.shown && !this.image.complete) return;
    this.asked = preview.n;
    this.image.src = "preview.jpg?n=" + preview.n;
  }
  draw(state) {
    const p = state.preview, health = state.health;
    if (!p) return;
    const [w, h] = p.image;
    if (!(w > 0 && h > 0)) return;
    this.canvas.style.aspectRatio = w + "/" + h;
    const width = this.canvas.clientWidth, c = fitted(this.canvas, width, width * h / w), s = width / w;
    if (this.shown !== null && this.image.naturalWidth) c.drawImage(this.image, 0, 0, p.size[0] * p.scale * s, p.size[1] * p.scale * s);
    c.lineWidth = 3;
    c.font = "600 15px system-ui,sans-serif";
    p.regions.forEach((region, r) => this.region(c, s, region, health && health.regions[r]));
    for (let i = 0; i < p.points.u.length; ++i) {
      if (p.points.u[i] === null) continue;
      const x = (p.points.u[i] + 0.5) * s, y = (p.points.v[i] + 0.5) * s;
      if (p.points.inlier[i]) {
        c.fillStyle = "#000";
        c.fillRect(x - 2.5, y - 2.5, 5, 5);
        c.fillStyle = "#f0e442";
        c.fillRect(x - 1.5, y - 1.5, 3, 3);
      } else {
        drawMark(c, x, y, "cross", "#d55e00", 4);
      }
    }
    const seen = p.points.u.filter((u) => u !== null).length, good = p.points.inlier.filter((q) => q).length;
    text(byId("camera-note"), "Frame " + p.frame + " at " + plain(p.t_s) + " s. Yellow squares: " + good + " points that agree; orange crosses: " +
      (seen - good) + " that do not; " + (p.points.u.length - seen) + " not seen.");
    this.canvas.setAttribute("aria-label", "Camera picture with " + p.regions.length + " regions and " + seen + " points");
  }
  region(c, s, region, status) {
    const state = status ? status.state : "measuring", style = kRegionStyles[state] || kRegionStyles.lost;
    const [u, v, w, h] = region.rect.map((x) => x * s);
    c.setLineDash([]);
    c.strokeStyle = "rgba(0,0,0,.7)";
    c.lineWidth = 5;
    c.strokeRect(u, v, w, h);
    c.strokeStyle = style.colour;
    c.lineWidth = 2.5;
    c.setLineDash(style.dash);
    c.strokeRect(u, v, w, h);
    c.setLineDash([]);
    const name = (status ? status.name : "") + (state === "measuring" ? "" : ": " + state);
    if (!name) return;
    const wide = c.measureText(name).width + 10, isFlat = h < 30 && u + w + 4 + wide < c.canvas.clientWidth;  // beside a flat one: its neighbours are near
    const x = isFlat ? u + w + 4 : Math.max(0, Math.min(u, c.canvas.clientWidth - wide)), y = isFlat ? v + h / 2 - 10 : v > 22 ? v - 22 : v + h;
    c.fillStyle = "rgba(0,0,0,.75)";
    c.fillRect(x, y, wide, 21);
    c.fillStyle = style.colour;
    c.textAlign = "left";
    c.fillText(name, x + 5, y + 16);
  }
}

// ---- Displacements: one lane a channel, all to one scale.
export class TracesView {
  constructor(redraw) {
    this.isRelative = false;
    byId("relative").addEventListener("click", () => {
      this.isRelative = !this.isRelative;
      byId("relative").setAttribute("aria-pressed", String(this.isRelative));
      redraw();
    });
    this.plot = new Plot(byId("traces"), { x: "s before now", noY: true, left: 20, top: 6 });
  }
  draw(state) {
    const t = state.traces, n = t.rings.length, length = t.time.length;
    if (!n || !t.n) return;
    const end = t.time[(t.n - 1) % length], first = Math.max(0, t.n - length);
    let begin = t.n - 1;
    while (begin > first && t.time[(begin - 1) % length] >= end - kTraces_s && t.time[(begin - 1) % length] <= end) --begin;
    const channels = state.health ? state.health.channels : [], base = channels.findIndex((ch) => ch.base);
    byId("traces-keys").hidden = base < 0;
    const rest = this.isRelative && base >= 0 && base < n ? t.rings[base] : null;
    const value = (ch, at) => t.rings[ch][at] - (rest && ch !== base ? rest[at] : 0);
    const middles = [], halves = [];
    for (let ch = 0; ch < n; ++ch) {
      let low = Infinity, high = -Infinity;
      for (let i = begin; i < t.n; ++i) {
        const v = value(ch, i % length);
        if (v < low) low = v;
        if (v > high) high = v;
      }
      middles.push(high >= low ? (low + high) / 2 : 0);
      halves.push(high >= low ? (high - low) / 2 : 0);
    }
    const measured = rest ? halves.filter((_, ch) => ch !== base) : halves;
    const half = Math.max(1e-6, ...measured) * 1.15;
    const c = this.plot.begin([-kTraces_s, 0], [0, n]);
    for (let ch = 0; ch < n; ++ch) {
      const lane = n - 1 - ch + 0.5;
      this.plot.line(t.n - begin, (k) => {
        const at = (begin + k) % length;
        return [t.time[at] - end, lane + 0.5 * (value(ch, at) - middles[ch]) / half];
      }, { colour: curveStyle(ch).colour }, 1.6);
      const y = this.plot.y(lane + 0.5) + 15;
      c.font = "600 14px system-ui,sans-serif";
      c.textAlign = "left";
      const label = t.names[ch] + (rest && ch !== base ? " less the base" : ""), wide = c.measureText(label).width;
      c.fillStyle = cssColour("--panel");
      c.globalAlpha = 0.8;
      c.fillRect(this.plot.left + 3, y - 13, wide + 6, 17);
      c.globalAlpha = 1;
      c.fillStyle = curveStyle(ch).colour;
      c.fillText(label, this.plot.left + 6, y);
    }
    text(byId("traces-unit"), "last " + kTraces_s + " s; a lane is " + fixed(2 * half, 2) + " mm high");
    this.plot.canvas.setAttribute("aria-label", "Displacements of " + n + " channels over the last " + kTraces_s + " s; the largest moves " + fixed(2 * Math.max(...halves), 2) + " mm");
  }
}

// ---- Spectra.
export class SpectraView {
  constructor(redraw) {
    this.plot = new Plot(byId("spectra"), { x: "Hz", log: true, top: 40 });
    this.plot.follow(redraw);
    this.hidden = new Set();
    this.redraw = redraw;
  }
  keys(channels) {
    const names = channels.map((ch) => ch.name).join("\n");
    if (names === this.names) return;
    this.names = names;
    byId("spectra-keys").replaceChildren(...channels.map((ch, i) => {
      const key = document.createElement("button"), line = document.createElement("canvas");
      key.type = "button";
      const c = fitted(line, 26, 12), style = curveStyle(i);
      line.style.width = "26px";
      line.style.height = "12px";
      c.strokeStyle = style.colour;
      c.lineWidth = 3;
      c.setLineDash(style.dash);
      c.beginPath();
      c.moveTo(0, 6);
      c.lineTo(26, 6);
      c.stroke();
      key.append(line, ch.name);
      key.setAttribute("aria-pressed", String(!this.hidden.has(ch.name)));
      key.addEventListener("click", () => {
        if (!this.hidden.delete(ch.name)) this.hidden.add(ch.name);
        key.setAttribute("aria-pressed", String(!this.hidden.has(ch.name)));
        this.redraw();
      });
      return key;
    }));
  }
  draw(state) {
    const s = state.spectra;
    if (!s || !s.channels.length) return;
    this.keys(s.channels);
    const shown = s.channels.map((ch, i) => ({ ch, i })).filter(({ ch }) => !this.hidden.has(ch.name));
    const all = shown.flatMap(({ ch }) => ch.log10.slice(1)).filter((v) => v !== null).sort((a, b) => a - b);
    const high = all.length ? all[all.length - 1] + 0.3 : 0, low = all.length ? Math.max(all[Math.floor(all.length / 100)] - 0.3, high - 8) : -1;
    const c = this.plot.begin([0, s.rate_hz / 2], [low, high]);
    for (const { ch, i } of shown) {
      this.plot.line(ch.log10.length, (k) => [s.first_hz + k * s.step_hz, ch.log10[k] === null ? NaN : ch.log10[k]], curveStyle(i), 1.8);
    }
    const marked = state.modes ? state.modes.modes.filter((m) => m.apparent_hz !== null && m.verdict !== "numerical") : [];
    this.marks(c, marked);
    this.say(s, shown, marked);
    this.others(marked.filter((m) => !m.structural).slice(0, 8));
    this.plot.canvas.setAttribute("aria-label", "Spectra of " + s.channels.length + " channels with " + marked.filter((m) => m.structural).length + " modes marked");
  }
  // What is no mode of the structure, with the reason.
  others(peaks) {
    const words = peaks.map((m) => verdictStyle(m.verdict).say + " at " + fixed(m.hz, 4) + " Hz: " + m.reason);
    const list = byId("others");
    if (list.dataset.words === words.join("\n")) return;
    list.dataset.words = words.join("\n");
    list.replaceChildren(...peaks.map((m, i) => {
      const item = document.createElement("li"), mark = document.createElement("canvas"), style = verdictStyle(m.verdict);
      mark.style.width = mark.style.height = "16px";
      drawMark(fitted(mark, 16, 16), 8, 8, style.shape, style.colour, 5);
      item.append(mark, words[i]);
      return item;
    }));
  }
  marks(c, marked) {
    let free = [-1e9, -1e9];
    c.textAlign = "center";
    for (const m of [...marked].sort((a, b) => a.apparent_hz - b.apparent_hz)) {
      const style = verdictStyle(m.verdict), x = this.plot.x(m.apparent_hz);
      this.plot.upright(m.apparent_hz, style, m.structural ? [] : [3, 4]);
      drawMark(c, x, this.plot.top - 7, style.shape, style.colour, 5);
      if (!m.structural) continue;
      c.font = "600 13px system-ui,sans-serif";
      const label = fixed(m.hz, 4), half = c.measureText(label).width / 2 + 3;
      if (x - half < free[0]) continue;
      free = [x + half];
      c.fillStyle = style.colour;
      c.fillText(label, x, this.plot.top - 20);
    }
  }
  say(s, shown, marked) {
    const hz = this.plot.drawCursor();
    if (hz === null) return;
    const k = Math.max(0, Math.round((hz - s.first_hz) / s.step_hz)), reach = (this.plot.x_high - this.plot.x_low) / 80;
    const near = marked.filter((m) => Math.abs(m.apparent_hz - hz) < reach).sort((a, b) => Math.abs(a.apparent_hz - hz) - Math.abs(b.apparent_hz - hz))[0];
    const values = shown.slice(0, 6).map(({ ch }) => ch.name + " " + (ch.log10[k] === null || ch.log10[k] === undefined ? "–" : Math.pow(10, ch.log10[k]).toExponential(1)));
    text(byId("spectra-readout"), hz.toFixed(3) + " Hz" + (near ? " · " + verdictStyle(near.verdict).say + " at " + fixed(near.hz, 5) + " Hz: " + near.reason : "") +
      " · " + values.join(" · ") + " mm²/Hz");
  }
}

// ---- Stabilisation: what each estimate found.
export class StableView {
  constructor(redraw) {
    this.plot = new Plot(byId("stable"), { x: "Hz", y: "s of record" });
    this.plot.follow(redraw);
    byId("verdicts").replaceChildren(...Object.values(kVerdicts).map((style) => {
      const item = document.createElement("li"), mark = document.createElement("canvas");
      mark.style.width = mark.style.height = "16px";
      drawMark(fitted(mark, 16, 16), 8, 8, style.shape, style.colour, 5);
      item.append(mark, style.say);
      return item;
    }));
  }
  draw(state) {
    const all = state.estimates;
    if (!all.length) return;
    let high = 0;
    for (const e of all) state.forEachPole(e, (hz) => { if (hz > high) high = hz; });
    const last = all[all.length - 1].duration_s, begin = all[0].duration_s, pad = Math.max(1, (last - begin) * 0.05);
    this.plot.begin([0, high > 0 ? high * 1.05 : 1], [begin - pad, last + pad]);
    const r = all.length > 60 ? 3 : 4.5;
    this.plot.clipped(() => {
      for (const isFinal of [false, true]) {
        for (const e of all) {
          state.forEachPole(e, (hz, verdict) => {
            if ((verdict === "structural") === isFinal) this.plot.mark(hz, e.duration_s, verdictStyle(verdict), r);
          });
        }
      }
    });
    const hz = this.plot.drawCursor();
    if (hz !== null) text(byId("stable-readout"), hz.toFixed(3) + " Hz");
    this.plot.canvas.setAttribute("aria-label", all.length + " estimates over " + Math.round(last) + " s of record");
  }
}

// ---- Cards.
const kSwing_px = 20;

export class ModeCards {
  constructor() { this.cards = []; }
  update(state) {
    const modes = state.modes ? state.modes.modes.filter((m) => m.structural).slice(0, 12) : [];
    if (state.modes) {
      const e = state.modes;
      text(byId("modes-note"), (e.status === "ok" ? "" : e.status + ". ") + "Estimate " + (e.number + 1) + " from " + Math.round(e.duration_s) + " s of record, " +
        e.n_segments + " segments" + (e.n_rejected ? "; " + e.n_rejected + " other poles rejected" : "") + "." +
        (e.amendments.length ? " Taken out: " + e.amendments.join("; ") + "." : ""));
    }
    while (this.cards.length < modes.length) this.cards.push(this.make());
    while (this.cards.length > modes.length) this.cards.pop().root.remove();
    modes.forEach((mode, i) => this.fill(this.cards[i], mode, state));
  }
  make() {
    const root = document.createElement("article"), add = (name, type = "p") => {
      const node = document.createElement(type);
      node.className = name;
      root.append(node);
      return node;
    };
    root.className = "card";
    const card = { root, hz: add("hz"), numbers: add("numbers"), shape: add("shape", "canvas"), say: add("say"), spark: add("spark", "canvas") };
    card.shape.setAttribute("role", "img");
    card.spark.setAttribute("role", "img");
    byId("cards").append(root);
    return card;
  }
  fill(card, mode, state) {
    const [hz, small] = [fixed(mode.hz, 5) + " Hz ", mode.hz_std === null ? "" : "± " + fixed(mode.hz_std, 2)];
    const detail = document.createElement("small");
    detail.textContent = small;
    card.hz.replaceChildren(hz, detail);
    text(card.numbers, "Damping " + fixed(100 * mode.damping, 3) + " %" + (mode.damping_std === null ? "" : " ± " + fixed(100 * mode.damping_std, 2)) +
      " · MPC " + fixed(mode.mpc, 2) + (mode.fold ? " · seen folded at " + fixed(mode.apparent_hz, 4) + " Hz" : "") +
      (mode.drifts ? " · drifts by " + fixed(mode.drift_hz_per_min, 2) + " Hz a minute" : ""));
    text(card.say, hoverAdvice(mode, state.modes.duration_s));
    card.mode = mode;
    card.isStale = true;
    this.spark(card, state.historyOf(mode.id));
  }
  // Damping with its standard deviation over the estimates.
  spark(card, history) {
    const canvas = card.spark, width = canvas.clientWidth, height = canvas.clientHeight, c = fitted(canvas, width, height);
    const known = history.filter((h) => Number.isFinite(h.damping) && Number.isFinite(h.damping_std));
    c.font = "13px system-ui,sans-serif";
    c.fillStyle = cssColour("--quiet");
    c.fillText("damping ± standard deviation, from 0", 0, 12);
    if (known.length < 2) return;
    const band = (h) => h.damping_std;
    const high = Math.max(...known.map((h) => h.damping + band(h))), first = known[0].t_s, last = known[known.length - 1].t_s;
    const x = (h) => (width - 4) * (h.t_s - first) / Math.max(1e-9, last - first) + 2, y = (v) => height - 2 - (height - 20) * Math.max(0, v) / high;
    c.strokeStyle = cssColour("--edge");
    c.lineWidth = 1;
    c.strokeRect(0, height - 1.5, width, 0);
    c.fillStyle = "rgba(0,114,178,.25)";
    c.beginPath();
    known.forEach((h, i) => (i ? c.lineTo(x(h), y(h.damping + band(h))) : c.moveTo(x(h), y(h.damping + band(h)))));
    [...known].reverse().forEach((h) => c.lineTo(x(h), y(h.damping - band(h))));
    c.fill();
    c.strokeStyle = "#0072b2";
    c.lineWidth = 2.5;
    c.beginPath();
    known.forEach((h, i) => (i ? c.lineTo(x(h), y(h.damping)) : c.moveTo(x(h), y(h.damping))));
    c.stroke();
    canvas.setAttribute("aria-label", "Damping over " + known.length + " estimates, now " + fixed(100 * known[known.length - 1].damping, 3) + " %");
  }
  // phase: of the swing, in radians.
  drawShapes(state, phase) {
    for (const card of this.cards) {
      const box = card.shape.getBoundingClientRect();
      const isSeen = box.bottom > 0 && box.top < window.innerHeight;
      if (isSeen || card.isStale) drawShape(card.shape, card.mode, state, phase);
      card.isStale = false;
    }
  }
}

// Where each channel is: its region's middle in the picture; without a picture, one below the other.
function places(mode, state) {
  const channels = state.health ? state.health.channels : [], regions = state.preview ? state.preview.regions : [];
  return mode.re.map((re, i) => {
    const channel = channels[i], region = channel && regions[channel.region];
    const at = region ? [region.rect[0] + region.rect[2] / 2, region.rect[1] + region.rect[3] / 2] : [0, i];
    return { at, size: region ? [region.rect[2], region.rect[3]] : [1, 0.3], direction: channel ? [channel.u ?? 1, channel.v ?? 0] : [1, 0], re: re ?? 0, im: mode.im[i] ?? 0, key: region ? channel.region : -1 - i };
  });
}

function drawShape(canvas, mode, state, phase) {
  const width = canvas.clientWidth, height = canvas.clientHeight, c = fitted(canvas, width, height), all = places(mode, state);
  if (!all.length) return;
  const bodies = new Map();  // a region seen along both axes is one body
  for (const p of all) {
    const body = bodies.get(p.key) || { at: p.at, size: p.size, move: [0, 0] };
    const swing = p.re * Math.cos(phase) - p.im * Math.sin(phase);
    body.move = [body.move[0] + swing * p.direction[0], body.move[1] + swing * p.direction[1]];
    bodies.set(p.key, body);
  }
  const list = [...bodies.values()], low = [Infinity, Infinity], high = [-Infinity, -Infinity];
  for (const b of list) {
    for (const k of [0, 1]) {
      low[k] = Math.min(low[k], b.at[k] - b.size[k] / 2);
      high[k] = Math.max(high[k], b.at[k] + b.size[k] / 2);
    }
  }
  const scale = Math.min((width - 2 * kSwing_px - 4) / Math.max(1e-9, high[0] - low[0]), (height - 2 * kSwing_px) / Math.max(1e-9, high[1] - low[1]));
  const place = (b, moved) => [0, 1].map((k) => [width, height][k] / 2 + scale * (b.at[k] - (low[k] + high[k]) / 2) + (moved ? kSwing_px * b.move[k] : 0));
  const order = [...list].sort((a, b) => a.at[1] - b.at[1] || a.at[0] - b.at[0]);
  const string = (moved) => {
    c.beginPath();
    order.forEach((b, i) => (i ? c.lineTo(...place(b, moved)) : c.moveTo(...place(b, moved))));
    c.stroke();
  };
  c.strokeStyle = cssColour("--edge");
  c.setLineDash([4, 4]);
  c.lineWidth = 1.5;
  string(false);
  c.setLineDash([]);
  c.strokeStyle = "#0072b2";
  c.lineWidth = 2.5;
  string(true);
  for (const b of list) {
    const [x, y] = place(b, true), w = Math.max(10, scale * b.size[0]), h = Math.max(5, scale * b.size[1]);
    c.fillStyle = "rgba(86,180,233,.45)";
    c.fillRect(x - w / 2, y - h / 2, w, h);
    c.strokeRect(x - w / 2, y - h / 2, w, h);
  }
  canvas.setAttribute("aria-label", "Shape of the mode at " + fixed(mode.hz, 4) + " Hz: " + mode.re.map((v) => fixed(v, 2)).join(", "));
}
