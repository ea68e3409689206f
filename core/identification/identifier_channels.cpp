// Identification without the channels that have too little record.
#include <algorithm>
#include <complex>
#include <stdexcept>

#include "core/identification/field_shapes.h"
#include "core/identification/identifier.h"
#include "core/identification/spectral_peaks.h"
#include "core/spectrum/select_channels.h"

namespace core {

namespace {

template <class T>
void spread(std::vector<T>& values, const std::vector<std::size_t>& kept, std::size_t n) {
  if (values.empty()) return;
  std::vector<T> out(n, T{});
  for (std::size_t i = 0; i < values.size() && i < kept.size(); ++i) out[kept[i]] = values[i];
  values = std::move(out);
}

void spread(ModalEstimate& estimate, const std::vector<std::size_t>& kept, std::size_t n) {
  for (auto* modes : {&estimate.modes, &estimate.rejected}) {
    for (Mode& mode : *modes) {
      spread(mode.shape, kept, n);
      spread(mode.shape_std, kept, n);
    }
  }
  for (SpectralPeak& peak : estimate.peaks) spread(peak.share, kept, n);
}

}  // namespace

Identifier Identifier::with_channels(const std::vector<std::size_t>& kept) const {
  IdentifierConfig config = config_;
  config.references.clear();
  std::vector<ChannelInfo> channels;
  for (const std::size_t c : kept) {
    if (std::find(config_.references.begin(), config_.references.end(), static_cast<int>(c)) !=
        config_.references.end())
      config.references.push_back(static_cast<int>(channels.size()));
    channels.push_back(channels_[c]);
  }
  return {std::move(config), std::move(channels)};
}

ModalEstimate Identifier::identify_kept(const CpsdSums& sums, const Participation& part, FieldShapes* field) const {
  std::vector<ChannelRecord> records,
      outputs(part.records.begin(), part.records.begin() + static_cast<std::ptrdiff_t>(n_outputs()));
  std::vector<std::size_t> kept_outputs;
  for (const std::size_t c : part.kept) {
    records.push_back(part.records[c]);
    if (c < n_outputs()) kept_outputs.push_back(c);
  }
  ModalEstimate estimate;
  if (kept_outputs.empty()) {
    estimate = identify_all(sums, part.records, nullptr);
    estimate.modes.clear(), estimate.rejected.clear(), estimate.poles.clear();
    estimate.status =
        "no channel has a record to identify from: " + outputs_.front().name + ": " + outputs.front().reason;
  } else {
    estimate = with_channels(part.kept).identify_all(select_channels(sums, part.kept), records, field);
    if (field != nullptr) field->renumber(part.kept);
    spread(estimate, kept_outputs, n_outputs());
  }
  estimate.channels = std::move(outputs);
  return estimate;
}

ModalEstimate Identifier::identify(const CpsdSums& sums, FieldShapes* field) const {
  const Participation part = participation(sums, channels_);
  return part.all() ? identify_all(sums, part.records, field) : identify_kept(sums, part, field);
}

ModalEstimate Identifier::identify(const CpsdSums& sums) const { return identify(sums, nullptr); }

ModalEstimate Identifier::identify(const CpsdSums& sums, FieldShapes& field) const {
  if (n_outputs() != channels_.size()) throw std::invalid_argument("Identifier: a full field has no static region");
  field = FieldShapes();
  return identify(sums, &field);
}

}  // namespace core
