#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>

#include "core/spectrum/decimator.h"
#include "core/spectrum/welch_cpsd.h"
#include "firmware_app/config/core_config.h"
#include "firmware_app/replay/analysis.h"
#include "firmware_app/replay/full_field.h"
#include "firmware_app/replay/oversampling.h"
#include "firmware_app/replay/series_channels.h"
#include "firmware_app/replay/series_faults.h"
#include "firmware_app/report/earlier_files.h"
#include "firmware_app/report/modal_json.h"
#include "firmware_app/report/pictures/pictures.h"
#include "firmware_app/report/run_findings.h"
#include "firmware_app/report/run_history.h"

namespace app {

namespace {

constexpr std::size_t kSamplesPerReport = 1 << 17;
// In time constants 1 / (zeta w) of the free decay: a shorter segment biases the damping (core/spectrum/METHOD.md).
constexpr double kLeastSegmentDecays = 1.5;

core::WelchConfig series_config(const ChannelSeries& series, const SpectrumConfig& spectrum) {
  core::WelchConfig config = welch_config(spectrum, series.channels.size(), series.rate_hz);
  config.gate_outliers = false;  // already done by mask_faults(), before the decimation
  return config;
}

// on_sample(t, values) after each of them.
template <class OnSample>
void feed(const ChannelSeries& series, core::WelchCpsd& cpsd, const OnSample& on_sample) {
  const std::size_t n_channels = series.channels.size(), n_samples = series.value.front().size();
  std::vector<double> value(n_channels);
  std::vector<std::uint8_t> seen(n_channels);
  for (std::size_t t = 0; t < n_samples; ++t) {
    for (std::size_t c = 0; c < n_channels; ++c) {
      value[c] = series.value[c][t];
      seen[c] = std::isfinite(value[c]) ? 1 : 0;
    }
    (void)cpsd.push(value, seen);
    on_sample(t, value);
  }
  cpsd.flush();
}

struct SeriesSpectra {
  core::CpsdSums sums;
  RunHistory history;
};

SeriesSpectra spectra_of(const ChannelSeries& series, const SpectrumConfig& spectrum,
                         const std::function<void(double)>& progress) {
  const std::size_t n_samples = series.value.front().size();
  core::WelchCpsd cpsd(series_config(series, spectrum));
  RunHistory history(series.rate_hz, series.channels.size(), 0);
  feed(series, cpsd, [&](std::size_t t, const std::vector<double>& value) {
    history.add(t, value);
    if (progress && (t + 1) % kSamplesPerReport == 0)
      progress(static_cast<double>(t + 1) / static_cast<double>(n_samples));
  });
  return {cpsd.sums(), std::move(history)};
}

// Sums of one group of channels after the other, in the same memory where a group has as many as the one before it.
class GroupSpectra {
 public:
  explicit GroupSpectra(const SpectrumConfig& spectrum) : spectrum_(spectrum) {}

  const core::CpsdSums& of(const ChannelSeries& group) {
    if (cpsd_ && cpsd_->sums().n_channels == static_cast<int>(group.channels.size())) {
      cpsd_->restart(group.rate_hz);
    } else {
      cpsd_.emplace(series_config(group, spectrum_));
    }
    feed(group, *cpsd_, [](std::size_t, const std::vector<double>&) {});
    return cpsd_->sums();
  }

