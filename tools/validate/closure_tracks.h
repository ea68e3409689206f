#pragma once

#include <string>

namespace tools {

// The observation level of residual diagnosis on simulated tracks of known truth. Prints tab-separated lines, with
// comment lines (#) that name their columns. Records are those of n_seeds seeds from first_seed on, made on n_threads;
// the output does not depend on the number of threads, except for the seconds taken.
struct ClosureTracksOptions {
  int n_seeds = 4;
  int n_threads = 2;
  double duration_s = 0.0;  // 0 = 120
  int first_seed = 1;
  std::string effect;     // this one only (clip: with these, joined by " + "); empty = all (clip: none)
  double strength = 0.0;  // this one only; 0 = all
  std::string flight;     // foreign: the recorded flight that moves the camera in one of four records; empty = none
};

void print_closure_tracks(const ClosureTracksOptions& options);          // undeclared effects: which are named
void print_closure_tracks_pairs(const ClosureTracksOptions& options);    // two of them at once
void print_closure_tracks_null(const ClosureTracksOptions& options);     // records without an effect
void print_closure_tracks_outside(const ClosureTracksOptions& options);  // each effect removed from the catalogue

// Records that are not simulated by the model's own formulas (foreign_scene.h): without an effect; with one.
void print_closure_tracks_foreign_null(const ClosureTracksOptions& options);
void print_closure_tracks_foreign(const ClosureTracksOptions& options);
void print_closure_tracks_foreign_sets(const ClosureTracksOptions& options);     // pairs and triples of them
void print_closure_tracks_foreign_outside(const ClosureTracksOptions& options);  // removed from the catalogue

void print_closure_clip(const ClosureTracksOptions& options);  // a drawn scene to render, as a file for `simulate`

void print_closure_clip_foreign(const ClosureTracksOptions& options);  // the same for a record foreign to the model

void print_closure_live(const ClosureTracksOptions& options);  // effects that begin in mid-flight, closure.adopt: auto
void print_closure_live_null(const ClosureTracksOptions& options);  // the same without an effect

}  // namespace tools
