#include "tools/hovermodal/ground/serve.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <ifaddrs.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <thread>

#include "drivers/storage/json.h"
#include "drivers/telemetry/lcm_listener.h"
#include "tools/hovermodal/ground/live_stream.h"
#include "tools/hovermodal/ground/page.h"
#include "tools/hovermodal/ground/web_server.h"
#include "tools/hovermodal/stop_signal.h"

namespace tools {
namespace {

constexpr int kEventPeriod_ms = 200;

void add_paths(WebServer& server, LiveStream& stream) {
  add_page(server, ground_page());
  server.add_get("/snapshot.json", [&](const WebRequest&) {
    return WebResponse{200, "application/json", stream.snapshot(drivers::LcmListener::now_ns())};
  });
  server.add_get("/preview.jpg", [&](const WebRequest&) {
    std::string jpeg = stream.preview_jpeg();
    if (jpeg.empty()) return WebResponse{404, "text/plain; charset=utf-8", "no picture has come yet\n"};
    return WebResponse{200, "image/jpeg", std::move(jpeg)};
  });
  server.add_event_source("/events", kEventPeriod_ms, [&] { return stream.news(drivers::LcmListener::now_ns()); });
}

// Every IPv4 address of this computer that others can reach, for a bind address that means all of them.
std::vector<std::string> own_addresses() {
  std::vector<std::string> out;
  ifaddrs* first = nullptr;
  if (getifaddrs(&first) != 0) return out;
  for (const ifaddrs* i = first; i != nullptr; i = i->ifa_next) {
    if (i->ifa_addr == nullptr || i->ifa_addr->sa_family != AF_INET) continue;
    std::array<char, INET_ADDRSTRLEN> text{};
    const auto* address = reinterpret_cast<const sockaddr_in*>(i->ifa_addr);
    inet_ntop(AF_INET, &address->sin_addr, text.data(), text.size());
    if (!is_loopback(text.data())) out.emplace_back(text.data());
  }
  freeifaddrs(first);
  return out;
}

void tell_where(const WebServer& server, const GroundOptions& options) {
  std::vector<std::string> urls;
  const std::string url = server.url();
  const std::string any = "//0.0.0.0:";
  if (const std::size_t at = url.find(any); at != url.npos) {
    for (const std::string& address : own_addresses())
      urls.push_back(url.substr(0, at + 2) + address + url.substr(at + any.size() - 1));
  } else {
    urls.push_back(url);
  }
  options.answer.document(
      drivers::to_json_text({{"listening_on", options.url}, {"prefix", options.prefix}, {"open", urls}}).text);
  options.answer.text("listening on {} for {}_*\n", options.url, options.prefix);
  for (const std::string& one : urls) options.answer.text("open {}\n", one);
  std::fflush(stdout);
}

WebOptions web_options(const GroundOptions& options) {
  WebOptions out;
  out.bind_address = options.bind_address;
  out.port = options.port;
  out.known_names = options.names;
  out.token = options.token;
  if (out.token.empty() && !is_loopback(options.bind_address)) out.token = random_token();
  return out;
}

}  // namespace

void run_ground(const GroundOptions& options) {
  if (options.answer.quiet && !options.answer.json && options.token.empty() && !is_loopback(options.bind_address))
    throw std::invalid_argument("ground --quiet: nobody would learn the random access token; give one by --token");
  LiveStream stream(options.prefix);
  WebServer server(web_options(options));
  add_paths(server, stream);
  drivers::LcmListener listener(options.url, options.prefix,
                                [&](std::string_view channel, const void* data, std::size_t n) {
                                  stream.receive(channel, data, n, drivers::LcmListener::now_ns());
                                });
  watch_stop_signals();
  server.start();
  tell_where(server, options);
  const std::int64_t end_ns = drivers::LcmListener::now_ns() + static_cast<std::int64_t>(options.seconds * 1e9);
  bool has_more = true;
  while (stop_requested == 0 && (options.seconds <= 0.0 || drivers::LcmListener::now_ns() < end_ns)) {
    if (!has_more) {
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    } else if (has_more = listener.poll(); !has_more) {
      options.answer.note("the log has ended; the page stays until you stop this (Ctrl-C)\n");
      std::fflush(stdout);
    }
  }
  server.stop();
}

}  // namespace tools
