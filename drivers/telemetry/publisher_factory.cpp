#include "drivers/telemetry/publisher_factory.h"

#include <stdexcept>

#include "drivers/telemetry/run_recorder.h"
#include "drivers/telemetry/sample_listener.h"

#ifdef HOVERMODAL_WITH_LCM
#include "drivers/telemetry/lcm_publisher.h"
#endif

namespace drivers {

std::unique_ptr<Publisher> make_publisher(const LcmOptions& options, std::string* warning) {
  if (warning != nullptr) warning->clear();
  if (options.url.empty() && options.log_file.empty() && !options.record) return std::make_unique<NullPublisher>();
#ifdef HOVERMODAL_WITH_LCM
  auto publisher = std::make_unique<LcmPublisher>(options);
  if (warning != nullptr) *warning = publisher->warning();
  return publisher;
#else
  throw std::runtime_error(
      "telemetry to \"" + (options.url.empty() ? options.log_file : options.url) +
      "\": this build has no LCM. Install liblcm-dev, liblcm-bin and libglib2.0-dev and configure again with "
      "-DWITH_LCM=ON, or leave telemetry.lcm_url and telemetry.log_file empty.");
#endif
}

#ifndef HOVERMODAL_WITH_LCM
std::unique_ptr<RunRecorder> make_run_recorder(const RecordOptions& options) {
  throw std::runtime_error("record.directory: \"" + options.directory + "\": this build has no LCM");
}

std::unique_ptr<AttitudeListener> listen_for_attitude(const std::string& url, const std::string& channel) {
  throw std::runtime_error("camera.attitude_channel: \"" + channel + "\" at \"" + url +
                           "\": this build has no LCM; use camera.attitude_file");
}

std::unique_ptr<AircraftListener> listen_for_aircraft(const std::string& url, const std::string& channel) {
  throw std::runtime_error("camera.aircraft_channel: \"" + channel + "\" at \"" + url +
                           "\": this build has no LCM; use camera.motors_file");
}
#endif

}  // namespace drivers
