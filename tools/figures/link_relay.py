#!/usr/bin/env python3
"""A bad radio link between two interfaces, where the kernel has no `tc netem`: carries Ethernet frames both ways, loses a
share of them at random, delays the rest, and passes no more than a rate; what would wait longer than half a second is
dropped, as in a radio's queue.

    link_relay.py IN OUT --loss 0.2 --delay-ms 100 --kbit-s 256 --seed 1 --count FILE

Ends on SIGTERM, and writes what it carried: frames, lost, overflowed, bytes, and the most bytes in a second, per way."""
import argparse
import heapq
import json
import random
import select
import signal
import socket
import time

ETH_P_ALL = 3
PACKET_OUTGOING = 4
MOST_QUEUED_S = 0.5


class Way:
    def __init__(self, options, seed):
        self.options, self.random = options, random.Random(seed)
        self.free_at = 0.0  # when the link has sent everything it was given
        self.count = {"frames": 0, "lost": 0, "overflowed": 0, "bytes": 0, "offered_bytes": 0}
        self.by_second = {}

    def due(self, frame, now):
        """When the frame arrives at the other side; None: it does not."""
        self.count["offered_bytes"] += len(frame)
        start = max(now, self.free_at)
        if start - now > MOST_QUEUED_S:
            self.count["overflowed"] += 1
            return None
        self.free_at = start + 8 * len(frame) / (1000.0 * self.options.kbit_s)
        if self.random.random() < self.options.loss:
            self.count["lost"] += 1
            return None
        self.count["frames"] += 1
        self.count["bytes"] += len(frame)
        second = int(now)
        self.by_second[second] = self.by_second.get(second, 0) + len(frame)
        return self.free_at + self.options.delay_ms / 1000.0

    def summary(self):
        return dict(self.count, most_bytes_in_a_second=max(self.by_second.values(), default=0))


def without_checksum(frame):
    """The kernel leaves a UDP checksum to a network card that is not there: 0 means that there is none."""
    is_ipv4 = frame[12:14] == b"\x08\x00" and frame[14] == 0x45
    if not is_ipv4 or frame[23] != socket.IPPROTO_UDP or (frame[20] & 0x3F or frame[21]):
        return frame
    return frame[:40] + b"\0\0" + frame[42:]


def open_interface(name):
    end = socket.socket(socket.AF_PACKET, socket.SOCK_RAW, socket.htons(ETH_P_ALL))
    end.bind((name, ETH_P_ALL))
    return end


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("ends", nargs=2)
    arguments.add_argument("--loss", type=float, default=0.0)
    arguments.add_argument("--delay-ms", type=float, default=0.0)
    arguments.add_argument("--kbit-s", type=float, default=1e6)
    arguments.add_argument("--seed", type=int, default=1)
    arguments.add_argument("--count", required=True)
    options = arguments.parse_args()
    signal.signal(signal.SIGTERM, lambda *_: (_ for _ in ()).throw(KeyboardInterrupt()))
    ends = [open_interface(name) for name in options.ends]
    ways = [Way(options, options.seed), Way(options, options.seed + 1000)]
    waiting, number = [], 0
    print("carrying", flush=True)
    try:
        while True:
            timeout = max(0.0, waiting[0][0] - time.monotonic()) if waiting else 1.0
            for end in select.select(ends, [], [], timeout)[0]:
                frame, address = end.recvfrom(65536)
                i = ends.index(end)
                at = None if address[2] == PACKET_OUTGOING else ways[i].due(frame, time.monotonic())
                if at is not None:
                    number += 1
                    heapq.heappush(waiting, (at, number, 1 - i, frame))
            while waiting and waiting[0][0] <= time.monotonic():
                _, _, to, frame = heapq.heappop(waiting)
                ends[to].send(without_checksum(frame))
    except KeyboardInterrupt:
        pass
    with open(options.count, "w", encoding="utf-8") as file:
        json.dump({"there": ways[0].summary(), "back": ways[1].summary()}, file, indent=1)


if __name__ == "__main__":
    main()
