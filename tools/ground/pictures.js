// The plots: displacements, spectra, stabilisation.
import { byId, fixed, text } from "./dom.js";
import { Plot, cssColour, curveStyle, drawMark, fitted, kVerdicts, verdictStyle } from "./plot.js";

const kTraces_s = 30;

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
