#include <memory>
#include <stdexcept>
#include <string>

#include "drivers/host/command_line.h"
#include "tools/hovermodal/commands.h"
#include "tools/hovermodal/inspect/cost.h"
#include "tools/hovermodal/inspect/telemetry.h"
#include "tools/hovermodal/spy/session.h"

namespace tools {

namespace {

std::shared_ptr<SpyOptions> add_listener(drivers::Command spy) {
  const auto options = std::make_shared<SpyOptions>();
  spy.option("--url", options->url, "LCM URL to listen on; file://LOG?speed=0 reads an event log").show_default();
  spy.option("--prefix", options->prefix, "Prefix of the LCM channels (telemetry.channel_prefix)").show_default();
  spy.flag("--once", options->once, "End half a second after the service says it has finished");
  spy.option("--seconds", options->seconds, "End after this many seconds; with --once that is a failure")
      .range(0.1, 1e6);
  spy.flag("--plain", options->plain, "Plain lines, ASCII only, also on a terminal");
  spy.option("--count", options->count_file,
             "Write the number of messages received and missed to this JSON file at the end");
  add_answer_options(spy, options->answer, "the numbers of --count at the end");
  spy.on_run([options, spy] {
    if (!spy.subcommand_given()) run_spy(*options);  // otherwise the subcommand has already run
  });
  return options;
}

}  // namespace

void add_spy(drivers::Command& app) {
  add_listener(app.subcommand("spy", "Show modes, displacements, losses and health live, from LCM alone"));
}

void add_inspect(drivers::Command& app) {
  drivers::Command inspect =
      app.subcommand("inspect", "Show every stage live, like top: rate, ring, losses, latencies, CPU; from LCM alone");
  add_listener(inspect)->view = SpyView::kStages;
  add_inspect_cameras(inspect);
  add_inspect_cost(inspect);
  add_inspect_telemetry(inspect);
  add_inspect_lcm(inspect);
}

}  // namespace tools
