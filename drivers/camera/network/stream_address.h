#pragma once

#include <string>
#include <utility>
#include <vector>

#include "drivers/camera/camera_kind.h"

namespace drivers {

// A sender of live video. Only what is listed here is ever handed to libavformat, with the one format and the protocols
// that it needs:
//   rtsp://[USER:PASSWORD@]HOST[:PORT]/PATH       an IP camera, a GStreamer or MediaMTX server
//   udp://[HOST]:PORT, tcp://HOST:PORT            MPEG-TS; udp: HOST is the own or a multicast address, none: any
//   FILE.sdp                                      RTP as a session description names it
struct StreamAddress {
  std::string url;                                           // for libavformat
  std::string shown;                                         // without user, password and query
  const char* format = "";                                   // name of its demuxer
  const char* protocols = "";                                // comma-separated
  std::vector<std::pair<std::string, std::string>> options;  // of demuxer and protocols
  bool in_parts = false;                                     // RTP: a packet may be a part of a picture
  bool may_lose = false;                                     // packets that are lost are not sent again
};

// Throws std::invalid_argument: what is wrong with `source`, and the forms above.
[[nodiscard]] StreamAddress stream_address(const std::string& source, StreamTransport transport);

}  // namespace drivers
