// All that is words and numbers.
import { byId, fixed, text } from "./dom.js";

function element(type, content, name) {
  const node = document.createElement(type);
  if (name) node.className = name;
  node.append(...(Array.isArray(content) ? content : [content]));
  return node;
}
const whole = (n) => (n === null || n === undefined ? "–" : n.toLocaleString("en-US"));
const bytes = (n) => (n === null || n === undefined ? null : n >= 1e9 ? fixed(n / 1e9) + " GB" : fixed(n / 1e6) + " MB");

function table(node, head, rows) {
  const thead = element("thead", element("tr", head.map((h) => element("th", h))));
  const body = element("tbody", rows.map((cells) => element("tr", cells.map((c) => (c instanceof Node ? c : element("td", String(c)))))));
  node.replaceChildren(thead, body);
}
const alarm = (value, isBad) => element("td", whole(value), isBad ? "alarm" : "");

// ---- Head.
function stateOf(state) {
  const h = state.health, link = state.link;
  if (!link || !link.heard) return ["waiting", ""];
  if (!h) return ["heard", ""];
  if (h.state.startsWith("fault") || h.state.startsWith("stalled")) return [h.state, "bad"];
  if (link.silent_s > 3 && !link.finished) return ["silent", "bad"];
  return [h.state, h.state === "running" ? "good" : ""];
}

export function showHead(state) {
  const link = state.link, h = state.health, [word, kind] = stateOf(state);
  text(byId("stream"), link && link.stream ? link.stream : "hovermodal");
  text(byId("state"), word);
  byId("state").dataset.kind = kind;
  if (!link || !link.heard || !h) return;
  const n = state.modes ? state.modes.modes.filter((m) => m.structural).length : 0;
  const record = state.modes ? " from " + Math.round(state.modes.duration_s) + " s" : "";
  text(byId("summary"), n + (n === 1 ? " mode" : " modes") + record + " · " + whole(h.frames_processed) + " frames" +
    (h.measured_hz === null ? "" : " at " + fixed(h.measured_hz) + " Hz") + " · points " + h.points[0] + " of " + h.points[1]);
}

export function showNotice(state, { isOpen, silent_s, isPaused, run }) {
  const link = state.link, node = byId("notice");
  let say = run;
  if (isPaused) say = "Paused: what comes is kept and shown when you go on.";
  if (link && link.warnings && link.warnings.length > 0) say = link.warnings.join(" ");
  if (link && link.heard && link.silent_s > 3 && !link.finished) {
    say = "The link is silent: nothing heard from the aircraft for " + Math.round(link.silent_s) + " s. What is shown is old.";
  }
  if (!isOpen && silent_s > 2) say = "No connection to the ground station for " + Math.round(silent_s) + " s: trying again. What is shown is old.";
  node.hidden = say === "";
  text(node, say);
}

// ---- Health.
export function showHealth(state) {
  const h = state.health;
  if (!h) return;
  const host = h.host, facts = [];
  const add = (name, value, isBad = false) => { if (value !== null && value !== undefined) facts.push([name, value, isBad]); };
  add("Frame rate", (h.measured_hz === null ? "–" : fixed(h.measured_hz)) + " of " + fixed(h.rate_hz) + " Hz");
  add("Stream time", Math.round(h.t_s) + " s");
  add("Processor", host.cpu_c === null ? null : fixed(host.cpu_c) + " °C", host.cpu_c > 80);
  add("Slowed by heat", host.throttled === null ? null : host.throttled ? "yes" : "no", host.throttled === 1);
  if (h.latency_ms) {
    add("Latency, half", fixed(h.latency_ms[0]) + " ms");
    add("Latency, 99 %", fixed(h.latency_ms[1]) + " ms");
    add("Latency, worst", fixed(h.latency_ms[3]) + " ms");
  }
  add("Memory", bytes(host.resident_bytes));
  add("Disk left", bytes(host.disk_left_bytes), host.disk_left_bytes < 5e8);
  byId("health").replaceChildren(...facts.map(([name, value, isBad]) => element("div", [element("dt", name), element("dd", value, isBad ? "alarm" : "")])));
  byId("warnings").replaceChildren(...h.warnings.map((w) => element("li", w)));
  table(byId("stages"), ["Stage", "taken", "lost", "half, ms", "99 %, ms", "queue"],
    h.stages.map((s) => [s.name, whole(s.in), alarm(s.dropped, s.dropped > 0), fixed(s.p50_ms), fixed(s.p99_ms), s.queue[1] ? s.queue[0] + "/" + s.queue[1] : "–"]));
  const losses = [["Frames dropped: too late for tracking", h.frames_dropped], ["Frames missing: lost before the service", h.frames_missing],
    ["Samples masked: a channel not seen", h.samples_masked], ["Spectra skipped", h.snapshots_skipped], ["Messages not sent", h.messages_failed]];
  table(byId("losses"), ["On board, since start", "number"], losses.map(([name, n]) => [name, alarm(n, n > 0)]));
}

