"""Receives LCM messages in Python: through the module `lcm` where there is one, else from UDP multicast with the standard
library alone. A message up to some 1400 bytes is one datagram, "LC02", number, channel, zero, data; a longer one comes in
fragments, "LC03", number, size, offset, index, count, the first of them with the channel."""
import re
import select
import socket
import struct

SHORT, FRAGMENT = b"LC02", b"LC03"
MOST_BYTES = 1 << 20  # of a message; those of the service are far smaller
MOST_OPEN = 64  # messages whose fragments are incomplete, over all senders


class MulticastReceiver:
    def __init__(self, url, take):
        found = re.fullmatch(r"udpm://([0-9.]+):([0-9]+)(\?.*)?", url)
        if not found:
            raise ValueError("expected udpm://GROUP:PORT?ttl=N")
        group, port = found[1], int(found[2])
        self.take, self.open, self.n_bad = take, {}, 0
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEPORT, 1)
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 22)
        self.socket.bind((group, port))
        self.socket.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP,
                               socket.inet_aton(group) + socket.inet_aton("0.0.0.0"))

    def handle(self, timeout_s):
        """Takes all datagrams that are there; waits for the first."""
        while select.select([self.socket], [], [], timeout_s)[0]:
            datagram, sender = self.socket.recvfrom(65536)
            self.receive(datagram, sender)
            timeout_s = 0

    def receive(self, datagram, sender):
        if datagram[:4] == SHORT:
            channel, zero, data = datagram[8:].partition(b"\0")
            self.hand_over(channel, data) if zero else self.count_bad()
        elif datagram[:4] == FRAGMENT and len(datagram) >= 20:
            self.receive_fragment(datagram, sender)
        else:
            self.count_bad()

    def receive_fragment(self, datagram, sender):
        number, size, offset, index, n_fragments = struct.unpack(">IIIHH", datagram[4:20])
        data = datagram[20:]
        channel = None
        if index == 0:
            channel, _, data = data.partition(b"\0")
        if size > MOST_BYTES or offset + len(data) > size or index >= n_fragments:
            return self.count_bad()
        key = (sender, number, size, n_fragments)
        if key not in self.open and len(self.open) >= MOST_OPEN:
            self.open.pop(next(iter(self.open)))  # the oldest, of which a fragment was lost
        message = self.open.setdefault(key, {"channel": None, "parts": {}})
        message["parts"][index] = (offset, data)
        message["channel"] = channel if channel is not None else message["channel"]
        if len(message["parts"]) < n_fragments:
            return
        del self.open[key]
        whole = b"".join(part for _, part in sorted(message["parts"].values()))
        self.hand_over(message["channel"] or b"", whole) if len(whole) == size else self.count_bad()

    def hand_over(self, channel, data):
        self.take(channel.decode("ascii", "replace"), data)

    def count_bad(self):
        self.n_bad += 1


class LibraryReceiver:
    def __init__(self, lcm, url, take):
        self.lcm = lcm.LCM(url)
        self.lcm.subscribe(".*", take)

    def handle(self, timeout_s):
        self.lcm.handle_timeout(int(timeout_s * 1000))


def open_receiver(url, take):
    """`take(channel, data)` is called by handle() for every message."""
    try:
        import lcm
    except ImportError:
        return MulticastReceiver(url, take)
    return LibraryReceiver(lcm, url, take)
