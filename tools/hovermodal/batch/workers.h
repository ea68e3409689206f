#pragma once

#include <sys/types.h>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "tools/hovermodal/batch/flight_order.h"

namespace tools {

// What became of one flight; its results lie in its folder.
struct FlightEnd {
  std::size_t number = 0;  // as it was started
  std::string failure;     // empty: it is done
};

// Who works on flights: processes here, or ranks elsewhere.
class Workers {
 public:
  Workers() = default;
  virtual ~Workers() = default;
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  [[nodiscard]] virtual bool has_room() const = 0;
  virtual void start(std::size_t number, const FlightOrder& order) = 0;  // only with room
  [[nodiscard]] virtual std::optional<FlightEnd> poll() = 0;             // never waits
};

// Up to n_jobs processes of this machine, one for each flight: one that crashes takes nothing else with it. What they
// print goes to kLogFile in the flight's folder.
class LocalWorkers final : public Workers {
 public:
  // `program`: what is run with arguments_of() a flight.
  LocalWorkers(std::string program, int n_jobs);
  ~LocalWorkers() override;  // those still at work are killed

  [[nodiscard]] bool has_room() const override { return running_.size() < n_jobs_; }
  void start(std::size_t number, const FlightOrder& order) override;
  [[nodiscard]] std::optional<FlightEnd> poll() override;

 private:
  struct Running {
    std::size_t number = 0;
    pid_t pid = -1;
    std::string into;
  };
  std::string program_;
  std::size_t n_jobs_;
  std::vector<Running> running_;
  std::vector<FlightEnd> not_started_;
};

}  // namespace tools
