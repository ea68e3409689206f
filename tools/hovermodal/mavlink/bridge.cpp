#include "tools/hovermodal/mavlink/bridge.h"

#include <stdexcept>

#ifndef HOVERMODAL_WITH_LCM

void tools::run_mavlink(const MavlinkOptions&) {
  throw std::runtime_error(
      "mavlink: this build has no LCM. Install liblcm-dev, liblcm-bin and libglib2.0-dev and configure again with "
      "-DWITH_LCM=ON.");
}

#else

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "drivers/host/host_status.h"
#include "drivers/mavlink/mavlink_companion.h"
#include "drivers/mavlink/mavlink_link.h"
#include "drivers/storage/csv_writer.h"
#include "drivers/telemetry/lcm_listener.h"
#include "drivers/telemetry/modes_listener.h"
#include "drivers/telemetry/sample_sender.h"
#include "tools/hovermodal/stop_signal.h"

namespace tools {
namespace {

constexpr std::int64_t kStatus_ns = 1'000'000'000;
constexpr int kWait_ms = 20;

class AttitudeCsv {
 public:
  explicit AttitudeCsv(const std::string& path) {
    if (path.empty()) return;
    out_.emplace(path);
    fmt::format_to(std::back_inserter(out_->buffer()), "t_s,qw,qx,qy,qz\n");
  }
  void write(const core::AttitudeSample& sample) {
    if (!out_) return;
    const std::int64_t now_us = std::llround(1e6 * sample.t_s);  // as it is written
    if (now_us <= last_us_) {
      ++n_left_out_;
      return;
    }
    last_us_ = now_us;
    const auto& q = sample.wxyz;
    fmt::format_to(std::back_inserter(out_->buffer()), "{:.6f},{:.8g},{:.8g},{:.8g},{:.8g}\n",
                   1e-6 * static_cast<double>(now_us), q[0], q[1], q[2], q[3]);
    (void)out_->end_line();  // commit() reports a failure
  }
  // Times of the file increase.
  [[nodiscard]] std::uint64_t n_left_out() const noexcept { return n_left_out_; }
  void commit() {
    if (out_) out_->commit();
  }

 private:
  std::optional<drivers::CsvWriter> out_;
  std::int64_t last_us_ = -1;
  std::uint64_t n_left_out_ = 0;
};

class MotorsCsv {
 public:
  explicit MotorsCsv(const std::string& path) {
    if (path.empty()) return;
    out_.emplace(path);
    fmt::format_to(std::back_inserter(out_->buffer()), "t_s,motor,hz\n");
  }
  void write(const drivers::MavlinkCompanion::Motor& motor, std::int64_t now_ns) {
    if (!out_) return;
    fmt::format_to(std::back_inserter(out_->buffer()), "{:.3f},{},{:.4f}\n", 1e-9 * static_cast<double>(now_ns),
                   motor.number, motor.hz);
    (void)out_->end_line();  // commit() reports a failure
  }
  void commit() {
    if (out_) out_->commit();
  }

 private:
  std::optional<drivers::CsvWriter> out_;
};

// What the autopilot has stated since the last second, for the service.
class AircraftSecond {
 public:
  void add(const drivers::MavlinkCompanion::Motor& motor) {
    const auto i = static_cast<std::size_t>(motor.number - 1);
    if (motor.number < 1 || i >= sum_hz_.size()) return;
    sum_hz_[i] += motor.hz;
    ++n_[i];
  }
  // Begins the next second. Empty: nothing is known of the aircraft.
  [[nodiscard]] std::optional<core::AircraftState> next(const drivers::MavlinkCompanion& companion,
                                                        std::int64_t now_ns) {
    core::AircraftState out;
    out.t_s = 1e-9 * static_cast<double>(now_ns);
    bool turns = false;
    for (std::size_t i = 0; i < sum_hz_.size(); ++i) {
      if (n_[i] > 0) out.motor_hz[i] = sum_hz_[i] / n_[i];
      turns = turns || out.motor_hz[i] > 0.0;
    }
    sum_hz_.fill(0.0), n_.fill(0);
    if (const auto& at = companion.position()) {
      out.latitude_deg = at->latitude_deg, out.longitude_deg = at->longitude_deg;
      out.above_home_m = at->above_home_m;
    }
    if (const auto& wind = companion.wind()) out.wind_m_s = wind->speed_m_s, out.wind_from_deg = wind->from_deg;
    if (!turns && !companion.position() && !companion.wind()) return std::nullopt;
    return out;
  }

