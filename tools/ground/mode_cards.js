// A card for each mode: what is known of it, how it came, its shape in motion.
import { byId, fixed, text } from "./dom.js";
import { cssColour, fitted } from "./plot.js";
import { hoverAdvice } from "./state.js";

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
