#pragma once

namespace core {

// Kaiser's window at `edge`, from -1 to 1 across it: I0(beta sqrt(1 - edge^2)) / I0(beta) (Kaiser 1974), I0 by its power
// series. Not std::cyl_bessel_i: libstdc++ computes it by way of lgamma, which writes a global variable, and windows are
// made by several threads.
[[nodiscard]] double kaiser_window(double edge, double beta) noexcept;

}  // namespace core
