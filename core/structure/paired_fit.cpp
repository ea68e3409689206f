#include "core/structure/paired_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "core/structure/mode_residuals.h"

namespace core::structure {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kWrong = 0.2;                           // relative error of frequency of a mode without a partner
constexpr double kClear = 1.0;                           // Pairing::worst up to which no other pairing is sought
constexpr std::size_t kMostTried = 8;                    // pairings of one model
constexpr std::size_t kMostStarts = 3;                   // initial values of one pairing
constexpr std::array kShares{0.03, 0.1, 0.3, 1.0, 3.0};  // of an initial value's distance from no effect

// Initial values that give one pairing, the nearest to the data first.
struct Tried {
  double cost = std::numeric_limits<double>::infinity();  // least of the pairing
  std::vector<std::pair<double, VectorXd>> starts;        // sum of squares, parameters
};

class PairingSearch {
 public:
  PairingSearch(const FrameModel& model, const std::vector<ReferenceMode>& measured)
      : model_(model), measured_(measured) {}

  PairedFit run(const std::vector<int>& number, const VectorXd& before) {
    const VectorXd base = start_of(before);
    add(base, number);
    scan(base);
    std::vector<std::pair<double, std::vector<int>>> order;
    for (const auto& [own, tried] : tried_) order.emplace_back(own == number ? -1.0 : tried.cost, own);
    std::sort(order.begin(), order.end());
    for (const auto& [cost, own] : order) follow(own);
    return std::move(best_);
  }

 private:
  // The parameters known so far, and none of the effects after them.
  [[nodiscard]] VectorXd start_of(const VectorXd& before) const {
    VectorXd out = VectorXd::Zero(model_.n_parameters());
    out.head(std::min(before.size(), out.size())) = before.head(std::min(before.size(), out.size()));
    if (before.size() >= out.size() || model_.effects.empty()) return out;
    const auto own = model_.effects.back()->parameters(*model_.declared);
    for (std::size_t k = 0; k < own.size(); ++k)
      out(out.size() - static_cast<Index>(own.size() - k)) = own[k].is_place ? 1.0 : own[k].neutral;
    return out;
  }

  // Sizes of the last effect at all its places.
  void scan(const VectorXd& base) {
    if (model_.effects.empty()) {
      add(base, pairing_at(base).number);
      return;
    }
    const auto own = model_.effects.back()->parameters(*model_.declared);
    if (own.empty() || own.back().is_place || !std::isfinite(own.back().neutral)) return;
    const EffectParameter& size = own.back();
    const bool placed = own.size() == 2 && own.front().is_place;
    for (const double place : placed ? own.front().starts : std::vector<double>{1.0}) {
      for (const double start : size.starts) {
        for (const double share : kShares) {
          VectorXd p = base;
          if (placed) p(p.size() - 2) = place;
          p(p.size() - 1) = std::clamp(size.neutral + share * (start - size.neutral), size.low, size.high);
          const Pairing pairing = pairing_at(p);
          if (pairing.number.empty()) continue;
          add(p, pairing.number);
          Tried& tried = tried_[pairing.number];
          tried.cost = std::min(tried.cost, pairing.cost);
        }
      }
    }
  }

  [[nodiscard]] Pairing pairing_at(const VectorXd& p) const {
    const auto modes = seen_modes(model_, p, true);
    if (!modes) return {};
    return pair_modes(modes->frequency_hz, modes->shapes, model_.has_scale(), measured_);
  }

  void add(const VectorXd& p, const std::vector<int>& number) {
    VectorXd residuals;
    const auto reference = numbered(measured_, number);
    if (reference.size() < 2 || !residuals_of(model_, reference, -1, p, residuals)) return;
    auto& starts = tried_[number].starts;
    starts.emplace_back(residuals.squaredNorm(), p);
    std::sort(starts.begin(), starts.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    if (starts.size() > kMostStarts) starts.pop_back();
  }

  // Fits under these numbers, and under those that the fit gives, until they stay.
  void follow(std::vector<int> number) {
    while (fitted_.size() < kMostTried) {
      const auto starts = tried_[number].starts;
      if (starts.empty() || !fitted_.insert(number).second) return;
      const auto reference = numbered(measured_, number);
      FrameFit fit;
      for (const auto& [squares, start] : starts) {
        FrameFit one = fit_frame(model_, reference, start, Starts::kBest);
        if (one.ok && (!fit.ok || one.chi2 < fit.chi2)) fit = std::move(one);
      }
      if (!fit.ok) return;
      std::vector<int> own = pairing_of(model_, fit, measured_).number;
      if (own.empty()) return;
      if (own == number) return keep({std::move(number), std::move(fit), 0.0});
      add(fit.parameters, own);
      number = std::move(own);
    }
  }

  void keep(PairedFit one) {
    one.cost = one.fit.chi2;
    for (std::size_t i = 0; i < measured_.size(); ++i) {
      const double wrong = kWrong * measured_[i].frequency_hz / measured_[i].sigma_hz;
      if (one.number[i] == 0) one.cost += wrong * wrong;
    }
    if (!best_.fit.ok || one.cost < best_.cost) best_ = std::move(one);
  }

  const FrameModel& model_;
  const std::vector<ReferenceMode>& measured_;
  std::map<std::vector<int>, Tried> tried_;
  std::set<std::vector<int>> fitted_;
  PairedFit best_;
};

}  // namespace

Pairing pairing_of(const FrameModel& model, const FrameFit& fit, const std::vector<ReferenceMode>& measured) {
  const auto modes = fit.ok ? seen_modes(model, fit.parameters, true) : std::nullopt;
  if (!modes) return {};
  return pair_modes(modes->frequency_hz, modes->shapes, model.has_scale(), measured);
}

bool is_ambiguous(const Pairing& pairing) {
  return pairing.worst > kClear || std::count(pairing.number.begin(), pairing.number.end(), 0) > 0;
}

PairedFit fit_paired(const FrameModel& model, const std::vector<ReferenceMode>& measured,
                     const std::vector<int>& number, const VectorXd& before) {
  return PairingSearch(model, measured).run(number, before);
}

}  // namespace core::structure
