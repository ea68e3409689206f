#!/usr/bin/env python3
"""What strangers may send to the ground station: fuzzed requests, slow clients, paths, other origins; a normal client
asks meanwhile. Usage: http_attack.py BIN CLIP OUT URL N_FUZZED N_SLOW SECONDS FIRST_SEED. Prints name, tab, value."""
import random
import resource
import selectors
import socket
import sys
import threading
import time

from station import Ground, service, tell

bin_folder, clip, out, url = sys.argv[1:5]
n_fuzzed, n_slow, slow_s = int(sys.argv[5]), int(sys.argv[6]), float(sys.argv[7])
first_seed = int(sys.argv[8])
TOKEN = "0123456789abcdef0123456789abcdef"
COOKIE = f"Cookie: hovermodal_token={TOKEN}\r\n"
PATHS = ["/../../etc/passwd", "/%2e%2e/%2e%2e/etc/passwd", "/..%2f..%2f..%2fetc%2fpasswd", "/%252e%252e/etc/passwd", "//etc/passwd",
         "/....//....//etc/passwd", "/etc/passwd%00.html", "/..\\..\\etc\\passwd", "/%5c..%5c..%5cetc%5cpasswd", "/./../etc/passwd",
         "http://127.0.0.1/../etc/passwd", "file:///etc/passwd", "/%c0%ae%c0%ae/%c0%ae%c0%ae/etc/passwd", "/snapshot.json/../../etc/passwd",
         "/page.css/", "/proc/self/environ", "/.git/config", "/%", "/%zz", "/\u202e"]


def ask(port, request, timeout_s=10.0):
    """Status and whole answer; 0 where the connection was closed without one, -1 where nothing came in time."""
    try:
        with socket.create_connection(("127.0.0.1", port), timeout=timeout_s) as s:
            s.sendall(request)
            whole = b""
            while more := s.recv(65536):
                whole += more
    except TimeoutError:
        return -1, b""
    except OSError:
        return 0, b""
    return (int(whole[9:12]) if whole[:9] == b"HTTP/1.1 " and whole[9:12].isdigit() else 0), whole


def get(path, headers=COOKIE, host="127.0.0.1"):
    return f"GET {path} HTTP/1.1\r\nHost: {host}\r\n{headers}\r\n".encode()


def fuzz(port):
    good = [get("/"), get("/snapshot.json?a=b"), get("/preview.jpg", COOKIE + "Accept: */*\r\nRange: bytes=0-1\r\n"),
            b"POST / HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: 4\r\n\r\nabcd"]
    n_unanswered = n_faults = 0
    for seed in range(first_seed, first_seed + n_fuzzed):
        draw = random.Random(seed)
        data = bytearray(draw.choice(good))
        for _ in range(draw.randint(1, 12)):
            at = draw.randrange(len(data))
            what = draw.randrange(4)
            if what == 0:
                data[at] = draw.randrange(256)
            elif what == 1:
                data[at:at] = bytes(draw.randrange(256) for _ in range(draw.randint(1, 40)))
            elif what == 2:
                del data[at:at + draw.randint(1, 10)]
            else:
                data[at:at] = draw.choice([b"%00", b"\r\n", b"A" * 9000, b"Content-Length: 99999999999\r\n", b"%2e%2e/", b"?token=", b"&" * 500])
            if not data:
                data = bytearray(b"\r\n\r\n")
        status, _ = ask(port, bytes(data) + b"\r\n\r\n")
        n_unanswered += status == -1
        n_faults += status >= 500 and status != 501
    tell("fuzzed", n_fuzzed)
    tell("fuzzed_unanswered", n_unanswered)
    tell("fuzzed_faults", n_faults)


class NormalClient(threading.Thread):
    """Asks for the page ten times a second."""

    def __init__(self, port):
        super().__init__(daemon=True)
        self.port, self.stop, self.times_ms, self.n_failed = port, False, [], 0

    def run(self):
        while not self.stop:
            begin = time.monotonic()
            status, _ = ask(self.port, get("/"))
            self.times_ms.append(1000 * (time.monotonic() - begin))
            self.n_failed += status != 200
            time.sleep(0.1)


