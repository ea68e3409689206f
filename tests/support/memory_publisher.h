#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

#include "drivers/telemetry/publisher.h"

namespace tests {

// Keeps a copy of everything published, in order per kind. Each call counts as one message.
class MemoryPublisher : public drivers::Publisher {
 public:
  bool publish(const core::ModalEstimate& estimate, const std::vector<core::ChannelInfo>& infos) noexcept override {
    channels = infos;
    estimates.push_back(estimate);
    return count();
  }
  bool publish(const core::DisplacementSample& sample, const std::vector<core::ChannelInfo>& infos) noexcept override {
    channels = infos;
    samples.push_back(sample);
    return count();
  }
  bool publish(const core::TrackFrame& frame) noexcept override {
    tracks.push_back(frame);
    return count();
  }
  bool publish(const core::CpsdSums& sums, const std::vector<core::ChannelInfo>& infos) noexcept override {
    channels = infos;
    spectra.push_back(sums);
    return count();
  }
  bool publish(const core::closure::ClosureReport& report) noexcept override {
    closures.push_back(report);
    return count();
  }
  bool publish(const core::Health& state) noexcept override {
    health.push_back(state);
    return count();
  }
  bool publish(const core::Preview& preview, const std::vector<core::Region>&) noexcept override {
    previews.push_back(preview);
    return count();
  }
  [[nodiscard]] std::uint64_t messages_sent() const noexcept override { return n_sent; }
  [[nodiscard]] std::uint64_t messages_failed() const noexcept override { return n_failed; }

  bool fail = false;  // every publish fails, but the item is still kept
  std::atomic<std::uint64_t> n_sent{0}, n_failed{0};
  std::vector<core::ChannelInfo> channels;
  std::vector<core::ModalEstimate> estimates;
  std::vector<core::DisplacementSample> samples;
  std::vector<core::TrackFrame> tracks;
  std::vector<core::CpsdSums> spectra;
  std::vector<core::closure::ClosureReport> closures;
  std::vector<core::Health> health;
  std::vector<core::Preview> previews;

 private:
  bool count() noexcept {
    ++(fail ? n_failed : n_sent);
    return !fail;
  }
};

}  // namespace tests