 private:
  std::array<double, core::AircraftState::kMotors> sum_hz_{};
  std::array<int, core::AircraftState::kMotors> n_{};
};

std::string clock_text(const drivers::MavlinkCompanion& companion) {
  const auto fit = companion.clock().fit();
  if (!fit) return "clock not known yet";
  return fmt::format("clock +- {:.2f} ms (round trip {:.1f} ms, drift {:.1f} ppm)", 1e-6 * fit->sigma_ns,
                     1e-6 * static_cast<double>(fit->round_trip_ns), 1e6 * fit->drift);
}

std::string status_line(const drivers::MavlinkCompanion& companion) {
  if (!companion.autopilot()) return "waiting for an autopilot's heartbeat";
  return fmt::format("system {}: {} attitudes, {}, {} lost", *companion.autopilot(), companion.counts().attitudes,
                     clock_text(companion), companion.counts().lost);
}

std::string summary(const drivers::MavlinkCompanion& companion) {
  const auto& counts = companion.counts();
  const auto& stream = companion.stream();
  std::string out = status_line(companion) + "\n";
  out += fmt::format("messages: {} read, {} wrong checksums, {} bytes of no message, {} of others or not understood\n",
                     stream.frames, stream.wrong_checksums, stream.skipped_bytes, counts.not_ours);
  if (counts.before_clock > 0) out += fmt::format("attitudes before the clock was known: {}\n", counts.before_clock);
  if (counts.without_heading > 0) {
    out += fmt::format("gimbal attitudes without the aircraft's heading: {}\n", counts.without_heading);
  }
  if (counts.unasked > 0) out += fmt::format("time answers that nobody had asked for: {}\n", counts.unasked);
  if (companion.clock().restarts() > 0) {
    out += fmt::format("the autopilot's clock was restarted: {} times\n", companion.clock().restarts());
  }
  if (const auto motors = companion.motors_hz(); !motors.empty()) {
    out += fmt::format("motors turn at {:.2f} Hz\n", fmt::join(motors, ", "));
  }
  if (const auto& at = companion.position()) {
    out += fmt::format("position {:.7f} {:.7f}, {:.1f} m above home\n", at->latitude_deg, at->longitude_deg,
                       at->above_home_m);
  }
  if (const auto& wind = companion.wind()) {
    out += fmt::format("wind {:.1f} m/s from {:.0f} deg\n", wind->speed_m_s, wind->from_deg);
  }
  return out;
}

nlohmann::json document(const drivers::MavlinkCompanion& companion) {
  const auto& c = companion.counts();
  const auto& s = companion.stream();
  nlohmann::json out{{"messages", s.frames},
                     {"wrong_checksums", s.wrong_checksums},
                     {"skipped_bytes", s.skipped_bytes},
                     {"attitudes", c.attitudes},
                     {"before_clock", c.before_clock},
                     {"without_heading", c.without_heading},
                     {"time_exchanges", c.exchanges},
                     {"time_unasked", c.unasked},
                     {"lost", c.lost},
                     {"not_ours", c.not_ours},
                     {"clock_restarts", companion.clock().restarts()},
                     {"motors_hz", companion.motors_hz()}};
  if (const auto fit = companion.clock().fit()) {
    out["clock"] = {
        {"offset_ns", fit->offset_ns}, {"at_ns", fit->local_ns}, {"drift", fit->drift}, {"sigma_ns", fit->sigma_ns}};
  }
  return out;
}

// Of this computer and the disk of the folder in which the program was started.
class ComputerState {
 public:
  drivers::MavlinkComputer now(std::int64_t now_ns) {
    const auto known = [](double value) { return std::isfinite(value) ? std::optional(value) : std::nullopt; };
    const auto used = [](std::int64_t all, std::int64_t left) {
      return all >= 0 && left >= 0 ? std::optional(all - left) : std::nullopt;
    };
    const auto there = [](std::int64_t bytes) { return bytes >= 0 ? std::optional(bytes) : std::nullopt; };
    const core::HostHealth host = drivers::read_host_status(".");
    const drivers::HostCapacity has = drivers::read_host_capacity(".");
    const auto utc = std::chrono::system_clock::now().time_since_epoch();
    return {.utc_us = std::chrono::duration_cast<std::chrono::microseconds>(utc).count(),
            .up_ms = now_ns / 1'000'000,
            .processor_share = known(load_.next()),
            .temperature_c = known(host.cpu_temperature_c),
            .memory_used_bytes = used(has.memory_bytes, host.available_bytes),
            .memory_bytes = there(has.memory_bytes),
            .disk_used_bytes = used(has.disk_bytes, host.disk_left_bytes),
            .disk_bytes = there(has.disk_bytes)};
  }

