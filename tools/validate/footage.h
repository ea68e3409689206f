#pragma once

namespace tools {

// Disturbances of real footage: covered regions, frames tracked wrongly, records of a few cycles. The whole chain after
// the tracker on simulated tracks of the paper's six storeys, and time series. Each prints tab-separated lines, with
// comment
// lines (#) that name their columns. The output does not depend on the number of threads.
struct FootageOptions {
  int n_seeds = 10;
  int n_threads = 2;
  int first_seed = 1;
};

void print_covered(const FootageOptions& options);   // a floor covered from some frame on
void print_glitches(const FootageOptions& options);  // one frame in which a region was tracked wrongly
void print_short(const FootageOptions& options);     // few cycles, and pure noise

}  // namespace tools
