#include "firmware_app/config/config.h"
#include "firmware_app/config/config_yaml.h"
#include "tests/fuzz/fuzz_target.h"

namespace tests::fuzz {
namespace {

// The YAML; after each zero byte one override in the form of --set.
void run(Bytes bytes) {
  std::string text = text_of(bytes);
  std::vector<std::string> overrides;
  for (std::size_t zero = text.find('\0'); zero != text.npos && overrides.size() < 8; zero = text.find('\0')) {
    std::string rest = text.substr(zero + 1);
    overrides.push_back(rest.substr(0, rest.find('\0')));
    text = text.substr(0, zero) + rest.substr(std::min(rest.size(), overrides.back().size()));
  }
  app::AppConfig config;
  try {
    config = app::parse_config(text, "fuzz", overrides);
  } catch (const app::ConfigError& error) {
    require(*error.what() != '\0', "a refusal says why");
    return;
  }
  require(!config.regions.empty(), "a configuration has regions");
  for (const core::Region& region : config.regions)
    require(region.width_px >= 1.0 && region.height_px >= 1.0, "a region has an area");
  require(config.camera.rate_hz == 0.0 || (config.camera.rate_hz >= 1e-3 && config.camera.rate_hz <= 1e6),
          "the rate is in its range");
  // The form kept in a record must be read back to the same (no catch: a refusal would be a violation).
  const std::string kept = app::config_yaml(config);
  const app::AppConfig again = app::parse_config(kept, "kept");
  require(app::config_yaml(again) == kept, "written and read, it is the same");
  require(again.hash == config.hash, "written and read, its hash is the same");
}

const Registration kTarget("config", &run);

}  // namespace
}  // namespace tests::fuzz
