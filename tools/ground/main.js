// Hears the ground station's events, keeps State, and draws what has changed, when the screen is due.
import { CameraView } from "./camera_view.js";
import { byId } from "./dom.js";
import { ModeCards } from "./mode_cards.js";
import { SpectraView, StableView, TracesView } from "./pictures.js";
import { State } from "./state.js";
import { showClosure, showStructure, showHead, showHealth, showLink, showNotice, showRegions } from "./tables.js";

const kRetry_ms = 3000, kPatience_ms = 10000, kSwing_ms = 2400, kShapeFrame_ms = 33;

const state = new State();
const wanted = new Set();  // parts to draw
const waiting = [];        // events that came while a snapshot is fetched
let nFetching = 0;
let isPaused = false, heard_ms = 0, source = null, noticeOfRun = "", noticeUntil_ms = 0;
const stillness = window.matchMedia("(prefers-reduced-motion: reduce)");

const camera = new CameraView(), traces = new TracesView(() => wanted.add("traces")), cards = new ModeCards();
const spectra = new SpectraView(() => wanted.add("spectra")), stable = new StableView(() => wanted.add("stable"));
camera.wanted = () => wanted.add("preview");

const kDraw = {
  link: () => { showHead(state); showLink(state); },
  health: () => { showHealth(state); showRegions(state); },
  preview: () => camera.draw(state),
  traces: () => traces.draw(state),
  modes: () => cards.update(state),
  spectra: () => spectra.draw(state),
  stable: () => stable.draw(state),
  closure: () => showClosure(state),
  structure: () => showStructure(state),
};

function apply(data) {
  heard_ms = performance.now();
  const changed = state.apply(data);
  if (changed.has("run")) {
    noticeOfRun = "The service began again at " + new Date().toLocaleTimeString() + ": what is shown is of the new run.";
    noticeUntil_ms = heard_ms + 20000;
    document.documentElement.dataset.runs = String(Number(document.documentElement.dataset.runs || 0) + 1);
  }
  for (const part of changed) wanted.add(part);
  if (changed.has("modes")) wanted.add("spectra").add("stable");
  if (changed.has("preview")) camera.load(state.preview);
}

// What happened before comes with the snapshot, so events that overtake it wait: a snapshot that is taken after the
// event source has opened and the events since then hold every sample between them.
async function fetchAll() {
  ++nFetching;
  try {
    const answer = await fetch("snapshot.json", { cache: "no-store", signal: AbortSignal.timeout(kPatience_ms) });
    if (answer.ok) apply(await answer.json());
  } catch (error) {
    // The event source tells that the station is gone, and comes back by itself.
  }
  if (--nFetching > 0) return;
  for (const event of waiting.splice(0)) apply(event);
}
function take(event) {
  if (nFetching > 0) waiting.push(event);
  else apply(event);
}

function connect() {
  source = new EventSource("events");
  source.addEventListener("open", fetchAll);
  source.addEventListener("resync", fetchAll);
  source.addEventListener("message", (event) => take(JSON.parse(event.data)));
  source.addEventListener("error", () => {
    wanted.add("link");
    if (source.readyState !== EventSource.CLOSED) return;  // else it tries again by itself
    setTimeout(connect, kRetry_ms);
  });
}

function look() {
  const silent_s = (performance.now() - heard_ms) / 1000;
  const isOpen = source && source.readyState === EventSource.OPEN;
  showNotice(state, { isOpen, silent_s, isPaused, run: performance.now() < noticeUntil_ms ? noticeOfRun : "" });
}

let shape_ms = 0;
function frame(now) {
  requestAnimationFrame(frame);
  if (!isPaused) {
    for (const part of wanted) if (kDraw[part]) kDraw[part]();
    wanted.clear();
  } else {
    for (const part of ["spectra", "stable"]) if (wanted.delete(part)) kDraw[part]();  // the cursor still moves
  }
  if (now - shape_ms < kShapeFrame_ms || isPaused) return;
  shape_ms = now;
  cards.drawShapes(state, stillness.matches ? 0 : 2 * Math.PI * (now % kSwing_ms) / kSwing_ms);
}

function pause(on) {
  isPaused = on;
  byId("pause").setAttribute("aria-pressed", String(on));
  byId("pause").textContent = on ? "Go on" : "Pause";
  if (!on) for (const part in kDraw) wanted.add(part);
  look();
}

byId("pause").addEventListener("click", () => pause(!isPaused));
document.addEventListener("keydown", (event) => {
  if (event.key !== " " || event.ctrlKey || event.altKey || event.metaKey || event.target.closest("button,a,input")) return;
  event.preventDefault();
  pause(!isPaused);
});
byId("theme").addEventListener("click", () => {
  const isDark = document.documentElement.dataset.theme !== "dark";
  document.documentElement.dataset.theme = isDark ? "dark" : "light";
  byId("theme").setAttribute("aria-pressed", String(isDark));
  for (const part in kDraw) wanted.add(part);
});
new ResizeObserver(() => { for (const part in kDraw) wanted.add(part); }).observe(document.body);

// The token has done its work: the cookie goes on with it, and the address can be shown to others.
if (new URLSearchParams(location.search).has("token")) history.replaceState(null, "", location.pathname);

connect();
setInterval(look, 500);
requestAnimationFrame(frame);
// For tests and the curious.
window.hovermodal = { state, apply };
