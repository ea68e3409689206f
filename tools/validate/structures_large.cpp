// A wall of 10^5 degrees of freedom as files for closeloop: bilinear elements in plane stress, twenty groups.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/SparseCore>
#include <array>
#include <chrono>
#include <cmath>
#include <fstream>
#include <stdexcept>
#include <vector>

#include "core/structure/kinds/matrices.h"
#include "tools/validate/drawn_scene.h"
#include "tools/validate/structures.h"

namespace tools {
namespace {

using core::structure::SparseMatrix;
using Eigen::Index;

constexpr int kGroups = 20, kSeenModesOfWall = 12, kRegions = 8, kSoftGroup = 7;
constexpr double kSoftTo = 0.7, kWallFrequencySigma = 0.001, kWallShapeSigma = 0.01;

// Of a square bilinear element of unit size in plane stress, by 2 x 2 Gauss points; E t = 1, Poisson's ratio 0.2.
Eigen::Matrix<double, 8, 8> square_element() {
  constexpr double kPoisson = 0.2;
  Eigen::Matrix3d d;
  d << 1, kPoisson, 0, kPoisson, 1, 0, 0, 0, 0.5 * (1 - kPoisson);
  d /= 1 - kPoisson * kPoisson;
  constexpr std::array<std::array<double, 2>, 4> kCorners{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
  Eigen::Matrix<double, 8, 8> out = Eigen::Matrix<double, 8, 8>::Zero();
  const double g = 1.0 / std::sqrt(3.0);
  for (const auto& [px, py] : kCorners) {
    Eigen::Matrix<double, 3, 8> b = Eigen::Matrix<double, 3, 8>::Zero();
    for (Index i = 0; i < 4; ++i) {
      const auto& [x, y] = kCorners[static_cast<std::size_t>(i)];
      const double dx = 0.5 * x * (1 + y * py * g), dy = 0.5 * y * (1 + x * px * g);
      b(0, 2 * i) = dx, b(1, 2 * i + 1) = dy, b(2, 2 * i) = dy, b(2, 2 * i + 1) = dx;
    }
    out += 0.25 * b.transpose() * d * b;
  }
  return out;
}

void write(const std::string& path, const SparseMatrix& a) {
  std::ofstream file(path);
  fmt::memory_buffer text;
  std::size_t n = 0;
  for (int c = 0; c < a.outerSize(); ++c) {
    for (SparseMatrix::InnerIterator it(a, c); it; ++it) {
      if (it.row() < c) continue;
      fmt::format_to(std::back_inserter(text), "{} {} {:.17g}\n", it.row() + 1, c + 1, it.value());
      ++n;
    }
  }
  file << fmt::format("%%MatrixMarket matrix coordinate real symmetric\n{} {} {}\n", a.rows(), a.cols(), n)
       << fmt::to_string(text);
  if (!file.flush()) throw std::runtime_error(path + ": cannot be written");
}

// The time of our solution of the eigenproblem as declared, and its frequencies, for a comparison with other solvers.
void print_eigenproblem(const core::structure::MatrixStructure& s) {
  const std::vector<double> declared(s.groups.size(), 1.0);
  const auto begin = std::chrono::steady_clock::now();
  const auto modes = core::structure::exact_modes(s, declared, kSeenModesOfWall);
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
  fmt::print("eigen\t{:.2f}\t{:.12g}\n", taken.count(),
             fmt::join(modes.frequency_hz.data(), modes.frequency_hz.data() + modes.frequency_hz.size(), "\t"));
}

}  // namespace

void write_large_structure(const std::string& folder, int first_seed) {
  constexpr Index kAcross = 100, kUp = 500;  // elements; nodes of the lowest row are held
  constexpr double kStiffness = 4.0e9, kNodeKg = 900.0;
  const Eigen::Matrix<double, 8, 8> element = kStiffness * square_element();
  const Index n = 2 * (kAcross + 1) * kUp;
  const auto dof = [&](Index x, Index y, Index axis) {
    return y == 0 ? Index{-1} : 2 * ((y - 1) * (kAcross + 1) + x) + axis;
  };
  std::vector<std::vector<Eigen::Triplet<double>>> parts(kGroups);
  for (Index y = 0; y < kUp; ++y) {
    auto& part = parts[static_cast<std::size_t>(y * kGroups / kUp)];
    for (Index x = 0; x < kAcross; ++x) {
      const std::array<Index, 8> at{dof(x, y, 0),         dof(x, y, 1),         dof(x + 1, y, 0), dof(x + 1, y, 1),
                                    dof(x + 1, y + 1, 0), dof(x + 1, y + 1, 1), dof(x, y + 1, 0), dof(x, y + 1, 1)};
      for (std::size_t i = 0; i < 8; ++i) {
        for (std::size_t k = 0; k < 8; ++k) {
          if (at[i] < 0 || at[k] < 0) continue;
          part.emplace_back(static_cast<int>(at[i]), static_cast<int>(at[k]),
                            element(static_cast<Index>(i), static_cast<Index>(k)));
        }
      }
    }
  }
  core::structure::MatrixStructure s;
  s.stiffness.resize(n, n), s.mass.resize(n, n);
  std::vector<double> factors;
  for (int g = 0; g < kGroups; ++g) {
    SparseMatrix part(n, n);
    part.setFromTriplets(parts[static_cast<std::size_t>(g)].begin(), parts[static_cast<std::size_t>(g)].end());
    s.stiffness += part;
    write(fmt::format("{}/k{}.mtx", folder, g + 1), part);
    s.groups.push_back({fmt::format("g{}", g + 1), std::move(part), {}, 0.0});
    factors.push_back(g + 1 == kSoftGroup ? kSoftTo : 1.0);
  }
  s.mass.setIdentity();
  s.mass *= kNodeKg;
  write(folder + "/k.mtx", s.stiffness);
  write(folder + "/m.mtx", s.mass);
  std::string yaml = "structure:\n  kind: matrices\n  k: k.mtx\n  m: m.mtx\n  modes: 12\n  groups:\n";
  for (int g = 1; g <= kGroups; ++g) yaml += fmt::format("    - {{name: g{}, k: k{}.mtx}}\n", g, g);
  yaml += "  regions:\n";
  std::string table = "frequency_hz,sigma_hz";
  for (int r = 1; r <= kRegions; ++r) {
    // The last one sees the top's vertical motion, by which modes along the wall are known.
    const Index d = r == kRegions ? dof(kAcross / 2, kUp, 1) : dof(kAcross / 2, kUp * r / (kRegions - 1), 0);
    s.seen.push_back({fmt::format("r{}", r), {{static_cast<std::size_t>(d), 1.0}}});
    yaml += fmt::format("    - {{name: r{}, dofs: [{}]}}\n", r, d + 1);
    table += fmt::format(",r{}", r);
  }
  const auto modes = core::structure::exact_modes(s, factors, kSeenModesOfWall);
  Draw draw(static_cast<std::uint64_t>(first_seed), "large");
  for (Index r = 0; r < modes.frequency_hz.size(); ++r) {
    const double hz = modes.frequency_hz(r) * (1.0 + kWallFrequencySigma * draw.gaussian());
    table += fmt::format("\n{:.9g},{:.9g}", hz, kWallFrequencySigma * hz);
    const double largest = modes.shapes.col(r).cwiseAbs().maxCoeff();
    for (Index i = 0; i < modes.shapes.rows(); ++i)
      table += fmt::format(",{:.6g}", modes.shapes(i, r) / largest + kWallShapeSigma * draw.gaussian());
  }
  std::ofstream(folder + "/wall.yaml") << yaml;
  std::ofstream(folder + "/modes.csv") << table << '\n';
  fmt::print("large\t{}\t{}\t{}\t{}\n", n, kGroups, kSoftGroup, kSoftTo);
  print_eigenproblem(s);
}

}  // namespace tools
