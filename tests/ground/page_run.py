#!/usr/bin/env python3
"""The ground page in a browser, from the first paint through a restarted service, a silent link and a lost ground
station. Usage: page_run.py BIN CLIP OUT URL. Prints name, tab, value."""
import os
import signal
import sys
import time

from devtools import Browser
from station import Ground, service, tell

bin_folder, clip, out, url = sys.argv[1:5]
SETTINGS = ("spectrum.segment=128", "closure.period_s=20", "closure.window_s=30")
MODES = "(hovermodal.state.modes ? hovermodal.state.modes.modes.filter(m => m.structural).length : 0)"
NUMBER = "(hovermodal.state.modes ? hovermodal.state.modes.number : -1)"
FRAMES = "(hovermodal.state.health ? hovermodal.state.health.frames_processed : -1)"
NOTICE = "(document.getElementById('notice').hidden ? '' : document.getElementById('notice').textContent)"


def seconds(value):
    return "never" if value is None else f"{value:.1f}"


def first_view(browser, page):
    browser.open(page)
    browser.wait("document.readyState === 'complete' && performance.getEntriesByType('paint').length > 0", 20)
    tell("first_paint_ms", browser.run(
        "Math.round(performance.getEntriesByType('paint').find(p => p.name === 'first-contentful-paint').startTime)"))
    tell("page_bytes", browser.run(
        "performance.getEntriesByType('navigation').concat(performance.getEntriesByType('resource')"
        ".filter(r => /\\.(js|css|svg)$/.test(r.name))).reduce((sum, r) => sum + r.transferSize, 0)"))


def pictures(browser):
    for name, width, height, scale, mobile in (("desktop", 1320, 900, 1, False), ("phone", 390, 844, 2, True)):
        browser.size(width, height, scale, mobile)
        time.sleep(1.5)
        browser.picture(os.path.join(out, name + ".png"))
        tell(name + "_overflow_px", browser.run("document.documentElement.scrollWidth - document.documentElement.clientWidth"))
    browser.size(1320, 900)


def keyboard(browser):
    for kind in ("keyDown", "keyUp"):
        browser.call("Input.dispatchKeyEvent", {"type": kind, "key": " ", "code": "Space", "text": " " if kind == "keyDown" else ""})
    tell("space_pauses", browser.run("document.getElementById('pause').getAttribute('aria-pressed')"))
    browser.run("document.getElementById('pause').click()")
    tell("tabbable", browser.run("document.querySelectorAll('button:not([hidden]),canvas[tabindex]').length"))


def main():
    programs = []
    ground = Ground(bin_folder, url, out)
    programs.append(ground)
    flight = service(bin_folder, clip, url, out, *SETTINGS)
    programs.append(flight)
    browser = Browser()
    try:
        first_view(browser, ground.page)
        tell("modes_after_s", seconds(browser.wait(MODES + " > 0", 90)))
        number = browser.run(NUMBER)
        tell("update_after_s", seconds(browser.wait(f"{NUMBER} > {number}", 60)))
        browser.wait(f"{NUMBER} > {number + 1} && hovermodal.state.closure", 60)
        tell("modes", browser.run(MODES))
        pictures(browser)
        keyboard(browser)

        flight.stop()
        flight = service(bin_folder, clip, url, out, *SETTINGS)
        programs.append(flight)
        tell("restart_shown_s", seconds(browser.wait("document.documentElement.dataset.runs === '1'", 60)))
        tell("modes_after_restart_s", seconds(browser.wait(MODES + " > 0", 90)))

        flight.send(signal.SIGSTOP)
        tell("silence_shown_s", seconds(browser.wait(NOTICE + ".includes('silent')", 20)))
        frames = browser.run(FRAMES)
        flight.send(signal.SIGCONT)
        tell("silence_over_s", seconds(browser.wait(f"{NOTICE} === '' && {FRAMES} > {frames}", 30)))
        tell("network_lines", len(browser.network))

        ground.stop(signal.SIGKILL)
        tell("lost_station_shown_s", seconds(browser.wait(NOTICE + ".includes('No connection')", 20)))
        frames = browser.run(FRAMES)
        ground = Ground(bin_folder, url, out, ground.port)
        programs.append(ground)
        tell("lost_station_over_s", seconds(browser.wait(f"{NOTICE} === '' && {FRAMES} > {frames}", 40)))
        tell("console_lines", len(browser.console))
        tell("refused_connections", len(browser.network))
        for line in browser.console:
            print("console:", line, file=sys.stderr)
    finally:
        browser.close()
        for program in programs:
            if program.program.poll() is None:
                program.stop()


main()
