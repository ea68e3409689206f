#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <set>

#include "core/types/constants.h"
#include "drivers/exchange/series_file.h"
#include "drivers/exchange/uff_functions.h"
#include "drivers/storage/limits.h"
#include "drivers/storage/text_file.h"

namespace drivers {
namespace {

constexpr std::size_t kMostCells = Limits::kExchangeBytes / sizeof(double);  // of the table

// "KEY=NUMBER;" in ID line 5 of our own files.
std::optional<double> stated(const UffResponse& one, std::string_view key) {
  const std::size_t at = one.remark.find(key);
  if (at == std::string::npos) return std::nullopt;
  const std::size_t begin = at + key.size();
  return parse_number(std::string_view(one.remark).substr(begin, one.remark.find(';', begin) - begin));
}

// Where it agrees with the six digits of the increment.
double exact_rate_hz(const UffResponse& one, double rate_hz) {
  const auto exact = stated(one, "rate_hz=");
  return exact && (!(rate_hz > 0.0) || std::abs(*exact / rate_hz - 1.0) < 1e-4) ? *exact : rate_hz;
}

double own_rate_hz(const UffResponse& one) {
  if (one.even) return exact_rate_hz(one, one.step_s > 0.0 ? 1.0 / one.step_s : 0.0);
  if (const double exact = exact_rate_hz(one, 0.0); exact > 0.0) return exact;
  std::vector<double> steps;
  for (std::size_t k = 1; k < one.t_s.size(); ++k) steps.push_back(one.t_s[k] - one.t_s[k - 1]);
  if (steps.empty()) return 0.0;
  std::nth_element(steps.begin(), steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2), steps.end());
  const double median = steps[steps.size() / 2];
  return median > 0.0 ? 1.0 / median : 0.0;
}

class UffSeries {
 public:
  explicit UffSeries(const std::string& path) : path_(path), responses_(read_uff_responses(path)) {}

  [[nodiscard]] SeriesFile read() {
    if (responses_.empty()) refuse("no time response (data set 58, function type 1) in the universal file");
    if (responses_.size() + 1 > Limits::kColumns)
      refuse(fmt::format("{} time responses; at most {}", responses_.size(), Limits::kColumns - 1));
    find_rate();
    name_columns();
    const bool share_times = std::all_of(responses_.begin(), responses_.end(), [&](const UffResponse& one) {
      return !one.even && one.t_s == responses_.front().t_s;
    });
    share_times ? take_times() : place_on_grid();
    return std::move(out_);
  }

 private:
  [[noreturn]] void refuse(const std::string& what) const { throw FileError(path_ + ": " + what); }

  void find_rate() {
    for (const UffResponse& one : responses_) {
      const double rate_hz = own_rate_hz(one);
      if (!(rate_hz > 0.0)) refuse(fmt::format("`{}` has no time step", printable(one.title)));
      if (rate_hz_ == 0.0) rate_hz_ = rate_hz;
      if (std::abs(rate_hz / rate_hz_ - 1.0) > 1e-3) {
        refuse(fmt::format("`{}` has {:.6g} samples a second, `{}` {:.6g}; export the rates to files of their own",
                           printable(responses_.front().title), rate_hz_, printable(one.title), rate_hz));
      }
    }
    out_.rate_hz = rate_hz_;
  }

  // ID line 1 where every response has one of its own, else entity, node and direction.
  void name_columns() {
    std::set<std::string> titles;
    for (const UffResponse& one : responses_) {
      if (!one.title.empty() && one.title.size() <= 64) titles.insert(one.title);
    }
    const bool by_title = titles.size() == responses_.size();
    std::set<std::string> used;
    for (const UffResponse& one : responses_) {
      std::string name = by_title ? one.title
                                  : fmt::format("{}{}{}{}", one.entity, one.entity.empty() ? "" : "_", one.node,
                                                direction(one.direction));
      try {
        require_text(name, "");
      } catch (const FileError&) {
        name = fmt::format("response_{}", used.size() + 1);
      }
      for (int copy = 2; !used.insert(name).second; ++copy) name = fmt::format("{}_{}", name, copy);
      if (const auto delay_s = stated(one, "delay_s="))
        out_.comments["row_delay_s." + name] = fmt::format("{}", *delay_s);
      out_.names.push_back(name);
      out_.units.push_back(one.unit);
    }
  }
  static std::string direction(int number) {
    constexpr std::array<const char*, 7> kAxes{"", "x", "y", "z", "rx", "ry", "rz"};
    const int axis = std::abs(number);
    return axis > 6 ? std::string() : std::string(number < 0 ? "-" : "") + kAxes[static_cast<std::size_t>(axis)];
  }

  void take_times() {
    const std::vector<double>& t_s = responses_.front().t_s;
    if (!std::is_sorted(t_s.begin(), t_s.end(), std::less_equal<>())) refuse("times that do not increase");
    out_.names.insert(out_.names.begin(), "t_s");
    out_.units.insert(out_.units.begin(), "");
    out_.columns.push_back(t_s);
    for (UffResponse& one : responses_) out_.columns.push_back(std::move(one.value));
  }

  void place_on_grid() {
    double first_s = 0.0, last_s = 0.0;
    bool any = false;
    for (const UffResponse& one : responses_) {
      for (const std::size_t k : {std::size_t{0}, one.value.size() - 1}) {
        if (one.value.empty()) continue;
        const double t_s = time(one, k);
        first_s = any ? std::min(first_s, t_s) : t_s, last_s = any ? std::max(last_s, t_s) : t_s;
        any = true;
      }
    }
    const double cells = std::round((last_s - first_s) * rate_hz_) + 1.0;
    if (!any || !(cells >= 1.0)) refuse("no value in the time responses");
    if (!(cells * static_cast<double>(responses_.size()) <= static_cast<double>(kMostCells)))
      refuse("the times extend over more samples than memory is taken for; are they seconds?");
    const auto n_cells = static_cast<std::size_t>(cells);
    for (const UffResponse& one : responses_) {
      std::vector<double>& column = out_.columns.emplace_back(n_cells, core::kNan);
      for (std::size_t k = 0; k < one.value.size(); ++k) {
        const double cell = std::round((time(one, k) - first_s) * rate_hz_);
        if (cell >= 0.0 && cell < cells) column[static_cast<std::size_t>(cell)] = one.value[k];
      }
    }
  }
  [[nodiscard]] double time(const UffResponse& one, std::size_t k) const {
    return one.even ? one.first_s + static_cast<double>(k) / rate_hz_ : one.t_s[k];
  }

  std::string path_;
  std::vector<UffResponse> responses_;
  double rate_hz_ = 0.0;
  SeriesFile out_;
};

}  // namespace

SeriesFile read_uff_series(const std::string& path) { return UffSeries(path).read(); }

}  // namespace drivers
