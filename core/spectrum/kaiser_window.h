#pragma once

namespace core {

// Kaiser window at `edge`, -1 ... 1 across the window: I0(beta sqrt(1 - edge^2)) / I0(beta) (Kaiser 1974), I0 by its
// power series. std::cyl_bessel_i is not used: libstdc++ computes it through lgamma, which writes a global variable,
// and windows are computed by several threads.
[[nodiscard]] double kaiser_window(double edge, double beta) noexcept;

}  // namespace core
