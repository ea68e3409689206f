#pragma once

#include <cstddef>

#include "core/types/vector2.h"

namespace core {

// Sums for a least-squares similarity p = turn k + shift (translation, rotation, magnification) from pairs (k, p):
// about their means, turn = (along + i across) / spread, with k and p as complex numbers u + i v.
struct SimilarityMoments {
  double count = 0.0;
  Vector2 mean_k, mean_p;
  double along = 0.0, across = 0.0, spread = 0.0;  // sums of k . p, k x p, k . k
  double squares = 0.0;                            // sum of p . p
};

// Sums over the points i of [begin, end) for which counts(i) is true; k(i), p(i): Vector2.
template <class Counts, class K, class P>
[[nodiscard]] SimilarityMoments similarity_moments(std::size_t begin, std::size_t end, const Counts& counts, const K& k,
                                                   const P& p) noexcept {
  SimilarityMoments out;
  Vector2 &mean_k = out.mean_k, &mean_p = out.mean_p;
  for (std::size_t i = begin; i < end; ++i) {
    if (!counts(i)) continue;
    mean_k = {mean_k.u + k(i).u, mean_k.v + k(i).v};
    mean_p = {mean_p.u + p(i).u, mean_p.v + p(i).v};
    out.count += 1.0;
  }
  if (out.count == 0.0) return out;
  mean_k = {mean_k.u / out.count, mean_k.v / out.count};
  mean_p = {mean_p.u / out.count, mean_p.v / out.count};
  for (std::size_t i = begin; i < end; ++i) {
    if (!counts(i)) continue;
    const Vector2 from{k(i).u - mean_k.u, k(i).v - mean_k.v}, to{p(i).u - mean_p.u, p(i).v - mean_p.v};
    out.along += from.u * to.u + from.v * to.v;
    out.across += from.u * to.v - from.v * to.u;
    out.spread += from.u * from.u + from.v * from.v;
    out.squares += to.u * to.u + to.v * to.v;
  }
  return out;
}

}  // namespace core
