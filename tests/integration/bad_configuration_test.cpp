#include "tests/support/bad_input.h"

namespace {

using namespace tests::bad_input;

Input with_regions(const fs::path& folder, const std::string& regions) {
  Input input = good(folder);
  input.regions = regions;
  return input;
}

Input with_rest(const fs::path& folder, const std::string& rest) {
  Input input = good(folder);
  input.rest = rest + "\n";
  return input;
}

Input with_arguments(const fs::path& folder, const std::vector<std::string>& arguments) {
  Input input = good(folder);
  input.arguments = arguments;
  return input;
}

Input not_writable(const fs::path& folder) {
  Input input = good(folder);
  fs::create_directories(folder / "locked");
  fs::permissions(folder / "locked", fs::perms::owner_read | fs::perms::owner_exec);
  input.arguments = {"--report", (folder / "locked").string()};
  input.before = without_file_rights();
  return input;
}

Input disk_full(const fs::path& folder, int n_bytes, int n_frames) {
  Input input = clip(folder, n_frames);
  input.before = {"/usr/bin/prlimit", "--fsize=" + std::to_string(n_bytes)};
  return input;
}

const std::vector<BadInput>& configuration_rows() {
  static const std::vector<BadInput> rows{
      {"NoRegions", [](const fs::path& f) { return with_regions(f, "[]"); }, 2, {"regions", "1 or more"}},
      {"RegionOutsideTheImage",
       [](const fs::path& f) { return with_regions(f, "[{name: roof, rect: [100, 20, 80, 50]}]"); },
       2,
       {"roof", "128 x 96", "x = 180"}},
      {"RegionFarOutsideTheImage",
       [](const fs::path& f) { return with_regions(f, "[{name: roof, rect: [5000, 20, 80, 50]}]"); },
       2,
       {"roof", "128 x 96"}},
      {"RegionTooSmallForCorners",
       [](const fs::path& f) { return with_regions(f, "[{name: roof, rect: [20, 20, 1, 1]}]"); },
       2,
       {"roof", "corners", "enlarge"}},
      {"TwoRegionsOfOneName",
       [](const fs::path& f) {
         return with_regions(f, "[{name: roof, rect: [20, 20, 40, 50]}, {name: roof, rect: [60, 20, 40, 50]}]");
       },
       2,
       {"roof", "already used", "rename"}},
      {"RegionOfNaN",
       [](const fs::path& f) { return with_regions(f, "[{name: roof, rect: [.nan, 20, 80, 50]}]"); },
       2,
       {"regions.0.rect", "nan"}},
      {"ScaleEndsOnOnePixel",
       [](const fs::path& f) { return with_rest(f, "scale: {known_length_mm: 100, from: [20, 30], to: [20, 30]}"); },
       2,
       {"scale.to", "two different ends"}},
      {"KnownLengthZero",
       [](const fs::path& f) { return with_rest(f, "scale: {known_length_mm: 0, from: [20, 30], to: [20, 60]}"); },
       2,
       {"scale.known_length_mm", "0 is refused"}},
      {"ScaleOutsideTheImage",
       [](const fs::path& f) { return with_rest(f, "scale: {known_length_mm: 9, from: [20, 30], to: [20, 600]}"); },
       2,
       {"scale.to", "128 x 96"}},
      {"UnknownKey",
       [](const fs::path& f) { return with_rest(f, "spectrumm: {segment: 32}"); },
       2,
       {"config.yaml:", "spectrumm"}},
      {"DuplicateKey",
       [](const fs::path& f) { return with_rest(f, "method: paper\nmethod: paper"); },
       2,
       {"config.yaml:", "method"}},
  };
  return rows;
}

const std::vector<BadInput>& output_rows() {
  static const std::vector<BadInput> rows{
      {"LcmUrlThatIsNone",
       [](const fs::path& f) {
         return with_arguments(f, {"--set", "telemetry.lcm_url=carrier-pigeon"});
       },
       2,
       {"carrier-pigeon", "udpm://"}},
      {"LcmUrlWithoutMulticast",
       [](const fs::path& f) {
         return with_arguments(f, {"--set", "telemetry.lcm_url=udpm://10.0.0.1:7667"});
       },
       2,
       {"10.0.0.1", "multicast"}},
      {"LcmLogInNoFolder",
       [](const fs::path& f) {
         return with_arguments(f, {"--set", "telemetry.log_file=" + (f / "none" / "run.lcm").string()});
       },
       1,
       {"run.lcm", "telemetry.log_file"}},
      {"OutputFolderIsAFile",
       [](const fs::path& f) {
         test_support::write_text(f / "taken", "x");
         return with_arguments(f, {"--report", (f / "taken").string()});
       },
       1,
       {"taken", "is a file", "another folder"}},
      {"OutputFolderBelowAFile",
       [](const fs::path& f) {
         test_support::write_text(f / "taken", "x");
         return with_arguments(f, {"--report", (f / "taken" / "out").string()});
       },
       1,
       {"taken", "may be written"}},
      {"OutputFolderNotWritable", not_writable, 1, {"report.directory", "locked", "Permission denied"}},
      // Telemetry is not essential to the run: without it the run continues and reports this.
      {"DiskFullUnderTheLcmLog",
       [](const fs::path& f) {
         return with_arguments(f, {"--set", "telemetry.log_file=/dev/full"});
       },
       0,
       {"40 frames in = 40 processed", "messages failed", "telemetry.log_file"}},
      {"DiskFullDuringTheReport",
       [](const fs::path& f) { return disk_full(f, 20000, 400); },
       1,
       {"tracks.csv", "too large", "came after the fault", "Free space", "400 frames in = 400 processed"}},
#ifndef __SANITIZE_THREAD__  // which writes a file of its own
      {"DiskFullFromTheFirstByte",
       [](const fs::path& f) { return disk_full(f, 0, 40); },
       1,
       {"modal.json", "tracks.csv", "displacements.csv", "Free space"}},
#endif
  };
  return rows;
}

class BadConfiguration : public ::testing::TestWithParam<BadInput> {};

TEST_P(BadConfiguration, EndsWithItsExitCodeAndSaysWhatToDo) { expect_as_told(GetParam()); }

INSTANTIATE_TEST_SUITE_P(Keys, BadConfiguration, ::testing::ValuesIn(configuration_rows()), name_of);
INSTANTIATE_TEST_SUITE_P(Output, BadConfiguration, ::testing::ValuesIn(output_rows()), name_of);

}  // namespace
