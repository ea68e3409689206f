"""A browser without a screen, steered over its DevTools socket. Needs Python's own library and Debian's chromium."""
import base64
import http.client
import json
import os
import shutil
import socket
import struct
import subprocess
import tempfile
import time


class Browser:
    """One window with one page. Collects what the page's console said."""

    FLAGS = ["--headless=new", "--remote-debugging-port=0", "--no-sandbox", "--disable-gpu", "--no-first-run",
             "--disable-background-networking", "--disable-component-update", "--disable-sync", "--disable-extensions",
             "--no-default-browser-check", "--hide-scrollbars", "--js-flags=--expose-gc",
             "--enable-precise-memory-info", "--host-resolver-rules=MAP * ~NOTFOUND, EXCLUDE 127.0.0.1, EXCLUDE localhost"]

    def __init__(self, width=1320, height=900):
        self.folder = tempfile.mkdtemp(prefix="hovermodal-browser-")
        self.program = subprocess.Popen(
            ["chromium", *self.FLAGS, f"--user-data-dir={self.folder}", f"--window-size={width},{height}", "about:blank"],
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        port = self._port()
        page = next(t for t in self._json(port, "/json/list") if t["type"] == "page")
        self.socket = WebSocket("127.0.0.1", port, page["webSocketDebuggerUrl"].split(str(port), 1)[1])
        self.number, self.console, self.network, self.received_bytes = 0, [], [], 0
        for domain in ("Page", "Runtime", "Log", "Network", "HeapProfiler"):
            self.call(domain + ".enable")

    def _port(self):
        path = os.path.join(self.folder, "DevToolsActivePort")
        for _ in range(600):
            if os.path.exists(path):
                lines = open(path).read().split("\n")
                if len(lines) >= 2 and lines[0]:
                    return int(lines[0])
            time.sleep(0.1)
        raise RuntimeError("chromium did not start within 60 s")

    @staticmethod
    def _json(port, path):
        for _ in range(100):
            try:
                connection = http.client.HTTPConnection("127.0.0.1", port, timeout=10)
                connection.request("GET", path)
                found = json.loads(connection.getresponse().read())
                if found:
                    return found
            except OSError:
                pass
            time.sleep(0.1)
        raise RuntimeError("chromium does not answer on its DevTools port")

    def _event(self, message):
        method, p = message.get("method"), message.get("params", {})
        if method == "Runtime.exceptionThrown":
            detail = p["exceptionDetails"]
            self.console.append("exception: " + detail.get("exception", {}).get("description", detail.get("text", "?")))
        elif method == "Runtime.consoleAPICalled" and p["type"] in ("error", "warning", "assert"):
            self.console.append(p["type"] + ": " + " ".join(str(a.get("value", a.get("description"))) for a in p["args"]))
        elif method == "Log.entryAdded" and p["entry"]["level"] in ("error", "warning"):
            entry = p["entry"]
            line = f'{entry["source"]} {entry["level"]}: {entry["text"]} {entry.get("url", "")}'
            (self.network if entry["source"] == "network" else self.console).append(line)
        elif method == "Network.loadingFinished":
            self.received_bytes += p["encodedDataLength"]

    def call(self, method, params=None, timeout_s=60):
        self.number += 1
        number = self.number
        self.socket.send(json.dumps({"id": number, "method": method, "params": params or {}}))
        deadline = time.monotonic() + timeout_s
        while time.monotonic() < deadline:
            message = json.loads(self.socket.receive(deadline - time.monotonic()))
            if message.get("id") == number:
                if "error" in message:
                    raise RuntimeError(f"{method}: {message['error']}")
                return message.get("result", {})
            self._event(message)
        raise RuntimeError(f"{method}: no answer within {timeout_s} s")

    def run(self, script, timeout_s=60):
        """The value of a JavaScript expression; promises are waited for."""
        result = self.call("Runtime.evaluate", {"expression": script, "returnByValue": True, "awaitPromise": True}, timeout_s)
        if "exceptionDetails" in result:
            raise RuntimeError(script[:80] + ": " + json.dumps(result["exceptionDetails"])[:400])
        return result["result"].get("value")

    def wait(self, script, patience_s):
        """Seconds until the expression became true; None where it did not."""
        begin = time.monotonic()
        while time.monotonic() - begin < patience_s:
            if self.run(script):
                return time.monotonic() - begin
            time.sleep(0.1)
        return None

    def open(self, url):
        self.call("Page.navigate", {"url": url})

    def size(self, width, height, scale=1, mobile=False):
        self.call("Emulation.setDeviceMetricsOverride",
                  {"width": width, "height": height, "deviceScaleFactor": scale, "mobile": mobile})

    def picture(self, path, full=True):
        shot = self.call("Page.captureScreenshot", {"format": "png", "captureBeyondViewport": full})
        with open(path, "wb") as out:
            out.write(base64.b64decode(shot["data"]))

    def heap_bytes(self):
        self.call("HeapProfiler.collectGarbage")
        return int(self.call("Runtime.getHeapUsage")["usedSize"])

    def close(self):
        self.socket.close()
        self.program.terminate()
        try:
            self.program.wait(10)
        except subprocess.TimeoutExpired:
            self.program.kill()
            self.program.wait()
        shutil.rmtree(self.folder, ignore_errors=True)


class WebSocket:
    """RFC 6455, as much as DevTools needs: text, one thread."""

    def __init__(self, host, port, path):
        self.socket = socket.create_connection((host, port), timeout=30)
        key = base64.b64encode(os.urandom(16)).decode()
        self.socket.sendall((f"GET {path} HTTP/1.1\r\nHost: {host}:{port}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                             f"Sec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n\r\n").encode())
        self.buffer = b""
        while b"\r\n\r\n" not in self.buffer:
            self.buffer += self.socket.recv(4096)
        head, self.buffer = self.buffer.split(b"\r\n\r\n", 1)
        if b" 101 " not in head.split(b"\r\n")[0]:
            raise RuntimeError("DevTools refuses: " + head.decode(errors="replace")[:200])

    def send(self, text):
        data = text.encode()
        mask = os.urandom(4)
        if len(data) < 126:
            head = struct.pack("!BB", 0x81, 0x80 | len(data))
        elif len(data) < 65536:
            head = struct.pack("!BBH", 0x81, 0x80 | 126, len(data))
        else:
            head = struct.pack("!BBQ", 0x81, 0x80 | 127, len(data))
        key = (mask * (len(data) // 4 + 1))[:len(data)]
        masked = (int.from_bytes(data, "big") ^ int.from_bytes(key, "big")).to_bytes(len(data), "big") if data else b""
        self.socket.sendall(head + mask + masked)

    def _exactly(self, n):
        while len(self.buffer) < n:
            more = self.socket.recv(1 << 16)
            if not more:
                raise RuntimeError("the browser has gone")
            self.buffer += more
        out, self.buffer = self.buffer[:n], self.buffer[n:]
        return out

    def receive(self, timeout_s):
        self.socket.settimeout(max(0.01, timeout_s))
        whole = b""
        while True:
            first, second = self._exactly(2)
            n = second & 0x7F
            if n == 126:
                n = struct.unpack("!H", self._exactly(2))[0]
            elif n == 127:
                n = struct.unpack("!Q", self._exactly(8))[0]
            data = self._exactly(n)
            if first & 0x0F in (0, 1, 2):
                whole += data
                if first & 0x80:
                    return whole.decode()

    def close(self):
        self.socket.close()
