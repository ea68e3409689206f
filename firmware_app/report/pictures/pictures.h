#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/types/closure_report.h"
#include "core/types/cpsd.h"
#include "core/types/displacement.h"
#include "core/types/frame.h"
#include "core/types/health.h"
#include "core/types/modal_estimate.h"
#include "core/types/region.h"
#include "core/types/track.h"

namespace app {

class RunHistory;
struct ModalReport;
struct SpectralLines;

// For the page only: how the run was made and its losses.
struct RunFacts {
  std::string source;              // name of the source, e.g. of the clip; empty = unknown
  std::string method;              // "paper" | "hovermodal"
  std::string title;               // of the measurement, from its user; empty = none
  std::vector<std::string> notes;  // "place: ..." is a fact, anything else a paragraph
  std::vector<std::string> corrections, caveats;
  core::Health health;
  bool merged = false;                          // of several set-ups, each of which has its own report
  bool counted = true;                          // false: of a time series, for which `health` has no counters
  int image_width_px = 0, image_height_px = 0;  // of the tracks, if there is no frame
};

// Contents of the pictures; everything is borrowed. A null pointer or an empty list means not available.
struct PictureInputs {
  const core::Frame* first_frame = nullptr;
  const core::TrackFrame* keyframe = nullptr;  // points in the first frame
  std::vector<core::Region> regions;           // in the order of ChannelInfo::region and TrackPoint::region
  std::vector<core::ChannelInfo> channels;     // in the order of the spectrum and of the shapes
  const core::CpsdSums* spectrum = nullptr;
  const core::ModalEstimate* estimate = nullptr;
  const core::closure::ClosureReport* closure = nullptr;
  const RunHistory* history = nullptr;
  std::string unit = "px";                    // of the displacements
  double max_frequency_hz = 0.0;              // highest true frequency searched; 0 = half the rate
  const RunFacts* facts = nullptr;            // non-null: report.html is written
  std::shared_ptr<const ModalReport> former;  // a former run or a model, with which the page compares the modes
  std::string former_name;                    // its file, for a reader
  std::string former_fault;                   // why it could not be read
  const SpectralLines* lines = nullptr;       // of `spectrum`; set by the page itself
};

// Draws the results of a run into an existing folder and returns the names of the files written: frame.png (regions and
// points in the first frame), displacements.svg, scale.svg (where the scale varies), spectra.svg, modes.svg, each below
// 500 kB, and report.html (report_page.h). The same bytes for the same input. A picture without its inputs is omitted,
// and an older one of that name removed. Throws only drivers::FileError, which names every picture that failed; the
// others are complete.
std::vector<std::string> write_pictures(const std::string& directory, const PictureInputs& inputs);

}  // namespace app
