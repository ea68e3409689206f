#include "drivers/camera/network/stream_address.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace drivers {
namespace {

constexpr StreamTransport kTcp = StreamTransport::kTcp;

std::string option(const StreamAddress& address, const std::string& key) {
  for (const auto& [name, value] : address.options)
    if (name == key) return value;
  return {};
}

std::string refusal(const std::string& source) {
  try {
    (void)stream_address(source, kTcp);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return {};
}

TEST(StreamAddress, RtspIsReliableUnlessUdpIsAskedFor) {
  const StreamAddress tcp = stream_address("rtsp://10.0.0.2:8554/main", kTcp);
  EXPECT_EQ(option(tcp, "rtsp_transport"), "tcp");
  EXPECT_FALSE(tcp.may_lose);
  const StreamAddress udp = stream_address("rtsp://10.0.0.2:8554/main", StreamTransport::kUdp);
  EXPECT_EQ(option(udp, "rtsp_transport"), "udp");
  EXPECT_TRUE(udp.may_lose);
  EXPECT_EQ(option(udp, "allowed_media_types"), "video");
}

TEST(StreamAddress, APasswordIsUsedAndNotShown) {
  const StreamAddress one = stream_address("rtsp://user:se@cret@camera/live", kTcp);
  EXPECT_EQ(one.url, "rtsp://user:se@cret@camera/live");
  EXPECT_EQ(one.shown, "rtsp://camera/live");
  EXPECT_EQ(stream_address("rtsp://camera:554/live?user=admin&password=secret", kTcp).shown, "rtsp://camera:554/...");
  EXPECT_EQ(stream_address("rtsp://camera/user=admin_password=secret_channel=1", kTcp).shown, "rtsp://camera/...");
  EXPECT_EQ(stream_address("rtsp://user:se/cret@camera/live", kTcp).shown, "rtsp://camera/live");
  EXPECT_EQ(refusal("rtmp://user:secret@camera/live").find("secret"), std::string::npos);
  EXPECT_EQ(refusal("rtsp://user:secret@camera:99999/live").find("secret"), std::string::npos);
}

TEST(StreamAddress, EachFormHasOneFormatAndItsProtocols) {
  EXPECT_STREQ(stream_address("rtsp://camera/", kTcp).format, "rtsp");
  const StreamAddress ts = stream_address("udp://239.1.2.3:5000", kTcp);
  EXPECT_STREQ(ts.format, "mpegts");
  EXPECT_STREQ(ts.protocols, "udp");
  EXPECT_EQ(ts.url, "udp://@239.1.2.3:5000");
  EXPECT_TRUE(ts.may_lose);
  EXPECT_EQ(stream_address("udp://:5000", kTcp).url, "udp://@:5000");
  EXPECT_EQ(stream_address("udp://@[::1]:5000", kTcp).url, "udp://@[::1]:5000");
  const StreamAddress tcp = stream_address("tcp://camera:5000", kTcp);
  EXPECT_STREQ(tcp.protocols, "tcp");
  EXPECT_FALSE(tcp.may_lose);
  const StreamAddress sdp = stream_address("a camera.sdp", kTcp);
  EXPECT_STREQ(sdp.format, "sdp");
  EXPECT_TRUE(sdp.url.starts_with("file:/")) << sdp.url;
}

TEST(StreamAddress, WhatIsNotListedIsRefusedInWords) {
  for (const char* source : {"", "clip.mp4", "http://camera/stream", "concat:a|b", "file:///etc/passwd", "rtsp://",
                             "rtsp:///live", "rtsp://camera:0/", "udp://", "udp://239.1.2.3", "udp://:70000",
                             "udp://:5000?localaddr=1.2.3.4", "tcp://:5000", "tcp://camera", "srt://camera:5000",
                             "rtsp://camera/a b", "rtsp://camera/\x1b[2J", "subfile,,start,0,end,0,,:a"}) {
    const std::string words = refusal(source);
    EXPECT_NE(words.find("rtsp://[USER:PASSWORD@]HOST"), std::string::npos) << source << ": " << words;
    EXPECT_EQ(words.find('\x1b'), std::string::npos);
  }
}

}  // namespace
}  // namespace drivers
