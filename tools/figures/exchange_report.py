"""Report pages in headless Chromium: widths, print, contrast, keyboard, network; pictures of every section. Called by exchange.sh.

  exchange_report.py FOLDER PAGE...     one line each: check, measured, faults (tabs between them)
"""
import base64
import json
import pathlib
import sys
import tempfile

from check_report import EXERCISE, MEASURE, Browser, faults_of, open_page

WIDTHS = (390, 768, 1280, 1920)
PAPER_PX = (718, 1046)  # A4 less Chromium's margins of 0.4 inch, at 96 px per inch
LEAST_CONTRAST, LARGE_CONTRAST = 4.5, 3.0  # WCAG 2.1, level AA

# Texts whose contrast is too low. The colours below a text's middle are blended from the stack of elements there; below a
# picture of the camera lies white or black, whichever is worse.
CONTRAST = """(() => {
  const parse = (t) => { const m = (t.match(/[\\d.]+/g) || []).map(Number); return m.length < 3 ? null : [m[0], m[1], m[2], m.length > 3 ? m[3] : 1]; };
  const part = (v) => { v /= 255; return v <= 0.03928 ? v / 12.92 : Math.pow((v + 0.055) / 1.055, 2.4); };
  const light = (c) => 0.2126 * part(c[0]) + 0.7152 * part(c[1]) + 0.0722 * part(c[2]);
  const ratio = (a, b) => { const x = light(a), y = light(b); return (Math.max(x, y) + 0.05) / (Math.min(x, y) + 0.05); };
  const over = (top, below) => [0, 1, 2].map((i) => top[i] * top[3] + below[i] * (1 - top[3]));
  const painted = (e) => {
    const style = getComputedStyle(e);
    if (!e.ownerSVGElement) return parse(style.backgroundColor);
    if (e.tagName !== 'rect' || style.fill === 'none') return null;
    const c = parse(style.fill);
    if (c) c[3] *= Number(style.fillOpacity);
    return c;
  };
  const out = {texts: 0, least: 99, bad: []};
  for (const e of document.body.querySelectorAll('*')) {
    if (['SCRIPT', 'STYLE'].includes(e.tagName) || !Array.from(e.childNodes).some((n) => n.nodeType === 3 && n.data.trim())) continue;
    let box = e.getBoundingClientRect();
    const style = getComputedStyle(e);
    if (!box.width || !box.height || style.visibility === 'hidden' || style.clipPath !== 'none') continue;
    e.scrollIntoView({block: 'center', inline: 'center'});
    box = e.getBoundingClientRect();
    const stack = document.elementsFromPoint(box.left + box.width / 2, box.top + box.height / 2);
    const at = stack.findIndex((s) => s === e || e.contains(s) || s.contains(e));
    if (at < 0) continue;
    const layers = [];
    let bases = [[255, 255, 255]];
    for (const s of stack.slice(at)) {
      if (s.tagName === 'use' || s.tagName === 'image') { bases = [[255, 255, 255], [0, 0, 0]]; break; }
      const c = painted(s);
      if (c && c[3] > 0) layers.push(c);
      if (c && c[3] >= 1) break;
    }
    const ink = parse(e.ownerSVGElement ? style.fill : style.color);
    if (!ink) continue;
    let opacity = ink[3];
    for (let p = e; p && p.nodeType === 1; p = p.parentElement) opacity *= Number(getComputedStyle(p).opacity);
    let least = 99;
    for (const base of bases) {
      const below = layers.reduceRight((b, c) => over(c, b), base);
      least = Math.min(least, ratio(over([ink[0], ink[1], ink[2], opacity], below), below));
    }
    const px = parseFloat(style.fontSize), large = px >= 24 || (px >= 18.66 && Number(style.fontWeight) >= 700);
    out.texts++;
    out.least = Math.min(out.least, large ? least * 1.5 : least);
    if (least < (large ? LARGE : SMALL) - 0.005) out.bad.push(least.toFixed(2) + ': ' + e.tagName + ' "' + e.textContent.trim().slice(0, 30) + '"');
  }
  return JSON.stringify(out);
})()""".replace("LARGE", str(LARGE_CONTRAST)).replace("SMALL", str(LEAST_CONTRAST))

