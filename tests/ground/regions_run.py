#!/usr/bin/env python3
"""The page of `hovermodal regions --serve` in a browser: dragged, moved by keyboard, renamed, removed, refused, saved.
Usage: regions_run.py BIN CLIP OUT. Prints name, tab, value."""
import os
import sys
import time

from devtools import Browser
from station import Program, tell

bin_folder, clip, out = sys.argv[1:4]
SAVED = os.path.join(out, "picked.yaml")
STATE = "document.getElementById('state').textContent"
RECTS = "[...document.querySelectorAll('rect.region')].map(r => ['x', 'y', 'width', 'height'].map(k => Number(r.getAttribute(k))))"


def on_screen(browser, script):
    """The middle of an element, in pixels of the window."""
    return browser.run(f"(() => {{ const e = {script}; e.scrollIntoView({{block: 'center'}}); "
                       "const b = e.getBoundingClientRect(); return [b.left + b.width / 2, b.top + b.height / 2]; })()")


def drag(browser, script, du, dv):
    x, y = on_screen(browser, script)
    for kind, dx, dy in (("mousePressed", 0, 0), ("mouseMoved", du / 2, dv / 2), ("mouseMoved", du, dv), ("mouseReleased", du, dv)):
        browser.call("Input.dispatchMouseEvent",
                     {"type": kind, "x": x + dx, "y": y + dy, "button": "left", "buttons": 0 if kind == "mouseReleased" else 1, "clickCount": 1})


def key(browser, name, modifiers=0):
    for kind in ("keyDown", "keyUp"):
        browser.call("Input.dispatchKeyEvent", {"type": kind, "key": name, "code": name, "modifiers": modifiers})


def click(browser, script):
    browser.run(script + ".click()")


def seen_together(browser):
    """True: the whole picture, its boxes and Save lie within the window, at the top of the page and scrolled to the picture."""
    inside = ("[document.getElementById('picture'), document.getElementById('save'), ...document.querySelectorAll('rect.region')]"
              ".every(e => { const b = e.getBoundingClientRect(); return b.top >= 0 && b.bottom <= innerHeight && b.left >= 0 && b.right <= innerWidth; })")
    at_top = browser.run(f"(scrollTo(0, 0), {inside})")
    return at_top and browser.run(f"(document.getElementById('picture').scrollIntoView(), {inside})")


def save(browser):
    click(browser, "document.getElementById('save')")
    browser.wait(f"{STATE} !== 'not saved' && {STATE} !== ''", 10)
    return browser.run(STATE)


def main():
    program = Program([os.path.join(bin_folder, "hovermodal"), "regions", os.path.join(clip, "clip.mp4"), "--out", SAVED, "--force", "--serve"],
                      os.path.join(out, f"regions_{time.monotonic_ns()}.log"))
    browser = None
    try:
        page = program.wait_for(r"open (http://\S+)", 120).group(1)
        browser = Browser()
        browser.open(page)
        browser.wait("document.querySelectorAll('rect.region').length > 0", 20)
        before = browser.run(RECTS)
        tell("proposed", len(before))
        drag(browser, "document.querySelectorAll('rect.region')[0]", 30, 12)
        browser.run("document.querySelectorAll('rect.region')[1].focus()")
        key(browser, "ArrowRight")
        key(browser, "ArrowDown", 8)   # Shift: 10 px
        key(browser, "ArrowRight", 2)  # Ctrl: wider
        drag(browser, "document.querySelectorAll('circle.corner')[11]", 8, 6)  # lower right of the third
        after = browser.run(RECTS)
        moved = [[b - a for a, b in zip(*pair)] for pair in zip(before, after)]
        tell("dragged_px", moved[0])
        tell("by_keys_px", moved[1])
        tell("by_corner_px", moved[2])
        browser.size(1320, 900)
        time.sleep(0.5)
        browser.run("document.activeElement.blur()")
        tell("seen_together", seen_together(browser))
        browser.picture(os.path.join(out, "regions_page.png"))
        rename = ("(text => {{ const i = document.querySelector('#rows input'); i.value = text; "
                  "i.dispatchEvent(new Event('input')); }})('{}')")
        browser.run(rename.format("a: b"))
        wrong = save(browser)
        tell("wrong_name", wrong)
        tell("wrong_refused", wrong.startswith("not saved"))
        browser.run(rename.format("lowest"))
        click(browser, "document.querySelectorAll('#rows button')[2]")
        click(browser, "document.getElementById('add')")
        tell("saved", save(browser))
        expected = [list(map(round, rect)) for rect in browser.run(RECTS)]
        text = open(SAVED).read()
        tell("in_file", sum(f"rect: [{', '.join(map(str, rect))}]" in text for rect in expected))
        tell("on_page", len(expected))
        tell("renamed", "name: lowest" in text)
        browser.size(1280, 600)
        time.sleep(0.5)
        tell("seen_together_low", seen_together(browser))
        browser.size(390, 844, 2, True)
        time.sleep(0.5)
        tell("seen_together_phone", seen_together(browser))
        tell("phone_overflow_px", browser.run("document.documentElement.scrollWidth - document.documentElement.clientWidth"))
        tell("console_lines", len(browser.console) - sum("422" in line for line in browser.console))
        for line in browser.console:
            print("console:", line, file=sys.stderr)
    finally:
        if browser:
            browser.close()
        program.stop()


main()
