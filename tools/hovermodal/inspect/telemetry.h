#pragma once

namespace CLI {
class App;
}

namespace tools {

// Adds `telemetry` to `inspect`; as in commands.h.
void add_inspect_telemetry(CLI::App& inspect);

}  // namespace tools
