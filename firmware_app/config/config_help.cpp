#include <fmt/format.h>

#include <string_view>

#include "drivers/storage/text_wrap.h"
#include "firmware_app/config/config_table.h"

namespace app {
namespace {

constexpr std::string_view kHead = R"(CONFIGURATION (YAML)

A small complete example:

    method: hovermodal
    camera:
      driver: file
      source: flight.mp4          # relative to the folder the service is started in
      rate_hz: 25
      readout_ms: 30
    regions:
      - {name: base, rect: [860, 980, 200, 60], role: base}
      - {name: floor1, rect: [860, 700, 200, 60]}
      - {name: roof, rect: [860, 420, 200, 60], axis: u}
    scale: {known_length_mm: 300, from: [860, 440], to: [1060, 440]}
    spectrum: {segment: 512}
    telemetry: {lcm_url: ""}

Any key may be overridden: --set camera.rate_hz=29.97 --set regions.0.axis=v
Unknown or repeated keys, wrong types and values out of range are refused.

EVERY KEY
)";

}  // namespace

std::string config_help() {
  AppConfig defaults;
  defaults.regions.resize(1);
  std::string out(kHead);
  std::string section;
  for (const ConfigKey& key : config_keys()) {
    const std::string its_section = key.path.substr(0, key.path.find_first_of(".["));
    if (its_section != section) out += '\n';
    section = its_section;
    const std::string value = key.default_text.empty() ? key.canonical(defaults, 0) : key.default_text;
    const std::string type = key.unit.empty() ? key.type : fmt::format("{}, {}", key.type, key.unit);
    out += fmt::format("{:<32} {}\n", key.path, type);
    drivers::append_wrapped(out, key.meaning, 4);
    drivers::append_wrapped(out, fmt::format("default: {}   allowed: {}", value, key.allowed), 4);
  }
  return out;
}

}  // namespace app
