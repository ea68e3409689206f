#include "tools/hovermodal/inspect/cost.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <chrono>
#include <ctime>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "drivers/camera/recording/frame_source.h"
#include "drivers/host/energy_meter.h"
#include "drivers/host/instruction_counter.h"
#include "drivers/storage/json.h"
#include "drivers/storage/printable.h"
#include "firmware_app/service/pipeline.h"
#include "tools/hovermodal/answer.h"
#include "tools/hovermodal/stop_signal.h"

namespace tools {

namespace {

struct Options {
  std::string config;
  std::vector<std::string> overrides;
  double seconds = 20.0;
  Answer answer;
};

// What a run took, from its first frame to its last result.
struct Cost {
  core::Health health;
  double seconds = 0.0, cpu_s = 0.0;
  double joules = 0.0;
  std::optional<std::uint64_t> instructions;
};

double process_cpu_s() {
  timespec now{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double peak_mb() {
  rusage use{};
  ::getrusage(RUSAGE_SELF, &use);
  return 1.024e-3 * static_cast<double>(use.ru_maxrss);
}

// The service as configured, but for what it would send and write.
app::AppConfig config_of(const Options& options) {
  std::vector<std::string> overrides = options.overrides;
  overrides.insert(
      overrides.end(),
      {"telemetry.lcm_url=", "telemetry.log_file=", "state.directory=", "report.directory=", "record.directory="});
  return app::load_config(options.config, overrides);
}

Cost watch(app::Pipeline& pipeline, const drivers::InstructionCounter& counter, drivers::EnergyMeter& energy,
           double seconds) {
  using Clock = std::chrono::steady_clock;
  const auto sample = [&] { energy.sample(Clock::now().time_since_epoch() / std::chrono::nanoseconds(1)); };
  Cost cost;
  const auto instructions = counter.count();
  const double cpu_s = process_cpu_s();
  const auto start = Clock::now();
  sample();
  pipeline.start();
  while (pipeline.running()) {
    if (stop_requested != 0 || Clock::now() - start >= std::chrono::duration<double>(seconds)) pipeline.request_stop();
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    sample();
  }
  const app::Pipeline::Outcome outcome = pipeline.join();
  cost.seconds = std::chrono::duration<double>(Clock::now() - start).count();
  cost.cpu_s = process_cpu_s() - cpu_s;
  cost.joules = energy.joules();
  if (instructions) cost.instructions = *counter.count() - *instructions;
  cost.health = outcome.health;
  if (!outcome.fault.empty()) throw std::runtime_error(outcome.fault);
  if (cost.health.frames_processed == 0) throw std::runtime_error("no frame came: there is nothing to divide by");
  return cost;
}

void tell(const Options& options, const Cost& cost, const core::CameraInfo& camera,
          const drivers::InstructionCounter& counter, const drivers::EnergyMeter& energy) {
  const auto n = static_cast<double>(cost.health.frames_processed);
  const double rate_hz = n / cost.seconds;
  const Answer& answer = options.answer;
  answer.text("{} frames of {} x {} px, {} points, in {:.1f} s: {:.1f} frames/s, {:.2g} times the source's {:.3g}\n",
              cost.health.frames_processed, camera.width_px, camera.height_px, cost.health.points_total, cost.seconds,
              rate_hz, rate_hz / camera.rate_hz, camera.rate_hz);
  if (cost.health.frames_dropped > 0)
    answer.text("{} frames were dropped: this machine does not keep up\n", cost.health.frames_dropped);
  answer.text("\n{:<16} {:>12} {:>8} {:>10} {:>10}\n", "stage", "us a frame", "share", "p50, us", "p99, us");
  double stages_s = 0.0;
  nlohmann::ordered_json stages = nlohmann::ordered_json::array();
  const auto row = [&](const std::string& name, double cpu_s, const core::LatencyHealth* step) {
    answer.text("{:<16} {:>12.1f} {:>6.1f} %", name, 1e6 * cpu_s / n, 100.0 * cpu_s / cost.cpu_s);
    if (step != nullptr) {
      answer.text(" {:>10.1f} {:>10.1f}", 1e-3 * static_cast<double>(step->p50_ns),
                  1e-3 * static_cast<double>(step->p99_ns));
    }
    answer.text("\n");
    stages.push_back({{"name", name}, {"cpu_us_per_frame", 1e6 * cpu_s / n}});
  };
  for (const core::StageHealth& stage : cost.health.stages) {
    row(stage.name, 1e-9 * static_cast<double>(stage.cpu_ns), &stage.step);
    stages_s += 1e-9 * static_cast<double>(stage.cpu_ns);
  }
  row("other threads", cost.cpu_s - stages_s, nullptr);  // decoder, main thread
  row("all", cost.cpu_s, nullptr);
  nlohmann::ordered_json json{{"frames", cost.health.frames_processed},
                              {"frames_per_s", rate_hz},
                              {"frames_dropped", cost.health.frames_dropped},
                              {"points", cost.health.points_total},
                              {"stages", stages},
                              {"instructions_per_frame", nullptr},
                              {"joules_per_frame", nullptr},
                              {"peak_mb", peak_mb()}};
  if (cost.instructions) {
    json["instructions_per_frame"] = static_cast<double>(*cost.instructions) / n;
    answer.text("\ninstructions: {:.3g} million a frame, in user space\n",
                1e-6 * static_cast<double>(*cost.instructions) / n);
  } else {
    answer.text("\ninstructions: not counted: {}\n", counter.why_not());
  }
  if (energy.why_not().empty()) {
    json["joules_per_frame"] = cost.joules / n;
    answer.text("energy: {:.3g} J a frame, {:.3g} W: all that this board does meanwhile, by {}\n", cost.joules / n,
                cost.joules / cost.seconds, drivers::printable(energy.source()));
  } else {
    answer.text("energy: {}\n", energy.why_not());
  }
  answer.text("memory: {:.0f} MB at the peak\n", peak_mb());
  answer.document(drivers::to_json_text(json).text);
}

void inspect_cost(const Options& options) {
  drivers::silence_media_libraries();
  watch_stop_signals();
  const drivers::InstructionCounter counter;  // before the threads that it counts
  drivers::EnergyMeter energy;
  app::Pipeline pipeline(config_of(options));
  for (const std::string& warning : pipeline.warnings()) options.answer.note("{}\n", drivers::printable(warning));
  const Cost cost = watch(pipeline, counter, energy, options.seconds);
  tell(options, cost, pipeline.camera_info(), counter, energy);
}

}  // namespace

void add_inspect_cost(drivers::Command& inspect) {
  drivers::Command command = inspect.subcommand(
      "cost",
      "Run the service on its source for some seconds and show what a frame costs: processor time by stage, "
      "instructions, energy where the board measures it, memory. Nothing is sent or written.");
  const auto options = std::make_shared<Options>();
  command.option("--config", options->config, "Configuration of the service").required();
  command.option("--set", options->overrides, "Override, KEY=VALUE, as for the service").repeated();
  command.option("--seconds", options->seconds, "End after this time, s, or with the source")
      .range(0.1, 86400.0)
      .show_default();
  add_answer_options(command, options->answer, "the costs");
  command.on_run([options] { inspect_cost(*options); });
}

}  // namespace tools
