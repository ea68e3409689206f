#include <CLI/CLI.hpp>
#include <memory>
#include <stdexcept>
#include <string>

#include "tools/hovermodal/commands.h"
#include "tools/hovermodal/inspect/telemetry.h"
#include "tools/hovermodal/spy/session.h"

namespace tools {

namespace {

std::shared_ptr<SpyOptions> add_listener(CLI::App* spy) {
  const auto options = std::make_shared<SpyOptions>();
  spy->add_option("--url", options->url, "LCM URL to listen on; file://LOG?speed=0 reads an event log")
      ->capture_default_str();
  spy->add_option("--prefix", options->prefix, "Prefix of the LCM channels (telemetry.channel_prefix)")
      ->capture_default_str();
  spy->add_flag("--once", options->once, "End half a second after the service says it has finished");
  spy->add_option("--seconds", options->seconds, "End after this many seconds; with --once that is a failure")
      ->check(CLI::Range(0.1, 1e6));
  spy->add_flag("--plain", options->plain, "Plain lines, ASCII only, also on a terminal");
  spy->add_option("--count", options->count_file,
                  "Write the number of messages received and missed to this JSON file at the end");
  spy->callback([options, spy] {
    if (spy->get_subcommands().empty()) run_spy(*options);  // otherwise the subcommand has already run
  });
  return options;
}

}  // namespace

void add_spy(CLI::App& app) {
  add_listener(app.add_subcommand("spy", "Show modes, displacements, losses and health live, from LCM alone"));
}

void add_inspect(CLI::App& app) {
  CLI::App* inspect = app.add_subcommand(
      "inspect", "Show every stage live, like top: rate, ring, losses, latencies, CPU; from LCM alone");
  add_listener(inspect)->view = SpyView::kStages;
  add_inspect_cameras(*inspect);
  add_inspect_telemetry(*inspect);
  add_inspect_lcm(*inspect);
}

}  // namespace tools
