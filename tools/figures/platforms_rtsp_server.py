#!/usr/bin/env python3
"""An RTSP server on the loopback, by GStreamer, that loses packets: GStreamer's own elements read, code and pack the pictures, all of them key frames.
  platforms_rtsp_server.py PORT LOSS VIDEO QUANTIZER      rtsp://127.0.0.1:PORT/video; LOSS: share of the RTP packets that are not sent
VIDEO: a file, or "numbered": pictures that carry their number, 25 a second, without end. Prints "ready" once it listens."""
import sys

import gi

gi.require_version("Gst", "1.0")
gi.require_version("GstRtspServer", "1.0")
from gi.repository import GLib, Gst, GstRtspServer  # noqa: E402

BITS, BIT_PX, HEIGHT, RATE = 12, 16, 64, 25


def numbered(source, _length, state):
    number = state["n"]
    row = b"".join(bytes([224 if number >> bit & 1 else 32]) * BIT_PX for bit in range(BITS))
    buffer = Gst.Buffer.new_wrapped(row * HEIGHT)
    buffer.pts, buffer.duration = number * Gst.SECOND // RATE, Gst.SECOND // RATE
    state["n"] += 1
    source.emit("push-buffer", buffer)


def main():
    port, loss, video, quantizer = sys.argv[1], float(sys.argv[2]), sys.argv[3], sys.argv[4]
    Gst.init(None)
    pack = (f"videoconvert ! video/x-raw,format=I420 ! x264enc key-int-max=1 speed-preset=ultrafast tune=zerolatency threads=1 quantizer={quantizer} pass=quant ! "
            f"rtph264pay config-interval=-1 mtu=1400 ! identity drop-probability={loss} name=pay0")
    factory = GstRtspServer.RTSPMediaFactory()
    if video == "numbered":
        caps = f"video/x-raw,format=GRAY8,width={BITS * BIT_PX},height={HEIGHT},framerate={RATE}/1"
        factory.set_launch(f"( appsrc name=pictures is-live=false format=time block=true max-buffers=4 caps={caps} ! {pack} )")
        factory.connect("media-configure", lambda _, media: media.get_element().get_by_name("pictures").connect("need-data", numbered, {"n": 0}))
    else:
        factory.set_launch(f"( filesrc location={video} ! decodebin ! {pack} )")
    server = GstRtspServer.RTSPServer()
    server.set_address("127.0.0.1")
    server.set_service(port)
    server.get_mount_points().add_factory("/video", factory)
    if server.attach(None) == 0:
        sys.exit(f"port {port} is taken")
    print("ready", flush=True)
    GLib.MainLoop().run()


main()
