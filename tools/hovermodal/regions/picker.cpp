#include "tools/hovermodal/regions/picker.h"

#include <stdexcept>

#ifndef HOVERMODAL_WITH_GROUND

void tools::run_picker(const std::vector<core::Region>&, const std::string&, const PickerOptions&) {
  throw std::runtime_error(
      "regions --serve: this build has no web server. Install libboost-dev and LCM (tools/setup.sh) and "
      "configure again with -DWITH_GROUND=ON, or write the file by hand.");
}

#else

#include <chrono>
#include <cstdio>
#include <thread>

#include "drivers/storage/json.h"
#include "tools/hovermodal/ground/page.h"
#include "tools/hovermodal/ground/web_server.h"
#include "tools/hovermodal/regions/regions_text.h"
#include "tools/hovermodal/stop_signal.h"

namespace tools {
namespace {

constexpr int kPoll_ms = 50;

WebResponse plain(int status, std::string text) {
  return {status, "text/plain; charset=utf-8", std::move(text) + "\n"};
}

// Writes the page's regions to the file; an error is shown beside the page's button.
WebResponse take_regions(const WebRequest& request, const PickerOptions& options, std::string& current) {
  std::vector<core::Region> regions;
  try {
    regions = read_regions(request.body, options.width_px, options.height_px);
  } catch (const std::invalid_argument& e) {
    return plain(422, std::string("not saved: ") + e.what());
  }
  try {
    drivers::write_file_atomically(options.out, regions_yaml(regions));
  } catch (const std::exception& e) {
    return plain(500, std::string("not saved: ") + e.what());
  }
  current = regions_json(regions, options.width_px, options.height_px);
  return plain(200, "saved to " + options.out);
}

}  // namespace

void run_picker(const std::vector<core::Region>& regions, const std::string& frame_png, const PickerOptions& options) {
  WebOptions web;
  web.port = options.port;
  web.allow_post = true;
  WebServer server(web);  // loopback address: no other computer may write files here
  std::string current = regions_json(regions, options.width_px, options.height_px);
  add_page(server, regions_page());
  server.add_asset("/frame.png", "image/png", frame_png);
  server.add_get("/regions.json", [&](const WebRequest&) { return WebResponse{200, "application/json", current}; });
  server.add_post("/regions", [&](const WebRequest& request) { return take_regions(request, options, current); });
  watch_stop_signals();
  server.start();
  std::printf("open %s\nSave writes %s; Ctrl-C ends.\n", server.url().c_str(), options.out.c_str());
  std::fflush(stdout);
  while (stop_requested == 0) std::this_thread::sleep_for(std::chrono::milliseconds(kPoll_ms));
  server.stop();
}

}  // namespace tools
#endif
