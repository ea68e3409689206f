#include "core/identification/mode_scatter.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/identification/phase_line.h"

namespace core {

namespace {

using Complex = std::complex<double>;

// A shape with its row delays undone, and how a change of the observed pole changes it.
class StatedShape {
 public:
  // The largest of the first `n_own` components is 1, and the line is theirs.
  StatedShape(const PoleOfOrder& pole, const FoldingConfig& folding, int fold_n, std::size_t n_own)
      : pole_(pole.pole), folding_(folding), n_(pole.pole.shape.size()), n_own_(n_own) {
    s_ = std::log(pole_.lambda) * folding.rate_hz + Complex(0.0, 2.0 * std::numbers::pi * fold_n * folding.rate_hz);
    for (std::size_t c = 0; c < n_; ++c) {
      const double delay_s = c < folding.delay_s.size() ? folding.delay_s[c] : 0.0;
      const int n_integrations = c < folding.n_integrations.size() ? folding.n_integrations[c] : 0;
      undone_.push_back(std::exp(-s_ * delay_s) / std::pow(s_, n_integrations));
      by_s_.push_back(delay_s + static_cast<double>(n_integrations) / s_);
      x_.push_back(pole_.shape[c] * undone_[c]);
      if (c >= n_own_) continue;
      if (std::norm(x_[c]) > std::norm(x_[largest_])) largest_ = c;
      square_ += std::norm(x_[c]);
    }
    back_ = std::conj(phase_line(std::vector<Complex>(x_.begin(), x_.begin() + static_cast<std::ptrdiff_t>(n_own_))));
  }

  [[nodiscard]] std::vector<Complex> components(bool along) const {
    std::vector<Complex> out;
    for (const Complex& x : x_) {
      if (along) {
        out.emplace_back((x * back_).real() / (x_[largest_] * back_).real());
      } else {
        const Complex part = x / x_[largest_];
        out.push_back(s_.imag() < 0.0 ? std::conj(part) : part);
      }
    }
    return out;
  }

  struct Change {
    Complex s;                         // of the continuous pole
    std::vector<double> shape, along;  // as in ModeScatter
    double beside_line = 0.0;
  };
  [[nodiscard]] Change change(const PoleChange& by) const {
    Change out{by.lambda / pole_.lambda * folding_.rate_hz, {}, {}, 0.0};
    std::vector<Complex> dx(n_);
    for (std::size_t c = 0; c < n_; ++c) dx[c] = (by.shape[c] - by_s_[c] * out.s * pole_.shape[c]) * undone_[c];
    const Complex by_largest = dx[largest_] / x_[largest_];
    const double most = (x_[largest_] * back_).real(), d_most = (dx[largest_] * back_).real();
    double turn = 0.0, beside = 0.0, line = 0.0;
    for (std::size_t c = 0; c < n_; ++c) {
      const Complex own = x_[c] * back_, moved = dx[c] * back_;
      out.shape.push_back(((dx[c] - x_[c] * by_largest) / x_[largest_]).real());
      out.along.push_back((moved.real() - own.real() / most * d_most) / most);
      if (c >= n_own_) continue;
      turn += own.real() * moved.imag(), line += own.real() * own.real(), beside += moved.imag() * moved.imag();
    }
    out.beside_line = (beside - turn * turn / line) / square_;
    if (s_.imag() < 0.0) out.s = std::conj(out.s);  // the real parts of a shape equal those of its conjugate
    return out;
  }

 private:
  const DiscretePole& pole_;
  const FoldingConfig& folding_;
  std::size_t n_, n_own_, largest_ = 0;
  Complex s_, back_;
  double square_ = 0.0;
  std::vector<Complex> undone_, by_s_, x_;
};

}  // namespace

std::vector<std::complex<double>> stated_components(const PoleOfOrder& pole, const UnfoldedPole& unfolded,
                                                    const FoldingConfig& folding, bool along, std::size_t n_own) {
  return StatedShape(pole, folding, unfolded.fold_n.value_or(0), n_own).components(along);
}

std::optional<ModeScatter> mode_scatter(const PoleOfOrder& pole, const UnfoldedPole& unfolded,
                                        const FoldingConfig& folding, const std::vector<PoleChange>& changes,
                                        std::size_t n_own) {
  if (changes.size() < kLeastScatterBlocks) return std::nullopt;
  const double size = std::abs(unfolded.s), zeta = -unfolded.s.real() / size;
  const StatedShape stated(pole, folding, unfolded.fold_n.value_or(0), std::min(n_own, pole.pole.shape.size()));
  ModeScatter sum;
  sum.shape.assign(pole.pole.shape.size(), 0.0);
  sum.along = sum.shape;
  for (const PoleChange& change : changes) {
    const StatedShape::Change moved = stated.change(change);
    const double d_size = (std::conj(unfolded.s) * moved.s).real() / size;
    const double d_zeta = -(moved.s.real() + zeta * d_size) / size;
    sum.frequency_hz += d_size * d_size;
    sum.damping_ratio += d_zeta * d_zeta;
    sum.beside_line += moved.beside_line;
    for (std::size_t c = 0; c < sum.shape.size(); ++c) {
      sum.shape[c] += moved.shape[c] * moved.shape[c];
      sum.along[c] += moved.along[c] * moved.along[c];
    }
  }
  const double factor = static_cast<double>(changes.size()) / (static_cast<double>(changes.size()) - 1.0);
  sum.frequency_hz = std::sqrt(sum.frequency_hz * factor) / (2.0 * std::numbers::pi);
  sum.damping_ratio = std::sqrt(sum.damping_ratio * factor);
  sum.beside_line *= factor;
  bool finite = std::isfinite(sum.frequency_hz) && std::isfinite(sum.damping_ratio) && std::isfinite(sum.beside_line);
  for (auto* squares : {&sum.shape, &sum.along}) {
    for (double& square : *squares) {
      square = std::sqrt(square * factor);
      finite = finite && std::isfinite(square);
    }
  }
  return finite ? std::optional(std::move(sum)) : std::nullopt;
}

}  // namespace core