 private:
  const SpectrumConfig& spectrum_;
  std::optional<core::WelchCpsd> cpsd_;
};

void draw(const ChannelSeries& series, const SeriesSpectra& spectra, const core::ModalEstimate& estimate,
          const SeriesOptions& options) {
  RunFacts facts;
  facts.source = options.source;
  facts.method = to_text(Method::kHovermodal);
  facts.counted = false;
  facts.title = options.head.title, facts.notes = options.head.notes;
  PictureInputs inputs;
  inputs.channels = series.channels;
  inputs.spectrum = &spectra.sums;
  inputs.estimate = &estimate;
  inputs.history = &spectra.history;
  inputs.unit = series.unit;
  inputs.max_frequency_hz = options.identifier.max_frequency_hz;
  inputs.facts = &facts;
  compare_with(inputs, options.head.compare);
  keep_earlier_report(options.report_directory);
  (void)write_pictures(options.report_directory, inputs);
}

void require_samples(const ChannelSeries& series, int segment) {
  const std::size_t n_samples = series.value.front().size();
  if (n_samples >= static_cast<std::size_t>(segment)) return;
  throw std::invalid_argument(
      fmt::format("{} samples{} are fewer than one segment of {}: at least {:.4g} s at {:g} Hz, or a shorter segment",
                  n_samples, series.rate_hz > 0.0 ? fmt::format(" ({:g} a second)", series.rate_hz) : "", segment,
                  segment / series.rate_hz, series.rate_hz));
}

double wanted_segment_s(const core::Mode& mode) {
  return kLeastSegmentDecays / (std::max(mode.damping_ratio, 1e-9) * 2.0 * std::numbers::pi * mode.frequency_hz);
}

// For an automatic segment: is it far too short for the lowest mode, and would twice its length still fit?
bool should_double(const SeriesResult& result, std::size_t n_samples) {
  constexpr double kMostOfTheRecord = 0.7;
  if (result.estimate.modes.empty()) return false;
  const double segment_s = result.segment / result.estimate.rate_hz;
  return 2.0 * segment_s < wanted_segment_s(result.estimate.modes.front()) &&
         2.0 * result.segment < kMostOfTheRecord * static_cast<double>(n_samples);
}

void remark_on_segment(SeriesResult& result) {
  const double segment_s = result.segment / result.estimate.rate_hz;
  for (const core::Mode& mode : result.estimate.modes) {
    const double wanted_s = wanted_segment_s(mode);
    if (segment_s >= wanted_s || mode.damping_ratio <= 0.0) continue;
    result.remarks.push_back(fmt::format(
        "the segment of {:.3g} s is shorter than 1.5 decay times of {:.4g} Hz ({:.3g} s): its damping may read high",
        segment_s, mode.frequency_hz, wanted_s));
    return;
  }
}

int base_channel(const std::vector<core::ChannelInfo>& channels) {
  const auto base = std::find_if(channels.begin(), channels.end(), [](const auto& c) { return c.is_base; });
  return base == channels.end() ? -1 : static_cast<int>(base - channels.begin());
}

void require_even_columns(const ChannelSeries& series) {
  if (series.channels.empty() || series.value.size() != series.channels.size())
    throw std::invalid_argument("a record without channels");
  for (const auto& values : series.value) {
    if (values.size() != series.value.front().size()) throw std::invalid_argument("channels of different lengths");
  }
  if (!(series.rate_hz > 0.0) || !std::isfinite(series.rate_hz))
    throw std::invalid_argument(fmt::format("a rate of {} Hz", series.rate_hz));
}

// Matched by name, because some channels are excluded.
void count_outliers(const ChannelSeries& given, const std::vector<std::uint64_t>& n_outlying, SeriesResult& result) {
  for (std::size_t c = 0; c < result.channels.size() && c < result.estimate.channels.size(); ++c) {
    for (std::size_t g = 0; g < n_outlying.size(); ++g) {
      if (given.channels[g].name == result.channels[c].name) result.estimate.channels[c].n_outlying = n_outlying[g];
    }
  }
}

std::vector<double> identify_delays(const core::IdentifierConfig& identifier, const ChannelSeries& series) {
  return core::Identifier(identifier, series.channels).undone_delay_s();
}

std::string remark_on_core(const ChannelSeries& core, std::size_t n_channels, bool is_drawn) {
  std::string names;
  for (const core::ChannelInfo& channel : core.channels) names += (names.empty() ? "" : ", ") + channel.name;
  return fmt::format(
      "modes identified from {} of {} channels ({}); the shapes of the others follow from their correlations with "
      "these{}",
      core.channels.size(), n_channels, names, is_drawn ? ", and the pictures show these" : "");
}

}  // namespace

SeriesResult identify_series(const ChannelSeries& given, const SeriesOptions& options) {
  require_even_columns(given);
  require_searchable(options.identifier.max_frequency_hz, given.rate_hz);
  ChannelSeries series = given;
  SeriesResult result;
  std::optional<ChannelSeries> series_of_core;
  core::IdentifierConfig identifier = options.identifier;
  std::vector<std::uint64_t> n_outlying;
  if (options.mask_faults) n_outlying = mask_faults(series, result.remarks);
  leave_out_unusable(series, identifier.references, result.remarks);
  if (options.decimate) {
    result.decimation = identifier.max_frequency_hz > 0.0
                            ? decimate_to(series, identifier.max_frequency_hz, result.remarks)
                            : decimate_to_motion(series, result.remarks);
  }
  if (result.decimation > 1) identifier.edge_hz = core::Decimator::kPassband * series.rate_hz;
  identifier.least_power = 0.0;  // channels without motion are already excluded, whatever the unit

  SpectrumConfig spectrum = options.spectrum;
  const std::size_t n_samples = series.value.front().size();
  const bool choose_segment = spectrum.segment <= 0;
  if (choose_segment) spectrum.segment = automatic_segment(n_samples);
  result.segment = spectrum.segment;
  require_samples(series, spectrum.segment);
  const bool is_field = series.channels.size() > kMostTogether;
  FieldCore core;
  if (is_field) core = choose_core(series, identifier.references), identifier.references = core.references;
  const ChannelSeries& together = is_field ? series_of_core.emplace(channels_of(series, core.channels)) : series;
  const core::Identifier identify(identifier, together.channels);
  core::FieldShapes field;
  const auto identified = [&](const core::CpsdSums& sums) {
    return is_field ? identify.identify(sums, field) : identify.identify(sums);
  };
  SeriesSpectra spectra = spectra_of(together, spectrum, options.progress);
  result.estimate = identified(spectra.sums);
  while (choose_segment && should_double(result, n_samples)) {
    result.segment = spectrum.segment *= 2;
    spectra = spectra_of(together, spectrum, options.progress);
    result.estimate = identified(spectra.sums);
  }
  if (choose_segment) {
    result.remarks.push_back(
        fmt::format("segment of {} samples ({:.4g} s)", spectrum.segment, spectrum.segment / series.rate_hz));
  }
  result.estimate.final = true;
  if (!options.report_directory.empty()) draw(together, spectra, result.estimate, options);
  if (is_field) {
    GroupSpectra groups(spectrum);
    const auto sums_of = [&](const ChannelSeries& group) -> const core::CpsdSums& { return groups.of(group); };
    add_field(series, core, field, identify_delays(identifier, series), sums_of, result.estimate);
    result.remarks.push_back(remark_on_core(together, series.channels.size(), !options.report_directory.empty()));
  }
  result.channels = series.channels;
  count_outliers(given, n_outlying, result);
  if (series.channels.size() == 1) {
    result.remarks.emplace_back(
        "one channel has no shape: a mode cannot be distinguished from a spectral line of the input");
  }
  remark_on_segment(result);
  if (options.identifier.max_frequency_hz == 0.0) {
    if (std::string remark = remark_on_oversampling(spectra.sums, together.channels); !remark.empty())
      result.remarks.push_back(std::move(remark));
  }
  const int base = base_channel(together.channels);
  const double top_hz = identifier.edge_hz > 0.0 ? identifier.edge_hz : series.rate_hz / 2.0;
  if (base >= 0) result.response = core::response_peaks(spectra.sums, base, top_hz);
  return result;
}

}  // namespace app
