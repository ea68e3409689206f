#!/usr/bin/env python3
"""Listens to hovermodald from Python: prints every whole estimate and the service's state.

    tools/examples/subscribe.py [--url URL] [--prefix PREFIX] [--seconds S] [--types FOLDER]

The message types come from `lcm-gen -p`, which the build has run (build/release/python); another place: --types.
With the module `lcm` (not in Debian) it listens through that, else through the receiver of UDP multicast in
lcm_receiver.py, which needs nothing but Python.
"""
import argparse
import os
import sys
import time

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import lcm_receiver  # noqa: E402

HERE = os.path.dirname(os.path.abspath(__file__))
TYPES = os.path.join(HERE, "..", "..", "build", "release", "python")


def shown(text):
    """What came over the network, without its control characters."""
    return "".join(c if c.isprintable() else "?" for c in text)


class Subscriber:
    def __init__(self, prefix, types):
        sys.path.insert(0, types)
        try:
            import hovermodal
        except ImportError:
            sys.exit(f"subscribe.py: no message types in {types}: build the project (tools/build.sh) or make them with "
                     f"`lcm-gen -p --ppath FOLDER drivers/telemetry/messages/*.lcm` and say --types FOLDER")
        self.types = {prefix + "_MODAL": hovermodal.modal_estimate_t, prefix + "_HEALTH": hovermodal.health_t}
        self.number, self.parts = None, {}
        self.n_read = self.n_not_understood = 0
        self.is_over = False

    def receive(self, channel, data):
        message_type = self.types.get(channel)
        if message_type is None:
            return
        try:
            message = message_type.decode(data)
        except Exception:  # any bytes may arrive; a generated decoder raises any exception
            # The first eight bytes identify the layout: the same unknown ones repeatedly mean a service of another version.
            if self.n_not_understood == 0 and data[:8] != message_type._get_packed_fingerprint():
                print(f"{channel}: not the layout of these types; is the service of the same version?")
            self.n_not_understood += 1
            return
        self.n_read += 1
        if channel.endswith("_HEALTH"):
            print(f"{shown(message.state)}: {message.frames_in} frames in, {message.frames_dropped} dropped", flush=True)
            self.is_over = message.state.startswith(("finished", "fault"))
        else:
            self.take_estimate(message)

    def take_estimate(self, message):
        if message.number != self.number:
            self.number, self.parts = message.number, {}
        self.parts[message.part] = message.modes  # an estimate comes in parts of one datagram each
        if len(self.parts) < message.n_parts:
            return
        print(f"estimate {message.number} of {shown(message.stream_id)}: {shown(message.status)}")
        for part in sorted(self.parts):
            for mode in self.parts[part]:
                if mode.is_structural:
                    print(f"  {mode.frequency_hz:9.4f} +- {mode.frequency_std_hz:.4f} Hz  "
                          f"damping {100 * mode.damping_ratio:5.2f} +- {100 * mode.damping_std:.2f} %", flush=True)


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--url", default="udpm://239.255.76.67:7667?ttl=0")
    arguments.add_argument("--prefix", default="HOVERMODAL")
    arguments.add_argument("--seconds", type=float, default=0.0, help="0: until the service has ended")
    arguments.add_argument("--types", default=TYPES)
    options = arguments.parse_args()
    subscriber = Subscriber(options.prefix, options.types)
    try:
        receiver = lcm_receiver.open_receiver(options.url, subscriber.receive)
    except (ValueError, OSError) as error:
        sys.exit(f"subscribe.py: \"{options.url}\": {error}; `hovermodal inspect lcm` says how to mend a network")
    print(f"listening on {options.url}", flush=True)
    begin = time.monotonic()
    while not subscriber.is_over and not (0 < options.seconds <= time.monotonic() - begin):
        receiver.handle(0.1)
    print(f"{subscriber.n_read} messages read, {subscriber.n_not_understood} not understood")


if __name__ == "__main__":
    main()