# In print nothing scrolls: what is wider than its box, or must stay whole and is higher than a page, is cut.
PRINTED = """(() => {
  window.dispatchEvent(new Event('beforeprint'));
  const wide = document.documentElement.clientWidth, cut = [];
  for (const e of document.body.querySelectorAll('*')) {
    const box = e.getBoundingClientRect();
    if (!box.width || !box.height || e.ownerSVGElement) continue;
    const name = e.tagName + '.' + (e.getAttribute('class') || e.id || '');
    if (box.right > wide + 1 || box.left < -1) cut.push(name + ' beyond the paper');
    if (e.scrollWidth > e.clientWidth + 1 && getComputedStyle(e).overflowX !== 'visible') cut.push(name + ' cut at the side');
    if (getComputedStyle(e).breakInside === 'avoid' && box.height > HEIGHT) cut.push(name + ' higher than a page');
  }
  const folded = document.querySelectorAll('details:not([open])').length;
  if (folded) cut.push(folded + ' parts folded');
  return JSON.stringify(cut);
})()""".replace("HEIGHT", str(PAPER_PX[1]))

INTERACTIVE = "a[href], button, input, summary, [tabindex='0']"
COUNT = f"""Array.from(document.querySelectorAll("{INTERACTIVE}")).filter((e) => e.getClientRects().length &&
  (!e.closest('details:not([open])') || e.tagName === 'SUMMARY')).length"""
FOCUSED = """(() => {
  const e = document.activeElement;
  if (!e || e === document.body) return JSON.stringify(null);
  window.tabbed = window.tabbed || new Map();
  if (!window.tabbed.has(e)) window.tabbed.set(e, window.tabbed.size);
  const style = getComputedStyle(e);
  return JSON.stringify({n: window.tabbed.get(e), seen: style.outlineStyle !== 'none' && parseFloat(style.outlineWidth) >= 2});
})()"""


def value(browser, session, expression):
    result = browser.ask("Runtime.evaluate", session, expression=expression)
    if "exceptionDetails" in result:
        raise RuntimeError(expression[:60] + ": " + json.dumps(result["exceptionDetails"])[:300])
    return json.loads(result["result"]["value"]) if result["result"]["type"] == "string" else result["result"].get("value")


def press(browser, session, key, code, text=""):
    for kind in ("keyDown", "keyUp"):
        more = {"text": text} if text and kind == "keyDown" else {}
        browser.ask("Input.dispatchKeyEvent", session, type=kind, key=key, code=key if key != " " else "Space", windowsVirtualKeyCode=code, **more)


def check_keyboard(browser, session):
    """Faults, and the number of elements that Tab reaches."""
    faults, wanted, reached, unmarked = [], value(browser, session, COUNT), set(), 0
    browser.ask("Runtime.evaluate", session, expression="window.scrollTo(0, 0); document.activeElement.blur()")
    for _ in range(wanted + 5):
        press(browser, session, "Tab", 9)
        focused = value(browser, session, FOCUSED)
        if focused is None or focused["n"] in reached:
            break
        reached.add(focused["n"])
        unmarked += not focused["seen"]
    if len(reached) < wanted:
        faults.append(f"Tab reaches {len(reached)} of {wanted}")
    if unmarked:
        faults.append(f"{unmarked} without a visible focus")
    words = "JSON.stringify((document.getElementById('line-words') || {}).textContent || '')"
    if value(browser, session, "document.getElementById('line') !== null"):
        browser.ask("Runtime.evaluate", session, expression="document.getElementById('line').focus()")
        before = value(browser, session, words)
        press(browser, session, "ArrowRight", 39)
        if value(browser, session, words) == before:
            faults.append("arrow keys do not move the frequency")
    if value(browser, session, "document.querySelector('summary') !== null"):
        browser.ask("Runtime.evaluate", session, expression="document.querySelector('summary').focus()")
        press(browser, session, " ", 32, " ")
        if not value(browser, session, "document.querySelector('details').open"):
            faults.append("Space does not open a folded part")
    return faults, len(reached)


