#include "drivers/exchange/exchange_run.h"

#include <cmath>

namespace drivers {

bool ExchangeRun::is_even() const noexcept {
  constexpr double kEvenSamples = 1e-3;
  for (std::size_t k = 0; k < t_s.size(); ++k) {
    const double off = (t_s[k] - t_s.front()) * rate_hz - static_cast<double>(k);
    if (!(std::abs(off) <= kEvenSamples)) return false;
  }
  return true;
}

}  // namespace drivers
