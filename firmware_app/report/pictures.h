#pragma once

#include <string>
#include <vector>

#include "core/types/cpsd.h"
#include "core/types/displacement.h"
#include "core/types/frame.h"
#include "core/types/modal_estimate.h"
#include "core/types/region.h"
#include "core/types/track.h"

namespace app {

// What the pictures show; everything is borrowed. A null pointer, an empty list, an empty path: not there.
struct PictureInputs {
  const core::Frame* first_frame = nullptr;
  const core::TrackFrame* keyframe = nullptr;  // points in the first frame
  std::vector<core::Region> regions;           // in the order of ChannelInfo::region and TrackPoint::region
  std::vector<core::ChannelInfo> channels;     // in the order of the spectrum and of the shapes
  const core::CpsdSums* spectrum = nullptr;
  const core::ModalEstimate* estimate = nullptr;
  std::string displacements_csv;  // path of the complete file
  bool millimetres = false;       // else pixels
};

// Draws what a run has found into an existing folder and returns the names of the files written, each below 500 kB and
// the same bytes for the same input: frame.png (regions and points in the first frame), displacements.svg, scale.svg
// (where the scale varies), spectra.svg, modes.svg. A picture without its inputs is left out, and an older one of that
// name removed. Throws nothing but one drivers::FileError that names every picture that failed; the others are
// complete.
std::vector<std::string> write_pictures(const std::string& directory, const PictureInputs& inputs);

}  // namespace app
