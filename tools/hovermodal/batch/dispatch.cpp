#include "tools/hovermodal/batch/dispatch.h"

#include <fmt/format.h>

#include <chrono>
#include <thread>

#include "tools/hovermodal/simulate/progress.h"

namespace tools {

std::vector<std::string> work_on_all(const std::vector<FlightOrder>& orders,
                                     const std::vector<std::unique_ptr<Workers>>& workers, bool is_quiet) {
  constexpr auto kPause = std::chrono::milliseconds(10);
  std::vector<std::string> failures(orders.size());
  Progress progress("batch", orders.size(), "flights", is_quiet);
  std::size_t n_started = 0, n_ended = 0;
  progress.update(0);
  while (n_ended < orders.size()) {
    bool is_idle = true;
    for (const auto& group : workers) {
      while (n_started < orders.size() && group->has_room()) {
        group->start(n_started, orders[n_started]);
        ++n_started;
      }
      while (const auto end = group->poll()) {
        failures[end->number] = end->failure;
        const std::string& name = orders[end->number].flight.name;
        if (!end->failure.empty()) progress.say(fmt::format("{}: failed: {}", name, end->failure));
        progress.update(++n_ended);
        is_idle = false;
      }
    }
    if (is_idle) std::this_thread::sleep_for(kPause);
  }
  return failures;
}

}  // namespace tools
