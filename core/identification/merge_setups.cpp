#include "core/identification/merge_setups.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

#include "core/identification/folding.h"
#include "core/identification/mac.h"

namespace core {

namespace {

using Shape = std::vector<std::complex<double>>;

constexpr double kSetupFrequencyTolerance = 0.03;  // relative
constexpr double kSetupMacTolerance = 0.5;         // wide: over few channels the MAC is little evidence

struct Member {
  std::size_t setup = 0;
  const Mode* mode = nullptr;
  Shape reference_part;
};
using Group = std::vector<Member>;  // one mode, at most one member per set-up

double distance(const Member& a, const Member& b) {
  const double mean_hz = 0.5 * (a.mode->frequency_hz + b.mode->frequency_hz);
  const double df = std::abs(a.mode->frequency_hz - b.mode->frequency_hz) / (kSetupFrequencyTolerance * mean_hz);
  return df + (1.0 - mac(a.reference_part, b.reference_part)) / kSetupMacTolerance;
}

class Merger {
 public:
  explicit Merger(const std::vector<SetupModes>& setups) : setups_(setups) {
    if (setups.size() < 2) throw std::invalid_argument("merging needs two set-ups or more");
    if (setups.front().references.empty())
      throw std::invalid_argument("the set-ups share no reference: name the channels that were never moved");
    for (const SetupModes& setup : setups) {
      index_of_references_.push_back(reference_indices(setup));
      total_s_ += setup.estimate.duration_s;
    }
    list_channels();
  }

  [[nodiscard]] MergedSetups merge() {
    ModalEstimate& estimate = out_.estimate;
    estimate.final = true;
    for (const SetupModes& setup : setups_) {
      estimate.n_samples += setup.estimate.n_samples;
      estimate.n_segments += setup.estimate.n_segments;
      estimate.n_missing += setup.estimate.n_missing;
      estimate.duration_s += setup.estimate.duration_s;
    }
    estimate.rate_hz = setups_.front().estimate.rate_hz;
    for (const Group& group : matched()) {
      if (group.size() == setups_.size()) {
        estimate.modes.push_back(joined(group));
      } else {
        estimate.rejected.push_back(incomplete(group));
      }
    }
    const auto by_frequency = [](const Mode& a, const Mode& b) { return a.frequency_hz < b.frequency_hz; };
    std::sort(estimate.modes.begin(), estimate.modes.end(), by_frequency);
    std::sort(estimate.rejected.begin(), estimate.rejected.end(), by_frequency);
    estimate.status = estimate.modes.empty() ? "no mode was found in every set-up" : "ok";
    return std::move(out_);
  }

 private:
  static std::vector<std::size_t> reference_indices(const SetupModes& setup) {
    std::vector<std::size_t> indices;
    for (const std::string& name : setup.references) {
      const auto found =
          std::find_if(setup.channels.begin(), setup.channels.end(), [&](const auto& c) { return c.name == name; });
      if (found == setup.channels.end())
        throw std::invalid_argument("set-up " + setup.name + " has no channel " + name +
                                    " left: a reference must be in every set-up");
      indices.push_back(static_cast<std::size_t>(found - setup.channels.begin()));
    }
    return indices;
  }

  void list_channels() {
    const std::size_t n_references = index_of_references_.front().size();
    for (std::size_t j = 0; j < setups_.size(); ++j) {
      const SetupModes& setup = setups_[j];
      if (index_of_references_[j].size() != n_references)
        throw std::invalid_argument("set-up " + setup.name + " names another number of references");
      auto& places = place_of_channel_.emplace_back(setup.channels.size(), 0);
      for (std::size_t c = 0; c < setup.channels.size(); ++c) {
        const auto& own = index_of_references_[j];
        const auto at = std::find(own.begin(), own.end(), c);
        if (at != own.end()) {
          places[c] = static_cast<std::size_t>(at - own.begin());
          if (j == 0) continue;
        }
        if (at == own.end()) places[c] = n_references + n_roving_++;
      }
    }
    out_.channels.resize(n_references + n_roving_);
    for (std::size_t j = setups_.size(); j-- > 0;) {
      for (std::size_t c = 0; c < setups_[j].channels.size(); ++c) {
        const std::size_t place = place_of_channel_[j][c];
        ChannelInfo info = setups_[j].channels[c];
        if (place >= n_references) info.name = setups_[j].name + "." + info.name;
        info.region = static_cast<std::uint16_t>(place);
        info.row_delay_s = 0.0;  // already removed from the shapes
        out_.channels[place] = info;
      }
    }
  }

  [[nodiscard]] std::vector<Group> matched() const {
    std::vector<Group> groups;
    for (std::size_t j = 0; j < setups_.size(); ++j) {
      for (const Mode& mode : setups_[j].estimate.modes) {
        Member member{j, &mode, {}};
        for (const std::size_t c : index_of_references_[j]) member.reference_part.push_back(mode.shape[c]);
        groups.push_back({member});
      }
    }
    while (join_nearest(groups)) {
    }
    return groups;
  }

