#pragma once

#include <memory>

#include "tools/hovermodal/batch/workers.h"

namespace tools {

// The processes that mpirun or Slurm's srun started together (WITH_MPI), possibly on several machines. Rank 0 hands out
// flights, one at a time to whoever has room, and gathers what they leave; the others only serve. Nothing is summed on
// the way: rank 0 combines all in the order of their names, so that the number of ranks changes no bit. All that is
// known of MPI is in mpi_workers.cpp.
class MpiSession {
 public:
  MpiSession();  // throws std::invalid_argument: built without MPI
  ~MpiSession();
  MpiSession(const MpiSession&) = delete;
  MpiSession& operator=(const MpiSession&) = delete;

  [[nodiscard]] int rank() const noexcept { return rank_; }
  [[nodiscard]] int n_ranks() const noexcept { return n_ranks_; }

  // Rank 0: those behind the other ranks, of which each takes `jobs` flights at a time. Lives shorter than this.
  [[nodiscard]] std::unique_ptr<Workers> others(int jobs);
  // Every other rank: works until rank 0 has let go of others().
  void serve(LocalWorkers& workers);

 private:
  int rank_ = 0, n_ranks_ = 1;
};

// Started by mpirun or srun together with others, as the environment tells.
[[nodiscard]] bool is_one_of_several();

}  // namespace tools
