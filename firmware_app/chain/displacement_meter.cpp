#include "firmware_app/chain/displacement_meter.h"

#include <utility>

#include "firmware_app/chain/rebuild.h"

namespace app {

bool DisplacementMeter::begin_frame(std::uint64_t sequence) noexcept {
  if (pending_.geometry == nullptr) return false;
  const bool begins =
      pending_.rebuilt != nullptr ? pending_.rebuilt->begins_with(sequence) : sequence >= pending_.from_sequence;
  if (!begins) return false;
  channels_ = &pending_.geometry->displacement;
  readout_ = &pending_.geometry->readout;
  rebuilt_ = pending_.rebuilt;
  if (rebuilt_ != nullptr) std::swap(offset_, rebuilt_->offset());
  correction_set_ = pending_.correction_set, record_ = pending_.record;
  pending_ = {};
  return true;
}

void DisplacementMeter::measure(core::TrackFrame& tracks, std::uint32_t stride,
                                core::DisplacementSample& out) noexcept {
  if (lattice_ != nullptr) lattice_->round(tracks);
  channels_->update(tracks, out);
  offset_.subtract_from(out);
  axes_.add(tracks);
  // Its filters are made for the camera's own rate; the readout is the same at any.
  if (stride == 1) readout_->update(tracks);
  out.readout = readout_->estimate();
  out.correction_set = correction_set_, out.record = record_;
  out.stride = stride;
}

}  // namespace app