 private:
  drivers::ProcessorLoad load_;
};

std::vector<drivers::MavlinkCompanion::Mode> lowest_of(const std::vector<drivers::ModesListener::Mode>& modes) {
  std::vector<drivers::MavlinkCompanion::Mode> out;
  out.reserve(modes.size());
  for (const auto& mode : modes) out.push_back({mode.frequency_hz, mode.damping_ratio});
  return out;
}

}  // namespace

void run_mavlink(const MavlinkOptions& options) {
  watch_stop_signals();
  const auto link = drivers::MavlinkLink::open(options.link);
  // Its own thread: the time of an answer of the autopilot must not wait for LCM.
  drivers::ModesListener modes(options.url, options.prefix);  // first: its error names what the network lacks
  drivers::SampleSender sender(options.url, options.channel), aircraft_sender(options.url, options.aircraft_channel);
  AttitudeCsv csv(options.csv);
  MotorsCsv motors(options.motors);
  drivers::MavlinkCompanion companion({.of_gimbal = options.of_gimbal, .datagrams = link->is_datagrams()},
                                      [&](const core::AttitudeSample& sample) {
                                        (void)sender.send(sample);
                                        csv.write(sample);
                                      });
  AircraftSecond aircraft;
  companion.on_motor([&](const auto& motor, std::int64_t now_ns) {
    motors.write(motor, now_ns);
    aircraft.add(motor);
  });
  const std::int64_t start_ns = drivers::LcmListener::now_ns();
  std::int64_t next_status_ns = start_ns + kStatus_ns;
  ComputerState computer;
  std::array<std::uint8_t, 4096> bytes{};
  while (stop_requested == 0) {
    const std::size_t n = link->receive(bytes, kWait_ms);
    const std::int64_t now_ns = drivers::LcmListener::now_ns();
    if (n > 0) companion.take(std::span(bytes).first(n), now_ns);
    if (const auto due = companion.due(now_ns); !due.empty()) (void)link->send(due);
    if (const auto estimate = modes.take()) (void)link->send(companion.modes(lowest_of(*estimate), now_ns));
    if (now_ns >= next_status_ns) {
      next_status_ns += kStatus_ns;
      (void)link->send(companion.state(computer.now(now_ns)));
      if (const auto state = aircraft.next(companion, now_ns)) (void)aircraft_sender.send(*state);
      options.answer.text("{}\n", status_line(companion));
      std::fflush(stdout);
    }
    if (options.seconds > 0.0 && static_cast<double>(now_ns - start_ns) > 1e9 * options.seconds) break;
  }
  csv.commit();
  motors.commit();
  options.answer.text("{}", summary(companion));
  if (csv.n_left_out() > 0) {
    options.answer.note("attitudes left out of {}, because their times do not increase: {}\n", options.csv,
                        csv.n_left_out());
  }
  if (const std::uint64_t n = sender.n_failed() + aircraft_sender.n_failed(); n > 0)
    options.answer.note("messages that LCM did not send: {}\n", n);
  if (link->from_others() > 0) options.answer.note("datagrams of other senders, not read: {}\n", link->from_others());
  options.answer.document(document(companion).dump(2) + "\n");
}

}  // namespace tools

#endif
