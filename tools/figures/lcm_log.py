#!/usr/bin/env python3
"""What LCM event logs hold, message by message, apart from the project's own reader.
    lcm_log.py count LOG             per channel: messages, missing between the first and the last by sequence, bytes
    lcm_log.py final LOG TYPES       the last status: state, frames_dropped, warnings, and n_sent / n_held_back per channel
    lcm_log.py estimates LOG TYPES   a line per estimate: stream time of its last frame (s), structural modes, those with a sigma
    lcm_log.py changes LOG TYPES     a line per change that residual diagnosis reported
    lcm_log.py swap LOG TYPES        seconds from the first report with a correction to the first estimate that names one
    lcm_log.py all-types LOG RECORD OUT TYPES   the log with what a record has besides, and twenty messages of type attitude_t
Prints JSON, `estimates`, `changes` and `swap` text. TYPES: the folder of the Python types (build/release/python)."""
import json
import math
import struct
import sys

SYNC = 0xEDA1DA01


def events(path):
    with open(path, "rb") as file:
        while len(head := file.read(28)) == 28:
            sync, number, time_us, channel_bytes, data_bytes = struct.unpack(">IqqII", head)
            if sync != SYNC:
                raise ValueError(f"{path}: no event where one should begin")
            channel = file.read(channel_bytes).decode()
            yield number, time_us, channel, file.read(data_bytes)


def sequence_of(data):
    """Every message begins with its fingerprint, stream_id and sequence."""
    (n_text,) = struct.unpack(">I", data[8:12])
    return struct.unpack(">q", data[12 + n_text:20 + n_text])[0]


def count(path):
    out = {}
    for _, _, channel, data in events(path):
        if not channel.startswith("HOVERMODAL_") or channel.endswith("_SELFTEST"):
            continue
        one = out.setdefault(channel, {"messages": 0, "bytes": 0, "sequences": set()})
        one["messages"] += 1
        one["bytes"] += len(data)
        one["sequences"].add(sequence_of(data))
    for one in out.values():
        numbers = one.pop("sequences")
        one["first"], one["last"] = min(numbers), max(numbers)
        one["missing"] = one["last"] - one["first"] + 1 - len(numbers)
    return out


def final(path, types):
    sys.path.insert(0, types)
    import hovermodal
    last = None
    for _, _, channel, data in events(path):
        if channel.endswith("_HEALTH"):
            last = data
    health = hovermodal.health_t.decode(last)
    return {"state": health.state, "frames_in": health.frames_in, "estimates": health.estimates, "frames_dropped": health.frames_dropped,
            "messages_failed": health.messages_failed, "duration_s": health.stream_time_ns * 1e-9,
            "warnings": list(health.warnings),
            "channels": {c.lcm_channel: {"n_sent": c.n_sent, "n_held_back": c.n_held_back} for c in health.counts}}


def estimates(path, types):
    sys.path.insert(0, types)
    import hovermodal
    found = {}
    for _, _, channel, data in events(path):
        if "_MODAL" not in channel:
            continue
        part = hovermodal.modal_estimate_t.decode(data)
        time_s, modes = found.setdefault(part.number, (part.stream_time_ns * 1e-9, []))
        modes += [mode for mode in part.modes if mode.is_structural]
    for _, (time_s, modes) in sorted(found.items()):
        print(f"{time_s:.2f} {len(modes)} {sum(math.isfinite(mode.frequency_std_hz) for mode in modes)}")


def changes(path, types):
    sys.path.insert(0, types)
    import hovermodal
    for _, _, channel, data in events(path):
        if "_CLOSURE" in channel:
            for words in hovermodal.closure_report_t.decode(data).changes:
                print(words)


def swap(path, types):
    sys.path.insert(0, types)
    import hovermodal
    told_ns = None
    for _, _, channel, data in events(path):
        if "_CLOSURE" in channel and told_ns is None:
            report = hovermodal.closure_report_t.decode(data)
            if any("taken out" in words for words in report.changes):
                told_ns = report.utc_ns
                print("; ".join(report.changes))
        elif "_MODAL" in channel and told_ns is not None:
            part = hovermodal.modal_estimate_t.decode(data)
            if part.n_amendments > 0:
                print(f"seconds {(part.utc_ns - told_ns) * 1e-9:.2f}")
                return


def all_types(path, record, out, types):
    sys.path.insert(0, types)
    import hovermodal
    all_events = list(events(path))
    begin, step = all_events[0][1], (all_events[-1][1] - all_events[0][1]) // 20
    heard = {event[2] for event in all_events}
    besides = [event for event in events(record) if event[2] not in heard]
    n = {name: sum(event[2] == name for event in besides) for name in {event[2] for event in besides}}
    taken = dict.fromkeys(n, 0)
    for event in besides:  # twenty of each, over the whole log
        name, taken[event[2]] = event[2], taken[event[2]] + 1
        if taken[name] <= 20:
            for again in range(0, 20 if n[name] < 20 else 1):
                all_events.append((0, begin + (taken[name] - 1 + again) % 20 * step, name, event[3]))
    for i in range(20):
        message = hovermodal.attitude_t()
        message.time_ns, message.wxyz = i * 10_000_000, [1.0, 0.0, 0.0, 0.0]
        all_events.append((0, begin + i * step, "ATTITUDE", message.encode()))
    with open(out, "wb") as file:
        for number, (_, time_us, channel, data) in enumerate(sorted(all_events, key=lambda event: event[1])):
            name = channel.encode()
            file.write(struct.pack(">IqqII", SYNC, number, time_us, len(name), len(data)) + name + data)
    return {"events": len(all_events)}


if __name__ == "__main__":
    texts = {"estimates": estimates, "changes": changes, "swap": swap}
    if sys.argv[1] in texts:
        texts[sys.argv[1]](*sys.argv[2:])
    else:
        print(json.dumps({"count": count, "final": final, "all-types": all_types}[sys.argv[1]](*sys.argv[2:]), indent=1))
