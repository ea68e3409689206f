// hovermodald: watches a structure through a camera and reports its modes of vibration while it watches.
#include <spdlog/spdlog.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>

#include "drivers/camera/device_missing.h"
#include "drivers/host/memory_reserve.h"
#include "firmware_app/config/config.h"
#include "firmware_app/config/options.h"
#include "firmware_app/service/log_lines.h"
#include "firmware_app/service/pipeline.h"
#include "firmware_app/service/progress.h"
#include "firmware_app/service/real_time.h"
#include "firmware_app/service/run_diagnosis.h"
#include "firmware_app/service/service_notify.h"

namespace {

enum ExitCode : int { kDone = 0, kFault = 1, kUsage = 2, kDeviceMissing = 3, kRealTimeRefused = 4 };

// A thread in an estimate that was not waited for uses the pipeline until the process ends.
[[noreturn]] void end_process(ExitCode code) {
  spdlog::shutdown();
  std::fflush(nullptr);
  std::_Exit(code);
}

int run(const app::AppConfig& config) {
  const app::SignalWatch signals;  // before any thread starts: threads inherit the signal mask
  app::Pipeline pipeline(config);
  app::Progress progress(pipeline);
  app::ServiceNotify service;
  pipeline.start();
  progress.started();
  service.ready("running");
  bool was_stopped = false;
  while (pipeline.running()) {
    if (signals.stop_requested()) {
      was_stopped = true;
      pipeline.request_stop();
      progress.stopping();
      service.stopping();
    }
    progress.tick();
    service.tick(pipeline.stall());
  }
  const app::Pipeline::Outcome outcome = pipeline.join();
  const bool is_done = progress.finish(outcome);
  // A flight that was stopped ends at once; a recording that reached its end is analysed once more as a whole.
  const auto goes_on = [&] { return service.tick({}), !signals.stop_requested(); };
  if (is_done && !was_stopped) app::diagnose_run(pipeline, outcome, goes_on);
  if (outcome.leaves_threads) end_process(is_done ? kDone : kFault);
  return is_done ? kDone : kFault;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    drivers::keep_memory_reserve();
    app::log_printable_lines();
    const app::Options options = app::parse_options(argc, argv);
    if (options.exit_code) return *options.exit_code;
    const app::AppConfig config = app::load_config(options.config_path, options.overrides);
    if (options.check_only) {
      (void)app::declared_structure(config);
      std::fputs(app::check_source(config).c_str(), stdout);
      spdlog::info("{}: configuration and source are fine", options.config_path);
      return kDone;
    }
    return run(config);
  } catch (const app::ConfigError& e) {
    spdlog::error("{}", e.what());
    return kUsage;
  } catch (const std::invalid_argument& e) {
    spdlog::error("{}", e.what());
    return kUsage;
  } catch (const drivers::DeviceMissing& e) {
    spdlog::error("{}", e.what());
    return kDeviceMissing;
  } catch (const app::RealTimeRefused& e) {
    spdlog::error("{}", e.what());
    return kRealTimeRefused;
  } catch (const std::exception& e) {
    spdlog::error("{}", e.what());
    return kFault;
  }
}
