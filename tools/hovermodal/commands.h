#pragma once

#include <exception>

#include "drivers/host/command_line.h"

namespace tools {

// Each function adds one subcommand to `app`, in the file of its name. The callback throws on failure:
// std::invalid_argument for usage (exit 2), std::runtime_error for a fault (exit 1), ChangeFound after a complete
// answer that is an alarm (exit 3, without a message). `main` alone catches.
class ChangeFound : public std::exception {};

void add_calibrate(drivers::Command& app);
void add_simulate(drivers::Command& app);
void add_plan(drivers::Command& app);
void add_identify(drivers::Command& app);
void add_closeloop(drivers::Command& app);
void add_replay(drivers::Command& app);
void add_report(drivers::Command& app);  // in replay.cpp
void add_batch(drivers::Command& app);
void add_batch_flight(drivers::Command& app);  // in batch/flight.cpp: a process of a batch, not for users
void add_changes(drivers::Command& app);
void add_compare(drivers::Command& app);
void add_export(drivers::Command& app);
void add_magnify(drivers::Command& app);
void add_spy(drivers::Command& app);
void add_inspect(drivers::Command& app);  // in spy.cpp: another view of the same messages
void add_inspect_cameras(drivers::Command& inspect);
void add_inspect_lcm(drivers::Command& inspect);
void add_regions(drivers::Command& app);
void add_readout(drivers::Command& app);
void add_ground(drivers::Command& app);
void add_mavlink(drivers::Command& app);

}  // namespace tools
