#pragma once

#include <sys/types.h>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "tools/hovermodal/batch/flight_order.h"

namespace tools {

// Outcome of one flight; its results are in its folder.
struct FlightEnd {
  std::size_t number = 0;  // as passed to start()
  std::string failure;     // empty: success
};

// Workers for flights: processes here, or ranks elsewhere.
class Workers {
 public:
  Workers() = default;
  virtual ~Workers() = default;
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  [[nodiscard]] virtual bool has_room() const = 0;
  virtual void start(std::size_t number, const FlightOrder& order) = 0;  // only if there is room
  [[nodiscard]] virtual std::optional<FlightEnd> poll() = 0;             // never waits
};

// Up to n_jobs processes on this machine, one per flight: a crash affects no other flight. Their output
// goes to kLogFile in the flight's folder.
class LocalWorkers final : public Workers {
 public:
  // `program`: run with arguments_of() of a flight.
  LocalWorkers(std::string program, int n_jobs);
  ~LocalWorkers() override;  // processes still running are killed

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
