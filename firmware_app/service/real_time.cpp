#include "firmware_app/service/real_time.h"

#include <fmt/core.h>

#include <cerrno>
#include <system_error>
#include <utility>

namespace app {
namespace {

std::string refusal(const rt::ThreadConfig& thread, const std::error_code& code) {
  std::string asked;
  if (thread.fifo_priority > 0) asked = fmt::format("priority {}", thread.fifo_priority);
  if (thread.cpu >= 0) asked += fmt::format("{}CPU {}", asked.empty() ? "" : " on ", thread.cpu);
  const char* remedy = code.value() == EPERM ? "grant CAP_SYS_NICE or raise RLIMIT_RTPRIO"
                                             : "is there such a CPU, and may the service use it? (taskset -p 1)";
  return fmt::format("{}: {} refused ({}): {}", thread.name, asked, code.message(), remedy);
}

}  // namespace

void refuse_or_warn(const RtConfig& config, const std::string& refused, HealthCollector& health) {
  if (config.required) throw RealTimeRefused(refused + " (rt.required is true)");
  health.warn(refused);
}

rt::ThreadConfig frame_thread(std::string name, const RtConfig& config, int cpu) {
  constexpr std::size_t kStackBytes = 2 << 20, kPrefaultBytes = 512 << 10;
  return {std::move(name), config.priority, cpu, kStackBytes, kPrefaultBytes};
}

void start_runner(rt::StageRunner& runner, const RtConfig& config, HealthCollector& health) {
  try {
    runner.start();
  } catch (const std::system_error& e) {
    if (!runner.config().is_special()) throw;
    refuse_or_warn(config, refusal(runner.config(), e.code()), health);
    runner.be_ordinary();
    runner.start();
  }
}

}  // namespace app
