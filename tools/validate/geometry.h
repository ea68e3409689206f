#pragma once

#include <string>

namespace tools {

// The whole chain after the tracker on simulated flights of known truth: tracks -> geometry -> spectra -> modes, as in
// `hovermodal replay`. Each prints tab-separated lines, with comment lines (#) that name their columns. Records
// are those of n_seeds seeds from first_seed on, made on n_threads; the output does not depend on the number of
// threads.
struct GeometryOptions {
  int n_seeds = 20;
  int n_threads = 2;
  int first_seed = 1;
  double duration_s = 0.0;  // 0 = that of the figure
  std::string report;       // folder for pictures and reports; empty = none
  std::string flight;       // recorded flight (CSV) that moves the camera; empty = the hover model instead
  bool is_drawn = false;    // camera, structure and noise drawn from the seed, unless fixed by the figure
};

void print_geometry(const GeometryOptions& options);         // the paper's experiment, one correction after the other
void print_geometry_pixels(const GeometryOptions& options);  // the same from rendered clips, stored in `report`
void print_paper(const GeometryOptions& options);            // the paper's figures: how well its chain reaches them
void print_table1(const GeometryOptions& options);           // the paper's Table 1, sensor by sensor
void print_wind(const GeometryOptions& options);             // gusts of 5 degrees
void print_low_frequency(const GeometryOptions& options);    // a mode of 0.32 Hz in the hover's drift
void print_deck(const GeometryOptions& options);             // a bridge deck, camera upright and rotated
void print_elevation(const GeometryOptions& options);        // seen from 30 degrees below
void print_noise_floor(const GeometryOptions& options);      // nothing moves but the camera
void print_readout(const GeometryOptions& options);          // readout time from tracks of the paper's experiment

}  // namespace tools