  // Mean distance of the members; above 1 if both groups contain a mode of the same set-up.
  static double group_distance(const Group& a, const Group& b) {
    double sum = 0.0;
    for (const Member& m : a) {
      for (const Member& n : b) {
        if (m.setup == n.setup) return std::numeric_limits<double>::infinity();
        sum += distance(m, n);
      }
    }
    return sum / static_cast<double>(a.size() * b.size());
  }

  static bool join_nearest(std::vector<Group>& groups) {
    double nearest = 1.0;
    std::size_t i_best = 0;
    std::size_t j_best = 0;
    for (std::size_t i = 0; i < groups.size(); ++i) {
      for (std::size_t j = i + 1; j < groups.size(); ++j) {
        const double d = group_distance(groups[i], groups[j]);
        if (!(d < nearest)) continue;
        nearest = d;
        i_best = i;
        j_best = j;
      }
    }
    if (j_best == 0) return false;
    groups[i_best].insert(groups[i_best].end(), groups[j_best].begin(), groups[j_best].end());
    groups.erase(groups.begin() + static_cast<std::ptrdiff_t>(j_best));
    return true;
  }

  [[nodiscard]] double weight(const Member& member) const {
    const double duration_s = setups_[member.setup].estimate.duration_s;
    return duration_s > 0.0 ? duration_s : std::numeric_limits<double>::min();
  }

  void average(const Group& group, Mode& mode) const {
    double total = 0.0;
    double variance_f = 0.0;
    double variance_z = 0.0;
    bool known = true;
    mode.presence = 1.0;
    for (const Member& m : group) {
      const double w = weight(m);
      total += w;
      mode.frequency_hz += w * m.mode->frequency_hz;
      mode.apparent_hz += w * m.mode->apparent_hz;
      mode.damping_ratio += w * m.mode->damping_ratio;
      mode.presence = std::min(mode.presence, m.mode->presence);
      known = known && m.mode->frequency_std_hz && m.mode->damping_std;
      variance_f += std::pow(w * m.mode->frequency_std_hz.value_or(0.0), 2);
      variance_z += std::pow(w * m.mode->damping_std.value_or(0.0), 2);
    }
    mode.frequency_hz /= total;
    mode.apparent_hz /= total;
    mode.damping_ratio /= total;
    if (!known) return;
    mode.frequency_std_hz = std::sqrt(variance_f) / total;
    mode.damping_std = std::sqrt(variance_z) / total;
  }

  // Complex factor that fits `part` to `target` by least squares.
  static std::complex<double> scale_to(const Shape& target, const Shape& part) {
    std::complex<double> inner = 0.0;
    double power = 0.0;
    for (std::size_t i = 0; i < part.size(); ++i) {
      inner += std::conj(part[i]) * target[i];
      power += std::norm(part[i]);
    }
    return power > 0.0 ? inner / power : 0.0;
  }

  [[nodiscard]] Mode joined(const Group& group) {
    Mode mode;
    average(group, mode);
    mode.shape.assign(out_.channels.size(), 0.0);
    double total = 0.0;
    double least_mac = 1.0;
    for (const Member& m : group) {
      const std::complex<double> scale = scale_to(group.front().reference_part, m.reference_part);
      least_mac = std::min(least_mac, mac(group.front().reference_part, m.reference_part));
      const double w = weight(m);
      total += w;
      for (std::size_t c = 0; c < m.mode->shape.size(); ++c) {
        const std::size_t place = place_of_channel_[m.setup][c];
        const bool is_reference = place < m.reference_part.size();
        mode.shape[place] += scale * m.mode->shape[c] * (is_reference ? w : 1.0);
      }
    }
    for (std::size_t r = 0; r < group.front().reference_part.size(); ++r) mode.shape[r] /= total;
    normalise_shape(mode.shape);
    mode.mpc = mpc(mode.shape);
    mode.verdict = Verdict::kStructural;
    mode.reason = text_of(group) + ", least MAC over the references " + rounded(least_mac);
    return mode;
  }

  [[nodiscard]] Mode incomplete(const Group& group) const {
    Mode mode;
    average(group, mode);
    mode.mpc = group.front().mode->mpc;
    mode.verdict = Verdict::kNumerical;
    mode.reason = text_of(group) + ": its shape cannot be joined";
    return mode;
  }

  [[nodiscard]] std::string text_of(const Group& group) const {
    if (group.size() == setups_.size()) return "found in all " + std::to_string(group.size()) + " set-ups";
    std::string names;
    for (const Member& m : group) names += (names.empty() ? "" : ", ") + setups_[m.setup].name;
    return "found only in " + names;
  }

  static std::string rounded(double value) { return std::to_string(std::round(value * 1e3) / 1e3).substr(0, 5); }

  const std::vector<SetupModes>& setups_;
  std::vector<std::vector<std::size_t>> index_of_references_;  // per set-up
  std::vector<std::vector<std::size_t>> place_of_channel_;     // per set-up and channel: index in the joined shape
  std::size_t n_roving_ = 0;
  double total_s_ = 0.0;
  MergedSetups out_;
};

}  // namespace

MergedSetups merge_setups(const std::vector<SetupModes>& setups) { return Merger(setups).merge(); }

}  // namespace core
