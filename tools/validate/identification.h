#pragma once

#include <string>
#include <vector>

namespace tools {

// The identification on simulated records of known truth: structure -> channel samples -> spectra -> modes, in process.
// Each prints tab-separated lines, with a comment line (#) that names their columns. Records are those of n_seeds seeds
// from first_seed on, made on n_threads; the output does not depend on the number of threads.
struct IdentificationOptions {
  int n_seeds = 20;
  int n_threads = 2;
  int first_seed = 1;
  std::string flight;  // recorded flight (CSV) that moves the camera of print_null; empty = the hover model
};

void print_bias(const IdentificationOptions& options);       // bias, scatter and stated intervals, six storeys at 60 Hz
void print_losses(const IdentificationOptions& options);     // samples and frames lost at random
void print_folding(const IdentificationOptions& options);    // modes above half the frame rate
void print_null(const IdentificationOptions& options);       // a rigid building under a hovering, vibrating camera
void print_harmonics(const IdentificationOptions& options);  // rotor lines and steady forces near modes
void print_closure(const IdentificationOptions& options);    // residual diagnosis of structures that lack one effect
void print_closure_null(const IdentificationOptions& options);  // and of one that lacks none

void print_closure_series(const IdentificationOptions& options);  // and of series of channels, with and without effects
void print_closure_series_outside(const IdentificationOptions& options);  // with the effect removed from the catalogue
void print_closure_series_null(const IdentificationOptions& options);

}  // namespace tools
