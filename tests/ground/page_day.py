#!/usr/bin/env python3
"""Twenty-four hours of messages at 30 frames/s fed to the page's update function, drawn as they come: its heap.
Usage: page_day.py BIN OUT URL HOURS. Prints name, tab, value."""
import sys

from devtools import Browser
from station import Ground, tell

bin_folder, out, url, hours = *sys.argv[1:4], float(sys.argv[4])
FEED = """
window.feed = async (from_s, to_s) => {
  const apply = hovermodal.apply, n_channels = 12, names = Array.from({length: n_channels}, (_, i) => "floor" + i);
  const topic = {received: 1, lost: 0, late: 0, bad: 0, restarts: 0, sent: 1};
  const topics = Object.fromEntries(["modal", "displacement", "spectrum", "tracks", "closure", "health", "preview"].map((t) => [t, topic]));
  for (let tick = from_s * 5; tick < to_s * 5; ++tick) {
    const t = tick / 5, first = tick * 6, data = {link: {boot: 1, run: 0, heard: true, finished: false, stream: "day", silent_s: 0, foreign: 0, topics}};
    data.traces = {first, next: first + 6, stride: 1, channels: names, t_s: [0, 1, 2, 3, 4, 5].map((k) => t + k / 30),
      mm: names.map((_, i) => [0, 1, 2, 3, 4, 5].map((k) => Math.sin((t + k / 30) * (i + 1))))};
    if (tick % 5 === 0) {
      data.health = {state: "running", t_s: t, rate_hz: 30, measured_hz: 30, frames_in: first, frames_processed: first, frames_dropped: 0,
        frames_missing: 0, points: [200, 200], samples_masked: 0, estimates: 1, messages_sent: 1, messages_failed: 0, snapshots_skipped: 0,
        warnings: ["warning " + tick % 7], latency_ms: [1, 2, 3, 4], host: {cpu_c: 50, cpu_mhz: 1000, throttled: 0, resident_bytes: 1e8, available_bytes: 1e9, disk_left_bytes: 1e9},
        stages: ["capture", "tracking"].map((name) => ({name, in: first, out: first, dropped: 0, p50_ms: 1, p99_ms: 2, worst_ms: 3, queue: [0, 8]})),
        regions: names.map((name) => ({name, state: "measuring", tracked: 20, total: 20, searching: 0, lost: 0})),
        channels: names.map((name, region) => ({name, region, u: 1, v: 0, base: false}))};
      data.preview = {n: tick, frame: first, t_s: t, image: [1920, 1080], size: [320, 180], scale: 6, has_jpeg: false,
        regions: names.map((_, i) => ({rect: [100, 80 * i, 300, 40], role: 0, moved: true})),
        points: {u: Array.from({length: 200}, (_, i) => i * 9), v: Array.from({length: 200}, (_, i) => i * 5), region: Array(200).fill(0), inlier: Array(200).fill(1)}};
    }
    if (tick % 50 === 0) {
      const number = tick / 50, duration_s = t + 10;
      data.modes = {number, n_samples: first, n_segments: number, n_missing: 0, rate_hz: 30, duration_s, order: 12, final: false, status: "ok", n_rejected: 4,
        amendments: [], channels: names, modes: Array.from({length: 10}, (_, i) => ({verdict: i < 6 ? "structural" : "harmonic", structural: i < 6, hz: i + 1 + 0.01 * Math.random(),
        hz_std: 0.01, apparent_hz: i + 1, fold: 0, damping: 0.01, damping_std: 0.01 / Math.sqrt(number + 1), mpc: 0.99, presence: 1, reason: "because " + number, id: i + 1,
        re: names.map(() => Math.random()), im: names.map(() => 0), n_estimates: number, more_s: 10, drifts: false, drift_hz_per_min: 0}))};
      data.spectra = {step_hz: 15 / 512, first_hz: 0, n_segments: number, rate_hz: 30, channels: names.map((name) => ({name, log10: Array.from({length: 512}, () => -4 * Math.random())}))};
    }
    apply(JSON.parse(JSON.stringify(data)));  // as it comes: every text and number is a new one
    if (tick % 500 === 0) await new Promise((done) => requestAnimationFrame(done));
  }
  return hovermodal.state.version;
};
true
"""


def main():
    ground = Ground(bin_folder, url, out)
    browser = Browser()
    try:
        browser.open(ground.page)
        browser.wait("window.hovermodal !== undefined", 20)
        browser.run(FEED)
        tell("heap_opened", browser.heap_bytes())
        fed = 0
        for until in [1.0] + [hours * k / 6 for k in range(1, 7)]:
            if until <= fed:
                continue
            browser.run(f"feed({int(fed * 3600)}, {int(until * 3600)})", 1800)
            fed = until
            browser.wait("new Promise((done) => requestAnimationFrame(() => done(true)))", 5)
            tell(f"heap_{until:g}_h", browser.heap_bytes())
        tell("estimates_kept", browser.run("hovermodal.state.estimates.length"))
        tell("samples_kept", browser.run("hovermodal.state.traces.time.length"))
        tell("nodes", browser.run("document.querySelectorAll('*').length"))
        tell("console_lines", len(browser.console))
        for line in browser.console:
            print("console:", line, file=sys.stderr)
    finally:
        browser.close()
        ground.stop()


main()
