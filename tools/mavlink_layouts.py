#!/usr/bin/env python3
"""Writes drivers/mavlink/mavlink_layouts.h from MAVLink's message definitions.

  tools/mavlink_layouts.py MAVLINK_CHECKOUT > drivers/mavlink/mavlink_layouts.h

MAVLINK_CHECKOUT: a checkout of https://github.com/mavlink/mavlink. Fields are ordered and the extra byte of the checksum
is computed as https://mavlink.io/en/guide/serialization.html states.
"""
import re
import subprocess
import sys
import xml.etree.ElementTree as xml

WANTED = ["HEARTBEAT", "ATTITUDE", "ATTITUDE_QUATERNION", "GLOBAL_POSITION_INT", "TIMESYNC", "WIND", "WIND_COV",
          "NAMED_VALUE_FLOAT", "STATUSTEXT", "GIMBAL_DEVICE_ATTITUDE_STATUS", "ESC_STATUS",
          "ESC_TELEMETRY_1_TO_4", "ESC_TELEMETRY_5_TO_8", "ESC_TELEMETRY_9_TO_12", "ONBOARD_COMPUTER_STATUS"]
FILES = ["minimal", "standard", "common", "ardupilotmega"]
SIZES = {"char": 1, "uint8_t": 1, "int8_t": 1, "uint16_t": 2, "int16_t": 2, "uint32_t": 4, "int32_t": 4, "float": 4,
         "uint64_t": 8, "int64_t": 8, "double": 8}


def crc_x25(data, crc=0xFFFF):
    for byte in data:
        t = byte ^ (crc & 0xFF)
        t = (t ^ (t << 4)) & 0xFF
        crc = ((crc >> 8) ^ (t << 8) ^ (t << 3) ^ (t >> 4)) & 0xFFFF
    return crc


class Field:
    def __init__(self, element, extension):
        text = element.get("type").replace("uint8_t_mavlink_version", "uint8_t")
        match = re.fullmatch(r"(\w+)(?:\[(\d+)\])?", text)
        self.type, self.count = match.group(1), int(match.group(2) or 0)
        self.name, self.extension = element.get("name"), extension
        self.size = SIZES[self.type] * max(self.count, 1)


class Message:
    def __init__(self, element):
        self.name, self.id = element.get("name"), int(element.get("id"))
        fields, extension = [], False
        for child in element:
            if child.tag == "extensions":
                extension = True
            elif child.tag == "field":
                fields.append(Field(child, extension))
        base = sorted((f for f in fields if not f.extension), key=lambda f: -SIZES[f.type])
        self.fields = base + [f for f in fields if f.extension]
        crc = crc_x25(f"{self.name} ".encode())
        for f in base:
            crc = crc_x25(f"{f.type} {f.name} ".encode(), crc)
            if f.count:
                crc = crc_x25(bytes([f.count]), crc)
        self.crc_extra = (crc & 0xFF) ^ (crc >> 8)
        self.size = sum(f.size for f in self.fields)


def main(checkout):
    commit = subprocess.run(["git", "-C", checkout, "log", "-1", "--format=%H %cs"], capture_output=True, text=True,
                            check=True).stdout.strip()
    found = {}
    for name in FILES:
        for element in xml.parse(f"{checkout}/message_definitions/v1.0/{name}.xml").getroot().iter("message"):
            message = Message(element)
            found[message.id] = message
    everything = [found[i] for i in sorted(found)]
    messages = [m for m in everything if m.name in WANTED]
    print("#pragma once\n\n#include <array>\n#include <cstddef>\n#include <cstdint>\n\nnamespace drivers {\n")
    print(f"// Written by tools/mavlink_layouts.py from MAVLink's message definitions, commit\n// {commit}"
          " (minimal, standard, common, ardupilotmega).\n")
    print("struct MavlinkLayout {\n  std::uint32_t id = 0;\n"
          "  std::uint8_t crc_extra = 0;  // completes the checksum\n"
          "  std::uint8_t size = 0;       // of the payload with all extensions, bytes\n};\n")
    print("// All messages, by id: with them a frame of any kind is distinguished from noise.")
    print(f"inline constexpr std::array<MavlinkLayout, {len(everything)}> kMavlinkLayouts{{{{")
    print("    " + " ".join(f"{{{m.id}, {m.crc_extra}, {m.size}}}," for m in everything))
    print("}};\n\n// Ids, and the places of fields in the payload, bytes, of the messages that are understood.\nstruct MavlinkFields {")
    for m in messages:
        camel = "".join(part.capitalize() for part in m.name.split("_"))
        print(f"struct {camel} {{\nstatic constexpr std::uint32_t kId = {m.id};")
        at = 0
        for f in m.fields:
            what = f.type + (f"[{f.count}]" if f.count else "")
            print(f"static constexpr std::size_t {f.name} = {at};  // {what}")
            at += f.size
        print("};")
    print("};\n\n}  // namespace drivers")


if __name__ == "__main__":
    if len(sys.argv) != 2 or sys.argv[1] in ("-h", "--help"):
        sys.exit(__doc__)
    main(sys.argv[1])
