"""Checks a page in headless Chromium over its debugging pipe; called by check_report.sh, needs nothing but Python."""
import argparse
import base64
import json
import os
import pathlib
import select
import subprocess
import sys
import tempfile
import time

MAX_BYTES = 2_000_000
LEAST_TEXT_PX = 12.0
SIZES = [(360, 800, True), (1280, 900, False)]
SLICE_PX = 1600  # of a page's screenshot: taller pictures are inconvenient to view

# Elements that extend beyond the window without a scrollable box, and text smaller than allowed as drawn.
MEASURE = """(() => {
  const wide = document.documentElement.clientWidth, out = {overflow: document.documentElement.scrollWidth - wide, beyond: [], small: []};
  const scale = (e) => { const m = e.ownerSVGElement && e.getScreenCTM(); return m ? Math.hypot(m.a, m.b) : 1; };
  for (const e of document.body.querySelectorAll('*')) {
    const box = e.getBoundingClientRect();
    if (!box.width || !box.height) continue;
    if (!e.ownerSVGElement && box.right > wide + 1) out.beyond.push(e.tagName + '.' + (e.getAttribute('class') || ''));
    const has_text = Array.from(e.childNodes).some((n) => n.nodeType === 3 && n.data.trim());
    if (!has_text || ['SCRIPT', 'STYLE'].includes(e.tagName)) continue;
    const px = parseFloat(getComputedStyle(e).fontSize) * scale(e);
    if (px < LEAST - 0.05) out.small.push(px.toFixed(1) + ' px: ' + e.textContent.trim().slice(0, 30));
  }
  out.height = document.documentElement.scrollHeight;
  return JSON.stringify(out);
})()""".replace("LEAST", str(LEAST_TEXT_PX))

# Everything interactive: details, keys, buttons, sliders, pointers and arrow keys over the plots.
EXERCISE = """(() => {
  for (const e of document.querySelectorAll('details')) e.open = true;
  for (const e of document.querySelectorAll('button')) { e.click(); e.click(); }
  for (const e of document.querySelectorAll('input')) { e.value = e.max; e.dispatchEvent(new Event('input', {bubbles: true})); }
  for (const e of document.querySelectorAll('svg[tabindex]')) {
    const box = e.getBoundingClientRect();
    if (!box.width) continue;
    for (const share of [0.3, 0.5, 0.8]) e.dispatchEvent(new PointerEvent('pointermove',
      {clientX: box.left + share * box.width, clientY: box.top + share * box.height, bubbles: true}));
    for (const key of ['ArrowLeft', 'ArrowRight', 'ArrowUp', 'ArrowDown'])
      e.dispatchEvent(new KeyboardEvent('keydown', {key, bubbles: true}));
  }
})()"""


