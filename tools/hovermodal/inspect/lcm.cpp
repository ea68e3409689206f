#include <memory>
#include <stdexcept>
#include <string>

#include "drivers/host/command_line.h"
#include "tools/hovermodal/answer.h"
#include "tools/hovermodal/commands.h"

#ifdef HOVERMODAL_WITH_LCM
#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string_view>

#include "drivers/storage/json.h"
#include "drivers/telemetry/lcm_diagnosis.h"
#include "drivers/telemetry/lcm_listener.h"
#include "drivers/telemetry/stream_monitor.h"
#include "tools/hovermodal/spy/text.h"
#endif

namespace tools {
namespace {

struct Options {
  std::string url = "udpm://239.255.76.67:7667?ttl=0";
  std::string prefix = "HOVERMODAL";
  double seconds = 2.5;  // a status comes every second
  Answer answer;
};

#ifdef HOVERMODAL_WITH_LCM

// Told as they are found: the next one may take seconds.
class Findings {
 public:
  explicit Findings(const Answer& answer) : answer_(answer) {}

  void add(drivers::FindingKind kind, const std::string& what, const std::string& remedy) {
    constexpr const char* kWords[] = {"ok  ", "note", "BAD "};
    constexpr const char* kNames[] = {"ok", "note", "bad"};
    answer_.text("{}  {}\n", kWords[static_cast<std::size_t>(kind)], what);
    if (!remedy.empty()) answer_.text("      {}\n", remedy);
    std::fflush(stdout);
    json_.push_back({{"kind", kNames[static_cast<std::size_t>(kind)]}, {"what", what}, {"remedy", remedy}});
  }
  void finish() const { answer_.document(drivers::to_json_text({{"findings", json_}}).text); }

 private:
  const Answer& answer_;
  nlohmann::ordered_json json_ = nlohmann::ordered_json::array();
};

// Messages that a service sends there: number of each kind, and whether they can be decoded.
void listen_for_a_service(const Options& options, Findings& findings) {
  drivers::StreamMonitor monitor(options.prefix);
  drivers::LcmListener listener(options.url, options.prefix,
                                [&monitor](std::string_view channel, const void* data, std::size_t n_bytes) {
                                  monitor.receive(channel, data, n_bytes, 1);  // the time is not used here
                                });
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(options.seconds);
  while (std::chrono::steady_clock::now() < end && listener.poll()) {
  }
  std::string heard;
  for (std::size_t i = 0; i < drivers::kTopics; ++i) {
    const auto topic = static_cast<drivers::Topic>(i);
    const auto& count = monitor.count(topic);
    if (count.received > 0)
      heard += fmt::format("{}{} of {}", heard.empty() ? "" : ", ", count.received, monitor.lcm_channel(topic));
  }
  for (const std::string& words : monitor.sender_warnings()) findings.add(drivers::FindingKind::kBad, words, "");
  if (!heard.empty()) {
    findings.add(
        drivers::FindingKind::kOk,
        fmt::format("received in {} s from \"{}\": {}", options.seconds, printable(monitor.stream_id()), heard), "");
  } else if (monitor.sender_warnings().empty()) {
    findings.add(drivers::FindingKind::kNote, fmt::format("no {}_* message in {} s", options.prefix, options.seconds),
                 "is a service running, with this telemetry.lcm_url and telemetry.channel_prefix? On another computer: "
                 "ttl=1 there, its route, and this command there");
  }
}

void inspect_lcm(const Options& options) {
  Findings findings(options.answer);
  std::size_t n_bad = 0;
  for (const auto& finding : drivers::diagnose_lcm(options.url, options.prefix)) {
    findings.add(finding.kind, finding.what, finding.remedy);
    n_bad += finding.kind == drivers::FindingKind::kBad ? 1 : 0;
  }
  if (n_bad > 0) {
    findings.finish();
    throw std::runtime_error(
        fmt::format("LCM at \"{}\" does not work: correct each line marked BAD above, from the top (the commands "
                    "as root)",
                    options.url));
  }
  if (options.seconds > 0.0) listen_for_a_service(options, findings);
  findings.finish();
}

#else

void inspect_lcm(const Options&) {
  throw std::runtime_error(
      "inspect lcm: this build has no LCM. Install liblcm-dev, liblcm-bin and libglib2.0-dev and configure again with "
      "-DWITH_LCM=ON.");
}

#endif

}  // namespace

void add_inspect_lcm(drivers::Command& inspect) {
  drivers::Command command =
      inspect.subcommand("lcm",
                         "Test the network that LCM needs, report faults and how to correct them, and listen for a "
                         "service.\nRun it on both sides of a radio link, each with the URL of the service.");
  const auto options = std::make_shared<Options>();
  command.option("--url", options->url, "LCM URL (telemetry.lcm_url)").show_default();
  command.option("--prefix", options->prefix, "Prefix of the LCM channels (telemetry.channel_prefix)").show_default();
  command.option("--seconds", options->seconds, "Listen for a service for this time, s; 0 = do not listen")
      .range(0.0, 3600.0)
      .show_default();
  add_answer_options(command, options->answer, "the findings");
  command.on_run([options] { inspect_lcm(*options); });
}

}  // namespace tools
