#pragma once

#include <memory>

#include "tools/hovermodal/batch/workers.h"

namespace tools {

// The processes started together by mpirun or Slurm's srun (WITH_MPI), possibly on several machines. Rank 0 assigns
// flights, one at a time to a rank with room, and gathers the results; the other ranks only serve. Sums are added only
// at rank 0, in the order of names, so that the number of ranks changes no bit. All use of MPI is in mpi_workers.cpp.
class MpiSession {
 public:
  MpiSession();  // throws std::invalid_argument: built without MPI
  ~MpiSession();
  MpiSession(const MpiSession&) = delete;
  MpiSession& operator=(const MpiSession&) = delete;

  [[nodiscard]] int rank() const noexcept { return rank_; }
  [[nodiscard]] int n_ranks() const noexcept { return n_ranks_; }

  // Rank 0: the workers of the other ranks, each with `jobs` flights at a time. Its lifetime is within this object's.
  [[nodiscard]] std::unique_ptr<Workers> others(int jobs);
  // Every other rank: works until rank 0 destroys others().
  void serve(LocalWorkers& workers);

 private:
  int rank_ = 0, n_ranks_ = 1;
};

// Whether mpirun or srun started several processes, by the environment.
[[nodiscard]] bool is_one_of_several();

}  // namespace tools