class Browser:
    """One Chromium, spoken to in JSON messages that end in a NUL."""

    def __init__(self, profile):
        to_read, self.to_write = os.pipe()
        self.to_hear, from_write = os.pipe()
        flags = ("--headless --no-sandbox --disable-gpu --disable-quic --no-first-run --disable-background-networking "
                 "--disable-component-update --disable-sync --hide-scrollbars --remote-debugging-pipe").split()

        def place_pipes():  # Chromium reads from 3 and writes to 4
            read, write = os.dup(to_read), os.dup(from_write)
            os.dup2(read, 3)
            os.dup2(write, 4)

        self.process = subprocess.Popen(["chromium", *flags, "--user-data-dir=" + profile, "about:blank"],
                                        preexec_fn=place_pipes, close_fds=False, stdin=subprocess.DEVNULL,
                                        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(to_read)
        os.close(from_write)
        self.events, self.rest, self.number = [], b"", 0

    def hear(self, until):
        while b"\0" not in self.rest:
            if not select.select([self.to_hear], [], [], max(0.0, until - time.monotonic()))[0]:
                return None
            piece = os.read(self.to_hear, 1 << 16)
            if not piece:
                raise RuntimeError("Chromium went away")
            self.rest += piece
        message, self.rest = self.rest.split(b"\0", 1)
        return json.loads(message)

    def ask(self, method, session=None, **parameters):
        self.number += 1
        request = {"id": self.number, "method": method, "params": parameters}
        if session:
            request["sessionId"] = session
        data = json.dumps(request).encode() + b"\0"
        while data:
            data = data[os.write(self.to_write, data):]
        until = time.monotonic() + 60
        while True:
            message = self.hear(until)
            if message is None:
                raise RuntimeError(method + " was not answered")
            if message.get("id") == self.number:
                if "error" in message:
                    raise RuntimeError(method + ": " + message["error"]["message"])
                return message["result"]
            self.events.append(message)

    def listen(self, seconds, stop_at=None):
        until = time.monotonic() + seconds
        while stop_at is None or not any(e.get("method") == stop_at for e in self.events):
            message = self.hear(until)
            if message is None:
                return
            self.events.append(message)

    def close(self):
        try:
            self.ask("Browser.close")
        except (RuntimeError, OSError):
            pass
        try:
            self.process.wait(10)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()


def faults_of(events, url):
    """What went wrong in the browser's own words: errors, warnings and requests."""
    faults = []
    for event in events:
        method, p = event.get("method"), event.get("params", {})
        if method == "Runtime.exceptionThrown":
            details = p["exceptionDetails"]
            faults.append("error: " + details.get("exception", {}).get("description", details["text"]).split("\n")[0])
        elif method == "Runtime.consoleAPICalled" and p["type"] in ("error", "warning", "assert"):
            faults.append("console: " + " ".join(str(a.get("value", "")) for a in p["args"]))
        elif method == "Log.entryAdded" and p["entry"]["level"] in ("error", "warning"):
            faults.append("log: " + p["entry"]["text"])
        elif method == "Network.requestWillBeSent" and not p["request"]["url"].startswith("data:"):
            if p["request"]["url"].split("#")[0] != url:
                faults.append("request: " + p["request"]["url"][:100])
    return faults


def open_page(browser, url, width, height, is_phone, scheme):
    browser.events = []
    target = browser.ask("Target.createTarget", url="about:blank")["targetId"]
    session = browser.ask("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
    for domain in ("Page", "Runtime", "Log", "Network"):
        browser.ask(domain + ".enable", session)
    browser.ask("Emulation.setDeviceMetricsOverride", session, width=width, height=height, mobile=is_phone,
                deviceScaleFactor=2 if is_phone else 1)
    browser.ask("Emulation.setEmulatedMedia", session, features=[{"name": "prefers-color-scheme", "value": scheme}])
    browser.events = []
    browser.ask("Page.navigate", session, url=url)
    browser.listen(30, "Page.loadEventFired")
    browser.listen(0.6)
    return target, session


def take_pictures(browser, session, measured, width, folder, name):
    os.makedirs(folder, exist_ok=True)
    for i, top in enumerate(range(0, measured["height"], SLICE_PX)):
        clip = {"x": 0, "y": top, "width": width, "height": min(SLICE_PX, measured["height"] - top), "scale": 1}
        shot = browser.ask("Page.captureScreenshot", session, format="png", captureBeyondViewport=True, clip=clip)
        pathlib.Path(folder, f"{name}_{i + 1:02}.png").write_bytes(base64.b64decode(shot["data"]))


def check(path, screenshots):
    url, faults = path.resolve().as_uri(), []
    size = path.stat().st_size
    if size >= MAX_BYTES:
        faults.append(f"{size} bytes, {MAX_BYTES} allowed")
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        browser = Browser(profile)
        try:
            for width, height, is_phone in SIZES:
                for scheme in ("light", "dark"):
                    where = f"{width} px {scheme}: "
                    target, session = open_page(browser, url, width, height, is_phone, scheme)
                    if screenshots:
                        measured = json.loads(browser.ask("Runtime.evaluate", session, expression=MEASURE)["result"]["value"])
                        take_pictures(browser, session, measured, width, screenshots, f"{width}_{scheme}")
                    browser.ask("Runtime.evaluate", session, expression=EXERCISE)
                    browser.listen(0.4)
                    measured = json.loads(browser.ask("Runtime.evaluate", session, expression=MEASURE)["result"]["value"])
                    if measured["overflow"] > 0 or measured["beyond"]:
                        faults.append(f"{where}{measured['overflow']} px too wide {measured['beyond'][:3]}")
                    if measured["small"]:
                        faults.append(f"{where}small text {measured['small'][:3]}")
                    faults += [where + fault for fault in faults_of(browser.events, url)]
                    browser.ask("Target.closeTarget", targetId=target)
        finally:
            browser.close()
    if faults:
        print(f"MISS {path.name}: {len(faults)} faults: " + "; ".join(faults[:6]))
        return 1
    print(f"ok {path.name}: no console error, no request, no overflow, text >= {LEAST_TEXT_PX:g} px, {size} bytes; "
          "360 and 1280 px, light and dark")
    return 0


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("report", type=pathlib.Path)
    parser.add_argument("--screenshots", help="folder for pictures of the whole page")
    arguments = parser.parse_args()
    if not arguments.report.is_file():
        print(f"check_report: {arguments.report}: no such file", file=sys.stderr)
        return 2
    try:
        return check(arguments.report, arguments.screenshots)
    except (RuntimeError, OSError) as error:
        print(f"check_report: {error}", file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main())
