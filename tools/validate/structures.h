#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace tools {

// Largest relative error of the first frequencies of a kind of structural model against a solution that shares no code
// with it.
struct KindError {
  std::string kind, structure, against;
  std::size_t n_modes = 0;
  double worst = 0.0;
};
[[nodiscard]] std::vector<KindError> check_kinds();
[[nodiscard]] std::vector<KindError> check_kinds_against_matrices();

void print_structure_kinds();
// n_seeds records for each loss, 300 without any.
void print_structure_where(int n_seeds, int n_threads, int first_seed);
// Files of a wall of 10^5 degrees of freedom with one soft group, for closeloop: wall.yaml, modes.csv, *.mtx.
void write_large_structure(const std::string& folder, int first_seed);
// Tension of simulated stay cables, n_seeds for each length of the record.
void print_structure_tension(int n_seeds, int n_threads, int first_seed);
// One of them: structure-kinds, -effects, -where, -large, -tension.
void print_structures(const std::string& what, int n_seeds, int n_threads, int first_seed, const std::string& folder);

}  // namespace tools
