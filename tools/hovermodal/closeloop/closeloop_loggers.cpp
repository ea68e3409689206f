// hovermodal closeloop --record a.csv b.csv ...: loggers on one structure, each with its own clock.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <stdexcept>

#include "core/closure/response/logger_model.h"
#include "tools/hovermodal/closeloop/series_loop.h"
#include "tools/hovermodal/closeloop/series_modes.h"

namespace tools {
namespace {

using core::closure::ClosureResult;

constexpr double kRigidShare = 0.7;        // of the lowest mode: below it the structure moves as a rigid body
constexpr double kMaterialExchange = 0.5;  // of 1 - MAC of the modes not used for the choice

// Records of one structure by loggers that were not synchronised: one file each.
class LoggerCloser {
 public:
  LoggerCloser(const LoopRequest& request, const SeriesLoop& options) : request_(request), options_(options) {
    for (const std::string& path : request.records) {
      LoadedSeries loaded = load_series(path, options.request);
      if (loaded.series.channels.size() != 1) {
        throw std::invalid_argument(fmt::format("{}: {} channels; of several --record each holds one logger's channel",
                                                path, loaded.series.channels.size()));
      }
      loaded.series.channels.front().name = std::filesystem::path(path).stem().string();
      loaded_.push_back(std::move(loaded.series));
      if (std::abs(loaded_.back().rate_hz / loaded_.front().rate_hz - 1.0) > 1e-3) {
        throw std::invalid_argument(fmt::format("{}: {:g} Hz, the first record {:g} Hz; the loggers need one rate",
                                                path, loaded_.back().rate_hz, loaded_.front().rate_hz));
      }
    }
  }

  void run() {
    core::closure::LoggerRecords records;
    records.rate_hz = loaded_.front().rate_hz;
    records.band_high_hz = options_.max_frequency_hz;
    for (const KnownMode& mode : read_reference_modes(request_.reference)) {
      const double below = kRigidShare * mode.frequency_hz;
      records.rigid_below_hz = records.rigid_below_hz > 0.0 ? std::min(records.rigid_below_hz, below) : below;
    }
    for (const app::ChannelSeries& series : loaded_) {
      records.name.push_back(series.channels.front().name);
      records.value.push_back(series.value.front());
    }
    const core::closure::LoggerModel model(records);
    std::vector<std::string> adopted;
    ClosureResult result = close_response(request_, model, request_.n_surrogates, &adopted);
    const auto reference = read_reference_modes(request_.reference);
    const std::vector<double> at_once(loaded_.size(), 0.0);
    const std::vector<bool> upright(loaded_.size(), false);
    result.modes_before = modes_of_series(joined(at_once, upright), options_.max_frequency_hz, reference);
    app::ChannelSeries after = joined(model.offsets_s(adopted), model.inverted(adopted));
    result.modes_after = modes_of_series(after, options_.max_frequency_hz, reference);
    exchange(after, reference, result);
    show_response(request_, result, "closure.json");
  }

 private:
  // Detects two exchanged labels: the exchange that fits the lowest reference mode best is tested on the other modes.
  void exchange(app::ChannelSeries& series, const std::vector<KnownMode>& reference, ClosureResult& result) const {
    if (reference.size() < 2) return;
    const auto errors = [&](const std::vector<core::closure::ClosureMode>& modes) {
      std::pair<double, double> out{1.0, 0.0};  // of the lowest mode; mean of the others
      double n = 0.0;
      for (const auto& mode : modes) {
        if (!mode.mac || !mode.reference_hz) continue;
        if (*mode.reference_hz == reference.front().frequency_hz) {
          out.first = 1.0 - *mode.mac;
        } else {
          out.second += 1.0 - *mode.mac, n += 1.0;
        }
      }
      out.second = n > 0.0 ? out.second / n : 1.0;
      return out;
    };
    const auto before = errors(result.modes_after);
    auto best = before;
    std::pair<std::size_t, std::size_t> which{0, 0};
    std::vector<core::closure::ClosureMode> best_modes;
    for (std::size_t a = 0; a < series.channels.size(); ++a) {
      for (std::size_t b = a + 1; b < series.channels.size(); ++b) {
        if (series.channels[a].is_base || series.channels[b].is_base) continue;
        app::ChannelSeries swapped = series;
        std::swap(swapped.channels[a].name, swapped.channels[b].name);
        auto modes = modes_of_series(swapped, options_.max_frequency_hz, reference);
        const auto now = errors(modes);
        if (now.first < best.first) best = now, which = {a, b}, best_modes = std::move(modes);
      }
    }
    if (which.first == which.second) return;
    const bool adopted = best.second < kMaterialExchange * before.second;
    request_.answer.note(
        "labels {} and {} exchanged: 1 - MAC of the lowest mode {:.4f} -> {:.4f}; of the other modes, which did not "
        "choose, {:.4f} -> {:.4f}: {}\n",
        series.channels[which.first].name, series.channels[which.second].name, before.first, best.first, before.second,
        best.second, adopted ? "adopted" : "not adopted");
    if (!adopted) return;
    core::closure::ClosureStep step;
    step.effect = "exchanged_labels";
    step.parameters = {{series.channels[which.first].name, "is " + series.channels[which.second].name, 1.0, {}}};
    step.heldout_before = 100.0 * before.second, step.heldout_after = 100.0 * best.second;
    result.steps.push_back(std::move(step));
    result.modes_after = std::move(best_modes);
  }

  // Resamples one series to the first record's samples: whole samples by shifting, the remainder as a delay per mode.
  [[nodiscard]] app::ChannelSeries joined(const std::vector<double>& offset_s,
                                          const std::vector<bool>& inverted) const {
    app::ChannelSeries out;
    out.rate_hz = loaded_.front().rate_hz;
    out.unit = loaded_.front().unit;
    const std::size_t n = loaded_.front().value.front().size();
    for (std::size_t i = 0; i < loaded_.size(); ++i) {
      const std::vector<double>& own = loaded_[i].value.front();
      const std::int64_t late = std::llround(offset_s[i] * out.rate_hz);
      std::vector<double> moved(n, std::numeric_limits<double>::quiet_NaN());
      for (std::size_t k = 0; k < own.size(); ++k) {
        const std::int64_t at = static_cast<std::int64_t>(k) + late;
        if (at >= 0 && at < static_cast<std::int64_t>(n))
          moved[static_cast<std::size_t>(at)] = inverted[i] ? -own[k] : own[k];
      }
      core::ChannelInfo channel = loaded_[i].channels.front();
      channel.region = static_cast<std::uint16_t>(i);
      channel.row_delay_s = offset_s[i] - static_cast<double>(late) / out.rate_hz;
      channel.is_base = channel.name == options_.input_record;
      out.channels.push_back(channel);
      out.value.push_back(std::move(moved));
    }
    return out;
  }

  const LoopRequest& request_;
  const SeriesLoop& options_;
  std::vector<app::ChannelSeries> loaded_;
};

}  // namespace

void close_loggers(const LoopRequest& request, const SeriesLoop& options) { LoggerCloser(request, options).run(); }

}  // namespace tools
