#include "drivers/exchange/mcap_writer.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "drivers/exchange/mcap_file.h"
#include "drivers/storage/json_values.h"

namespace drivers {
namespace {

using Json = nlohmann::ordered_json;

Json number_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(); }

Json typed(const char* type) { return {{"type", type}}; }
Json list_of(Json item) { return {{"type", "array"}, {"items", std::move(item)}}; }
const Json kNumberOrNull = {{"type", {"number", "null"}}};

Json object_schema(const char* title, Json properties) {
  return {{"$schema", "https://json-schema.org/draft/2020-12/schema"},
          {"title", title},
          {"type", "object"},
          {"properties", std::move(properties)}};
}

const Json kStamp = {{"type", "object"},
                     {"properties", {{"sec", {{"type", "integer"}}}, {"nsec", {{"type", "integer"}}}}}};

class McapRun {
 public:
  McapRun(const ExchangeRun& run, const std::string& path) : run_(run), file_(path) {}

  void write() {
    const std::uint16_t modes = add("/modes", "hovermodal.Modes", modes_schema());
    if (run_.t_s.empty()) {
      file_.message(modes, 0, text(modes_message()));
      return file_.commit();
    }
    const std::uint16_t displacement = add("/displacement", "hovermodal.Displacement", displacement_schema());
    const std::uint16_t spectrum =
        add("/spectrum", "hovermodal.Spectrum", pairs_schema("hovermodal.Spectrum", "frequency_hz"));
    const std::uint16_t correlation =
        add("/correlation", "hovermodal.Correlation", pairs_schema("hovermodal.Correlation", "lag_s"));
    file_.message(modes, 0, text(modes_message()));
    if (!run_.spectra.empty()) file_.message(spectrum, 0, text(spectrum_message()));
    if (!run_.correlations.empty()) file_.message(correlation, 0, text(correlation_message()));
    for (std::size_t k = 0; k < run_.t_s.size(); ++k)
      file_.message(displacement, time_ns(k), text(displacement_message(k)));
    file_.commit();
  }

