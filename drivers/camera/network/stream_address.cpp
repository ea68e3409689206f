#include "drivers/camera/network/stream_address.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include "drivers/storage/printable.h"
#include "drivers/storage/text_file.h"

namespace drivers {
namespace {

constexpr const char* kForms =
    "rtsp://[USER:PASSWORD@]HOST[:PORT]/PATH, udp://[HOST]:PORT or tcp://HOST:PORT (MPEG-TS), or the path of a session "
    "description that ends in .sdp";
constexpr const char* kSocketBytes = "4194304";  // a key frame at 100 Mbit/s, before the reader wakes
constexpr const char* kProbedMicroseconds = "2000000";

[[noreturn]] void refuse(const std::string& shown, const std::string& why) {
  throw std::invalid_argument(
      fmt::format("camera.source = {}: {}; driver: stream accepts {}", printable(shown), why, kForms));
}

// Without user and password, also where they stand in the path, as some cameras want it.
std::string without_password(const std::string& url) {
  const std::size_t host = url.find("://") + 3, at = url.rfind('@');
  std::string out = at == std::string::npos || at < host ? url : url.substr(0, host) + url.substr(at + 1);
  const std::size_t path = out.find('/', host);
  if (path != std::string::npos && out.find_first_of("?&=", path) != std::string::npos)
    out.replace(path, std::string::npos, "/...");
  return out;
}

struct HostPort {
  std::string host;
  std::string port;  // empty: none
};
HostPort host_and_port(std::string_view text) {
  const std::size_t bracket = text.find(']');  // of an IPv6 address
  const std::size_t colon = text.find(':', bracket == std::string_view::npos ? 0 : bracket);
  return {std::string(text.substr(0, colon)),
          colon == std::string_view::npos ? std::string() : std::string(text.substr(colon + 1))};
}

bool is_port(const std::string& text) {
  const auto value = parse_unsigned(text);
  return value && *value >= 1 && *value <= 65535;
}

StreamAddress rtsp(const std::string& source, StreamTransport transport) {
  StreamAddress out{.url = source,
                    .shown = without_password(source),
                    .format = "rtsp",
                    .protocols = "rtsp,rtp,tcp,udp",
                    .options = {},
                    .in_parts = true,
                    .may_lose = transport == StreamTransport::kUdp};
  const std::size_t host = out.shown.find("://") + 3;
  const HostPort where = host_and_port(std::string_view(out.shown).substr(host, out.shown.find('/', host) - host));
  if (where.host.empty()) refuse(out.shown, "it names no host");
  if (!where.port.empty() && !is_port(where.port)) refuse(out.shown, "its port is none of 1 .. 65535");
  out.options = {{"rtsp_transport", out.may_lose ? "udp" : "tcp"}, {"allowed_media_types", "video"}};
  return out;
}

StreamAddress transport_stream(const std::string& source, const char* protocol) {
  StreamAddress out{.url = source,
                    .shown = source,
                    .format = "mpegts",
                    .protocols = protocol,
                    .options = {},
                    .in_parts = false,
                    .may_lose = std::string_view(protocol) == "udp"};
  std::string_view rest = std::string_view(source).substr(source.find("://") + 3);
  if (rest.starts_with('@')) rest.remove_prefix(1);
  const HostPort where = host_and_port(rest);
  if (!is_port(where.port)) refuse(source, "it needs a port, 1 .. 65535, and nothing after it");
  if (!out.may_lose && where.host.empty()) refuse(source, "it names no host");
  if (out.may_lose) {
    out.url = fmt::format("udp://@{}:{}", where.host, where.port);
    out.options = {{"overrun_nonfatal", "1"}};
  }
  return out;
}

StreamAddress session(const std::string& source) {
  return {.url = "file:" + std::filesystem::absolute(source).string(),
          .shown = source,
          .format = "sdp",
          .protocols = "file,rtp,udp",
          .options = {},
          .in_parts = true,
          .may_lose = true};
}

StreamAddress address_of(const std::string& source, StreamTransport transport) {
  if (source.empty()) refuse("''", "it is empty");
  if (source.starts_with("rtsp://")) return rtsp(source, transport);
  if (source.starts_with("udp://")) return transport_stream(source, "udp");
  if (source.starts_with("tcp://")) return transport_stream(source, "tcp");
  if (source.find("://") != std::string::npos) refuse(without_password(source), "this scheme is not opened");
  if (source.ends_with(".sdp")) return session(source);
  refuse(source, "it is no address");
}

}  // namespace

StreamAddress stream_address(const std::string& source, StreamTransport transport) {
  if (std::any_of(source.begin(), source.end(), [](char c) { return c <= ' ' || c > '~'; }) &&
      !source.ends_with(".sdp"))
    refuse(source, "it holds a space or a character that is not ASCII");
  StreamAddress out = address_of(source, transport);
  if (out.may_lose) out.options.emplace_back("buffer_size", kSocketBytes);
  out.options.emplace_back("analyzeduration", kProbedMicroseconds);
  return out;
}

}  // namespace drivers