def take_sections(browser, session, folder, name):
    boxes = value(browser, session, """JSON.stringify(Array.from(document.querySelectorAll('header, section')).map((e) => {
      const b = e.getBoundingClientRect();
      return {id: e.id || 'head', x: b.left + scrollX, y: b.top + scrollY, width: b.width, height: b.height};
    }))""")
    for i, box in enumerate(boxes):
        clip = {key: box[key] for key in ("x", "y", "width", "height")} | {"scale": 1}
        shot = browser.ask("Page.captureScreenshot", session, format="png", captureBeyondViewport=True, clip=clip)
        pathlib.Path(folder, f"{name}_{i:02}_{box['id']}.png").write_bytes(base64.b64decode(shot["data"]))
    return len(boxes)


class Checker:
    def __init__(self, browser, folder):
        self.browser, self.folder = browser, folder
        self.faults = {name: [] for name in ("width", "print", "contrast", "keyboard", "network")}
        self.n_texts, self.least, self.n_reached, self.n_pictures = 0, 99.0, 0, 0

    def check(self, path):
        url, name = path.resolve().as_uri(), path.parent.name
        for width in WIDTHS:
            for scheme in ("light", "dark"):
                self.check_width(url, name, width, scheme)
        self.check_print(url, name)

    def check_width(self, url, name, width, scheme):
        where = f"{name} {width} px {scheme}: "
        target, session = open_page(self.browser, url, width, 900, width < 700, scheme)
        if scheme == "light" or width == 1280:
            self.n_pictures += take_sections(self.browser, session, self.folder, f"{name}_{width}_{scheme}")
        if width == 1280 and scheme == "light":
            faults, self.n_reached = check_keyboard(self.browser, session)
            self.faults["keyboard"] += [where + fault for fault in faults]
        self.browser.ask("Runtime.evaluate", session, expression=EXERCISE)
        self.browser.listen(0.3)
        measured = value(self.browser, session, MEASURE)
        if measured["overflow"] > 0 or measured["beyond"]:
            self.faults["width"].append(f"{where}{measured['overflow']} px too wide {measured['beyond'][:3]}")
        if measured["small"]:
            self.faults["width"].append(f"{where}small text {measured['small'][:3]}")
        if width in (390, 1280):
            contrast = value(self.browser, session, CONTRAST)
            self.n_texts += contrast["texts"]
            self.least = min(self.least, contrast["least"])
            self.faults["contrast"] += [where + bad for bad in contrast["bad"]]
        self.faults["network"] += [where + fault for fault in faults_of(self.browser.events, url)]
        self.browser.ask("Target.closeTarget", targetId=target)

    def check_print(self, url, name):
        target, session = open_page(self.browser, url, *PAPER_PX, False, "dark")
        self.browser.ask("Emulation.setEmulatedMedia", session, media="print")
        self.faults["print"] += [f"{name}: {cut}" for cut in value(self.browser, session, PRINTED)]
        pdf = self.browser.ask("Page.printToPDF", session, paperWidth=8.27, paperHeight=11.69, printBackground=True)
        pathlib.Path(self.folder, name + ".pdf").write_bytes(base64.b64decode(pdf["data"]))
        self.browser.ask("Target.closeTarget", targetId=target)


def main():
    folder, pages = pathlib.Path(sys.argv[1]), [pathlib.Path(page) for page in sys.argv[2:]]
    folder.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        browser = Browser(profile)
        try:
            checker = Checker(browser, folder)
            for page in pages:
                checker.check(page)
        finally:
            browser.close()
    measured = {"width": f"{len(pages)} pages at {', '.join(map(str, WIDTHS))} px", "print": f"{len(pages)} pages on A4",
                "contrast": f"{checker.n_texts} texts, least {checker.least:.2f}", "keyboard": f"{checker.n_reached} elements by Tab",
                "network": f"{len(pages)} pages, {checker.n_pictures} pictures of sections"}
    for name, faults in checker.faults.items():
        print(name, measured[name], len(faults), "; ".join(faults[:4]), sep="\t")


if __name__ == "__main__":
    main()
