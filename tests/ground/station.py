"""Starts and stops the programs that the ground page's checks need."""
import http.client
import json
import os
import re
import signal
import subprocess
import time


class Program:
    def __init__(self, arguments, log):
        self.log = open(log, "w+")
        self.program = subprocess.Popen(arguments, stdout=self.log, stderr=subprocess.STDOUT)

    def text(self):
        return open(self.log.name).read()

    def wait_for(self, pattern, patience_s=30):
        for _ in range(int(patience_s * 20)):
            found = re.search(pattern, self.text())
            if found:
                return found
            if self.program.poll() is not None:
                break
            time.sleep(0.05)
        raise RuntimeError("not seen: " + pattern + " in\n" + self.text()[-2000:])

    def send(self, number):
        self.program.send_signal(number)

    def stop(self, number=signal.SIGTERM):
        if self.program.poll() is None:
            self.program.send_signal(signal.SIGCONT)
            self.program.send_signal(number)
            try:
                self.program.wait(20)
            except subprocess.TimeoutExpired:
                self.program.kill()
                self.program.wait()
        self.log.close()

    def resident_bytes(self):
        for line in open(f"/proc/{self.program.pid}/status"):
            if line.startswith("VmRSS"):
                return int(line.split()[1]) * 1024
        return 0


class Ground(Program):
    def __init__(self, bin_folder, url, out, port=0, more=()):
        super().__init__([os.path.join(bin_folder, "hovermodal"), "ground", "--url", url, "--port", str(port), *more],
                         os.path.join(out, f"ground_{time.monotonic_ns()}.log"))
        self.page = self.wait_for(r"open (http://\S+)").group(1)
        self.port = int(re.search(r":(\d+)/", self.page).group(1))

    def snapshot(self):
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=10)
        connection.request("GET", "/snapshot.json")
        return json.loads(connection.getresponse().read())


def service(bin_folder, clip, url, out, *settings):
    arguments = [os.path.join(bin_folder, "hovermodald"), "--config", os.path.join(clip, "config.yaml")]
    for setting in ("camera.pace=realtime", "telemetry.lcm_url=" + url, *settings):
        arguments += ["--set", setting]
    return Program(arguments, os.path.join(out, f"service_{time.monotonic_ns()}.log"))


def tell(name, value):
    print(f"{name}\t{value}", flush=True)