def slow_clients(port):
    """Clients that send a byte of a request now and then, and come back when they are closed."""
    clients, chosen = {}, selectors.DefaultSelector()

    def begin():
        s = socket.socket()
        s.setblocking(False)
        s.connect_ex(("127.0.0.1", port))
        clients[s] = 0
        chosen.register(s, selectors.EVENT_READ)

    request, n_opened = b"GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nA: " + b"a" * 4000, 0
    end = time.monotonic() + slow_s
    while time.monotonic() < end:
        while len(clients) < n_slow:
            begin()
            n_opened += 1
        for key, _ in chosen.select(0.05):
            try:
                is_over = not key.fileobj.recv(4096)
            except OSError:
                is_over = True
            if is_over:
                chosen.unregister(key.fileobj)
                clients.pop(key.fileobj)
                key.fileobj.close()
        for s in random.Random(first_seed + n_opened).sample(list(clients), len(clients) // 10):
            try:
                clients[s] += s.send(request[clients[s]:clients[s] + 1])
            except OSError:
                pass
    for s in clients:
        s.close()
    tell("slow_connections", n_opened)


def slow_readers(port):
    """Ask for everything and read nothing; more event streams than there is room for."""
    held, statuses = [], []
    for i in range(200):
        s = socket.create_connection(("127.0.0.1", port), timeout=10)
        s.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 2048)
        s.sendall(get("/events" if i % 4 == 0 else "/snapshot.json"))
        held.append(s)
    time.sleep(3)
    for s in held[::4]:
        s.settimeout(1)
        try:
            statuses.append(s.recv(12)[9:12])
        except OSError:
            statuses.append(b"")
    tell("streams_open", statuses.count(b"200"))
    tell("page_beside_slow_readers", ask(port, get("/"))[0])
    for s in held:
        s.close()


def main():
    resource.setrlimit(resource.RLIMIT_NOFILE, (min(8192, resource.getrlimit(resource.RLIMIT_NOFILE)[1]),) * 2)
    ground = Ground(bin_folder, url, out, 0, ("--token", TOKEN))
    flight = service(bin_folder, clip, url, out, "spectrum.segment=128")
    port = ground.port
    try:
        flight_begin = None
        while not flight_begin or not flight_begin["link"]["heard"]:
            time.sleep(0.5)
            flight_begin = json_snapshot(port)
        tell("normal", ask(port, get("/"))[0])
        fuzz(port)
        statuses = [ask(port, get(path))[0] for path in PATHS]
        tell("paths", len(PATHS))
        tell("paths_not_refused", sum(s not in (0, 400, 404) for s in statuses))
        other = [get("/", COOKIE, "evil.example"), get("/", COOKIE, "127.0.0.1.evil.example:8086"), get("/snapshot.json", COOKIE + "Origin: http://evil.example\r\n"),
                 get("/events", COOKIE + "Sec-Fetch-Site: cross-site\r\nSec-Fetch-Mode: cors\r\n"), get("/", COOKIE + "Origin: null\r\n"),
                 get("/preview.jpg", COOKIE + "Sec-Fetch-Site: cross-site\r\nSec-Fetch-Mode: no-cors\r\nSec-Fetch-Dest: image\r\n")]
        tell("origins_not_refused", sum(ask(port, r)[0] != 403 for r in other))
        wrong = [get("/", ""), get("/?token=wrong", ""), get("/events", "Cookie: hovermodal_token=" + TOKEN[:-1] + "0\r\n"), get("/?token=" + TOKEN + "0", "")]
        tell("tokens_not_refused", sum(ask(port, r)[0] != 401 for r in wrong))
        before = ground.resident_bytes()
        client = NormalClient(port)
        client.start()
        slow_clients(port)
        client.stop = True
        client.join(15)
        times = sorted(client.times_ms)
        tell("normal_asked", len(times))
        tell("normal_failed", client.n_failed)
        tell("normal_median_ms", f"{times[len(times) // 2]:.1f}")
        tell("normal_worst_ms", f"{times[-1]:.1f}")
        slow_readers(port)
        tell("grown_bytes", ground.resident_bytes() - before)
        tell("resident_bytes", ground.resident_bytes())
        end = json_snapshot(port)
        tell("alive", ground.program.poll() is None and ask(port, get("/"))[0] == 200)
        tell("service_frames", end["health"]["frames_processed"])
        tell("service_frames_dropped", end["health"]["frames_dropped"])
        tell("messages_lost", sum(t["lost"] for t in end["link"]["topics"].values()))
    finally:
        flight.stop()
        ground.stop()


def json_snapshot(port):
    import json
    status, whole = ask(port, get("/snapshot.json"))
    return json.loads(whole.split(b"\r\n\r\n", 1)[1]) if status == 200 else None


main()
