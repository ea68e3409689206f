#include "tools/hovermodal/ground/snapshot_json.h"

#include <algorithm>
#include <cmath>

#include "tools/hovermodal/ground/json_parts.h"

namespace tools {
namespace {

using drivers::StreamMonitor;

// Positions of the newest items; messages sent before the run began are left out.
Shown newest(const LiveView& view) {
  const StreamMonitor& m = view.monitor;
  const auto of_run = [&](std::int64_t utc_ns) { return utc_ns >= view.run_since_utc_ns; };
  Shown out;
  out.run = view.run;
  out.n_samples = m.n_samples();
  if (m.health() && of_run(m.health()->utc_ns)) out.health = m.health()->sequence;
  if (m.estimate() && of_run(m.estimate()->utc_ns) && m.parts_heard() >= m.estimate()->n_parts) {
    out.estimate_utc_ns = m.estimate()->utc_ns;
  }
  if (m.preview() && of_run(m.preview()->utc_ns)) out.preview = m.preview()->sequence;
  if (m.closure() && of_run(m.closure()->utc_ns)) out.closure_utc_ns = m.closure()->utc_ns;
  if (m.structure() && of_run(m.structure()->utc_ns)) out.structure_utc_ns = m.structure()->utc_ns;
  for (const auto& spectrum : m.spectra()) {
    if (spectrum && of_run(spectrum->utc_ns)) out.spectrum_utc_ns = std::max(out.spectrum_utc_ns, spectrum->utc_ns);
  }
  return out;
}

}  // namespace

bool has_news(const LiveView& view, const Shown& shown) {
  const Shown now = newest(view);
  return now.run != shown.run || now.health != shown.health || now.estimate_utc_ns != shown.estimate_utc_ns ||
         now.preview != shown.preview || now.closure_utc_ns != shown.closure_utc_ns ||
         now.structure_utc_ns != shown.structure_utc_ns || now.spectrum_utc_ns != shown.spectrum_utc_ns ||
         now.n_samples != shown.n_samples;
}

std::string snapshot_json(const LiveView& view, Shown& shown) {
  const Shown now = newest(view);
  if (now.run != shown.run) shown = Shown{.run = now.run, .n_samples = shown.n_samples};
  const StreamMonitor& monitor = view.monitor;
  nlohmann::json out;
  out["link"] = link_json(view);
  if (now.health >= 0 && now.health != shown.health) out["health"] = health_json(monitor);
  if (now.estimate_utc_ns >= 0 && now.estimate_utc_ns != shown.estimate_utc_ns) out["modes"] = modes_json(monitor);
  if (now.spectrum_utc_ns >= 0 && now.spectrum_utc_ns != shown.spectrum_utc_ns) out["spectra"] = spectra_json(monitor);
  if (now.preview >= 0 && now.preview != shown.preview) out["preview"] = preview_json(monitor);
  if (now.closure_utc_ns >= 0 && now.closure_utc_ns != shown.closure_utc_ns)
    out["closure"] = closure_json(*monitor.closure());
  if (now.structure_utc_ns >= 0 && now.structure_utc_ns != shown.structure_utc_ns)
    out["structure"] = closure_json(*monitor.structure());
  if (now.n_samples != shown.n_samples) {
    out["traces"] = traces_json(monitor, shown.n_samples < now.n_samples ? shown.n_samples : 0);  // fewer: another stream
  }
  shown = now;
  // Strings come from the network: invalid UTF-8 is replaced.
  return out.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

nlohmann::json rounded(double value, int digits) {
  if (!std::isfinite(value)) return nullptr;
  if (value == 0.0) return 0;
  // Beyond 1e300 the power of ten overflows; such a number is useless on a page.
  const double exponent = std::floor(std::log10(std::fabs(value))) - (digits - 1);
  if (std::fabs(exponent) > 300.0) return nullptr;
  // Divided by a whole power of ten where possible: the result is then the double that prints shortest.
  const double unit = std::pow(10.0, std::fabs(exponent));
  return exponent < 0.0 ? std::round(value * unit) / unit : std::round(value / unit) * unit;
}

nlohmann::json closure_json(const hovermodal::closure_report_t& c) {
  nlohmann::json out{{"number", c.number},
                     {"refused", c.refused},
                     {"unit", c.unit},
                     {"level", c.level},
                     {"left", c.left},
                     {"stop", c.stop_reason},
                     {"changes", c.changes},
                     {"in_force", c.in_force},
                     {"duration_s", rounded(c.duration_s)},
                     {"frames", {c.first_frame, c.last_frame}}};
  out["before"] = rounded(c.residual_before), out["after"] = rounded(c.residual_after);
  out["floor"] = rounded(c.noise_floor), out["unexplained"] = rounded(c.unexplained, 3);
  out["steps"] = nlohmann::json::array();
  for (const auto& s : c.steps) {
    out["steps"].push_back({{"effect", s.effect},
                            {"latent", s.is_latent != 0},
                            {"before", rounded(s.heldout_before)},
                            {"after", rounded(s.heldout_after)},
                            {"numbers", s.numbers},
                            {"meaning", s.meaning}});
  }
  return out;
}

}  // namespace tools
