#pragma once

namespace CLI {
class App;
}

namespace tools {

// Each function adds one subcommand to `app`, in the file of its name. The callback throws on failure:
// std::invalid_argument for usage (exit 2), std::runtime_error for a fault (exit 1). `main` alone catches.
void add_calibrate(CLI::App& app);
void add_simulate(CLI::App& app);
void add_plan(CLI::App& app);
void add_identify(CLI::App& app);
void add_closeloop(CLI::App& app);
void add_replay(CLI::App& app);
void add_report(CLI::App& app);  // in replay.cpp
void add_batch(CLI::App& app);
void add_batch_flight(CLI::App& app);  // in batch/flight.cpp: a process of a batch, not for users
void add_compare(CLI::App& app);
void add_spy(CLI::App& app);
void add_inspect(CLI::App& app);  // in spy.cpp: another view of the same messages
void add_inspect_cameras(CLI::App& inspect);
void add_inspect_lcm(CLI::App& inspect);
void add_regions(CLI::App& app);
void add_readout(CLI::App& app);
void add_ground(CLI::App& app);

}  // namespace tools