export function showRegions(state) {
  if (!state.health) return;
  byId("regions").replaceChildren(...state.health.regions.map((r) => {
    const item = element("li", r.name + (r.state === "measuring" ? "" : ": " + r.state) + " " + r.tracked + "/" + r.total);
    item.dataset.state = r.state;
    return item;
  }));
}

export function showLink(state) {
  if (!state.link || !state.link.topics) return;
  const rows = Object.entries(state.link.topics).map(([name, t]) => [name, whole(t.received), whole(t.sent), alarm(t.lost, t.lost > 0), alarm(t.late, t.late > 0), alarm(t.bad, t.bad > 0)]);
  table(byId("link"), ["Messages", "heard", "sent", "lost", "late", "broken"], rows);
}

// ---- Closing the loop.
function bar(name, value, largest, kind, unit) {
  const fill = element("i", "", kind);
  fill.style.width = 100 * Math.min(1, value / largest) + "%";
  return element("div", [element("b", name), element("div", fill, "bar"), element("span", fixed(value) + " " + unit)], "pair");
}

// What a report of residual diagnosis found: residual, effects, the rest.
function finding(c) {
  const out = [];
  if (c.refused) {
    out.push(element("p", "Nothing can be concluded: " + c.refused));
  } else {
    const largest = Math.max(c.before || 0, c.after || 0, c.floor || 0, 1e-12);
    out.push(bar("Before", c.before, largest, "", c.unit), bar("After", c.after, largest, "after", c.unit), bar("Noise alone", c.floor, largest, "", c.unit));
    out.push(element("p", c.steps.length ? "" : "Nothing found that explains more than chance."));
    for (const s of c.steps) {
      out.push(element("p", [element("b", s.effect), ": " + s.numbers + (s.meaning ? " (" + s.meaning + ")" : "") + "; on held-out data " + fixed(s.before) + " → " + fixed(s.after) + " " + c.unit]));
    }
    if (c.left) out.push(element("p", "Left: " + c.left + (c.unexplained === null ? "" : " (" + fixed(100 * c.unexplained, 2) + " % of what is above the noise)"), "note"));
  }
  return out;
}

export function showClosure(state) {
  const c = state.closure;
  if (!c) return;
  const out = finding(c);
  out.push(element("p", [element("b", "In force: "), c.in_force.length ? c.in_force.join("; ") : "nothing beyond what was declared"]));
  if (c.changes.length) out.push(element("p", "Changed by this report: " + c.changes.join("; ")));
  out.push(element("p", "Report " + (c.number + 1) + " on frames " + c.frames[0] + " to " + c.frames[1] + ".", "note"));
  byId("closure").replaceChildren(...out);
}

export function showStructure(state) {
  const c = state.structure;
  byId("structure-part").hidden = !c;
  if (c) byId("structure").replaceChildren(...finding(c), element("p", "Report " + (c.number + 1) + ", modes of " + fixed(c.duration_s, 3) + " s.", "note"));
}
