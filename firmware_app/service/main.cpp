// hovermodald: watches a structure through a camera and reports its modes of vibration while it watches.
#include <spdlog/spdlog.h>

#include <csignal>
#include <cstdio>
#include <exception>

#include "drivers/camera/device_missing.h"
#include "firmware_app/config/config.h"
#include "firmware_app/config/options.h"
#include "firmware_app/service/pipeline.h"
#include "firmware_app/service/progress.h"
#include "firmware_app/service/real_time.h"
#include "firmware_app/service/service_notify.h"

namespace {

enum ExitCode : int { kDone = 0, kFault = 1, kUsage = 2, kDeviceMissing = 3, kRealTimeRefused = 4 };

int run(const app::AppConfig& config) {
  const app::SignalWatch signals;  // before any thread starts: they inherit the mask
  app::Pipeline pipeline(config);
  app::Progress progress(pipeline);
  app::ServiceNotify service;
  pipeline.start();
  progress.started();
  service.ready("running");
  while (pipeline.running()) {
    if (signals.stop_requested()) {
      pipeline.request_stop();
      progress.stopping();
      service.stopping();
    }
    progress.tick();
    service.tick(pipeline.stall());
  }
  return progress.finish(pipeline.join()) ? kDone : kFault;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const app::Options options = app::parse_options(argc, argv);
    if (options.exit_code) return *options.exit_code;
    const app::AppConfig config = app::load_config(options.config_path, options.overrides);
    if (options.check_only) {
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
