// The simulator checked against what it does not use itself: first-order theory, statistics, other people's trackers.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "tools/hovermodal/commands.h"
#include "tools/hovermodal/selftest_peaks.h"
#include "tools/hovermodal/selftest_signatures.h"

namespace tools {
namespace {

void print_signatures() {
  fmt::print("# effect: tracks with it minus tracks without it, rms; what the first-order signature leaves of it\n");
  for (const SignatureCheck& check : check_signatures()) {
    fmt::print("signature\t{}\t{:.4f} px\t{:.5f} %\n", check.effect, check.rms_px, 1e2 * check.relative_error);
  }
}

void print_peaks() {
  const PeakCheck check = check_peaks(20, 600.0);
  const auto print = [](const char* what, const ModePeak& mode, double value, double scatter,
                        const PeakErrors& errors) {
    fmt::print("peak\t{:.3f} Hz\t{}\t{:.5f}\t{:.5f}\t{:+.2f}\t{:.2f}\t{:+.2f}\n", mode.frequency_hz, what, value,
               scatter, errors.mean, errors.rms, errors.worst);
  };
  fmt::print("# {} seeds of {:.0f} s; errors in units of the theoretical scatter: mean, rms, worst\n", check.n_seeds,
             check.duration_s);
  fmt::print("# bars: |mean| <= {:.2f}, rms {:.2f} ... {:.2f}\n", check.most_mean, check.least_rms, check.most_rms);
  for (const ModePeak& mode : check.modes) {
    print("frequency_hz", mode, mode.frequency_hz, mode.frequency_scatter_hz, mode.frequency);
    print("damping_ratio", mode, mode.damping_ratio, mode.damping_scatter, mode.damping);
  }
  fmt::print("peaks\t{}\n", check.passed() ? "within the bars" : "OUTSIDE the bars");
}

}  // namespace

void add_selftest(CLI::App& app) {
  CLI::App* command = app.add_subcommand("selftest", "Check the simulator's truth against independent theory");
  const auto what = std::make_shared<std::string>();
  command
      ->add_option("what", *what,
                   "signatures: every effect's motion of the tracks against its linear signature; "
                   "peaks: the true motion's frequencies and damping against those declared")
      ->required()
      ->check(CLI::IsMember({"signatures", "peaks"}));
  command->callback([what] { *what == "peaks" ? print_peaks() : print_signatures(); });
}

}  // namespace tools
