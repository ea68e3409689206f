// The simulator checked against what it does not use itself: first-order theory, statistics, other people's trackers.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "tools/hovermodal/commands.h"
#include "tools/hovermodal/selftest_signatures.h"

namespace tools {
namespace {

void print_signatures() {
  fmt::print("# effect: tracks with it minus tracks without it, rms; what the first-order signature leaves of it\n");
  for (const SignatureCheck& check : check_signatures()) {
    fmt::print("signature\t{}\t{:.4f} px\t{:.5f} %\n", check.effect, check.rms_px, 1e2 * check.relative_error);
  }
}

}  // namespace

void add_selftest(CLI::App& app) {
  CLI::App* command = app.add_subcommand("selftest", "Check the simulator's truth against independent theory");
  const auto what = std::make_shared<std::string>();
  command->add_option("what", *what, "signatures: every effect's motion of the tracks against its linear signature")
      ->required()
      ->check(CLI::IsMember({"signatures"}));
  command->callback([what] { print_signatures(); });
}

}  // namespace tools
