#!/usr/bin/env python3
"""The ground page loaded again and again during a live run: the displacements that each load shows, against those that
the service sent. Usage: page_reloads.py BIN CLIP OUT URL RELOADS SEED. Prints name, tab, value."""
import json
import os
import random
import sys
import time

from devtools import Browser
from station import Ground, service, tell

bin_folder, clip, out, url = sys.argv[1:5]
n_reloads, seed = int(sys.argv[5]), int(sys.argv[6])
SHOWN = """(() => {
  const t = hovermodal.state.traces, n = Math.min(t.n, t.time.length), out = [];
  for (let k = t.n - n; k < t.n; ++k) {
    const at = k % t.time.length;
    if (t.rings.some((ring) => !Number.isNaN(ring[at]))) out.push(t.time[at]);
  }
  return JSON.stringify({ t_s: out, names: t.names });
})()"""
KEPT = 1024  # samples that the station keeps of each channel


def sent_times(log):
    """Times of the displacements in an LCM event log, s."""
    sys.path.insert(0, os.path.join(os.path.dirname(bin_folder), "python"))
    sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "tools", "figures"))
    import hovermodal
    from lcm_log import events
    return [hovermodal.displacement_t.decode(data).stream_time_ns * 1e-9
            for _, _, channel, data in events(log) if "_DISPLACEMENT" in channel]


def main():
    draw = random.Random(seed)
    log = os.path.join(out, "reloads.lcm")
    if os.path.exists(log):
        os.remove(log)
    ground = Ground(bin_folder, url, out)
    flight = service(bin_folder, clip, url, out, "spectrum.segment=128", "telemetry.log_file=" + log)
    browser = Browser()
    loads = []
    try:
        time.sleep(20)
        for _ in range(n_reloads):
            browser.open(ground.page)
            browser.wait("window.hovermodal && hovermodal.state.traces.n > 0", 20)
            time.sleep(draw.uniform(0.0, 3.0))
            loads.append(json.loads(browser.run(SHOWN)))
    finally:
        browser.close()
        flight.stop()
        ground.stop()
    sent = [round(t, 6) for t in sent_times(log)]
    lost = doubled = foreign = 0
    for load in loads:
        shown = [round(t, 6) for t in load["t_s"]]
        last = sent.index(shown[-1])
        wanted = sent[max(0, last + 1 - KEPT):last + 1]  # the station had them all when the page asked
        lost += len(set(wanted) - set(shown))
        doubled += len(shown) - len(set(shown))
        foreign += len(set(shown) - set(sent))
    tell("reloads", len(loads))
    tell("sent", len(sent))
    tell("least_shown", min(len(load["t_s"]) for load in loads))
    tell("lost", lost)
    tell("doubled", doubled)
    tell("foreign", foreign)
    tell("console_lines", len(browser.console))


if __name__ == "__main__":
    main()