 private:
  [[nodiscard]] std::uint16_t add(const char* topic, const char* name, const Json& schema) {
    return file_.add_channel(topic, name, text(schema));
  }
  static std::string text(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

  [[nodiscard]] std::uint64_t time_ns(std::size_t k) const {
    const double t_s = run_.t_s[k] - run_.t_s.front();
    return t_s > 0.0 ? static_cast<std::uint64_t>(std::llround(1e9 * t_s)) : 0;
  }

  // Per channel a property of its name.
  [[nodiscard]] Json channels_schema() const {
    Json properties = Json::object();
    for (const ExchangeChannel& channel : run_.channels) properties[channel.name] = kNumberOrNull;
    return {{"type", "object"}, {"properties", std::move(properties)}};
  }

  [[nodiscard]] Json displacement_schema() const {
    return object_schema(
        "hovermodal.Displacement",
        {{"timestamp", kStamp}, {"t_s", typed("number")}, {"unit", typed("string")}, {"channel", channels_schema()}});
  }

  [[nodiscard]] Json displacement_message(std::size_t k) const {
    const std::uint64_t t_ns = time_ns(k);
    Json channel = Json::object();
    for (std::size_t c = 0; c < run_.value.size(); ++c)
      channel[run_.channels[c].name] = number_or_null(run_.value[c][k]);
    return {{"timestamp", {{"sec", t_ns / 1'000'000'000U}, {"nsec", t_ns % 1'000'000'000U}}},
            {"t_s", run_.t_s[k]},
            {"unit", run_.unit},
            {"channel", std::move(channel)}};
  }

  [[nodiscard]] static Json modes_schema() {
    const Json component = {
        {"type", "object"},
        {"properties",
         {{"channel", typed("string")}, {"re", kNumberOrNull}, {"im", kNumberOrNull}, {"sigma", kNumberOrNull}}}};
    const Json mode = {{"type", "object"},
                       {"properties",
                        {{"frequency_hz", typed("number")},
                         {"frequency_sigma_hz", kNumberOrNull},
                         {"damping", typed("number")},
                         {"damping_sigma", kNumberOrNull},
                         {"mpc", typed("number")},
                         {"verdict", typed("string")},
                         {"shape", list_of(component)}}}};
    const Json place = {{"type", "object"},
                        {"properties",
                         {{"channel", typed("string")},
                          {"region", typed("string")},
                          {"x", typed("number")},
                          {"y", typed("number")},
                          {"direction_x", typed("number")},
                          {"direction_y", typed("number")},
                          {"delay_s", typed("number")}}}};
    return object_schema(
        "hovermodal.Modes",
        {{"run", typed("string")}, {"unit", typed("string")}, {"mode", list_of(mode)}, {"place", list_of(place)}});
  }

  [[nodiscard]] Json modes_message() const {
    Json modes = Json::array(), places = Json::array();
    for (const ExchangeMode& mode : run_.modes) modes.push_back(mode_object(mode));
    for (const ExchangeChannel& channel : run_.channels) {
      const ExchangeNode& node = run_.nodes[channel.node];
      places.push_back({{"channel", channel.name},
                        {"region", node.name},
                        {"x", node.x},
                        {"y", node.y},
                        {"direction_x", channel.direction_x},
                        {"direction_y", channel.direction_y},
                        {"delay_s", channel.delay_s}});
    }
    return {{"run", run_.name}, {"unit", run_.unit}, {"mode", std::move(modes)}, {"place", std::move(places)}};
  }

  [[nodiscard]] Json mode_object(const ExchangeMode& mode) const {
    Json shape = Json::array();
    for (std::size_t c = 0; c < run_.channels.size() && c < mode.shape.size(); ++c) {
      const bool has_sigma = c < mode.shape_std.size();
      shape.push_back({{"channel", run_.channels[c].name},
                       {"re", number_or_null(mode.shape[c].real())},
                       {"im", number_or_null(mode.shape[c].imag())},
                       {"sigma", has_sigma ? number_or_null(mode.shape_std[c]) : Json()}});
    }
    return {{"frequency_hz", mode.frequency_hz},
            {"frequency_sigma_hz", or_null(mode.frequency_std_hz)},
            {"damping", mode.damping_ratio},
            {"damping_sigma", or_null(mode.damping_std)},
            {"mpc", mode.mpc},
            {"verdict", mode.verdict},
            {"shape", std::move(shape)}};
  }

  [[nodiscard]] static Json pairs_schema(const char* title, const char* abscissa) {
    const Json pair = {{"type", "object"},
                       {"properties",
                        {{"response", typed("string")},
                         {"reference", typed("string")},
                         {"re", list_of(typed("number"))},
                         {"im", list_of(typed("number"))}}}};
    return object_schema(title,
                         {{"unit", typed("string")}, {abscissa, list_of(typed("number"))}, {"pair", list_of(pair)}});
  }

  [[nodiscard]] Json pairs(const std::vector<ExchangePair>& all, bool complex) const {
    Json out = Json::array();
    for (const ExchangePair& pair : all) {
      Json re = Json::array(), im = Json::array();
      for (const std::complex<double>& value : pair.value) {
        re.push_back(number_or_null(value.real()));
        if (complex) im.push_back(number_or_null(value.imag()));
      }
      Json& one = out.emplace_back(Json{
          {"response", run_.channels[pair.i].name}, {"reference", run_.channels[pair.j].name}, {"re", std::move(re)}});
      if (complex) one["im"] = std::move(im);
    }
    return out;
  }

  [[nodiscard]] Json spectrum_message() const {
    Json frequency = Json::array();
    for (std::size_t k = 0; k < run_.spectra.front().value.size(); ++k)
      frequency.push_back(static_cast<double>(k) * run_.frequency_step_hz);
    return {{"unit", run_.unit + "^2/Hz"}, {"frequency_hz", std::move(frequency)}, {"pair", pairs(run_.spectra, true)}};
  }

  [[nodiscard]] Json correlation_message() const {
    Json lag = Json::array();
    for (int k = -run_.most_lag; k <= run_.most_lag; ++k) lag.push_back(k / run_.rate_hz);
    return {{"unit", run_.unit + "^2"}, {"lag_s", std::move(lag)}, {"pair", pairs(run_.correlations, false)}};
  }

  const ExchangeRun& run_;
  McapFile file_;
};

}  // namespace

void write_mcap(const ExchangeRun& run, const std::string& path) { McapRun(run, path).write(); }

}  // namespace drivers
