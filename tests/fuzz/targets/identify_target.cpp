#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "drivers/storage/json.h"
#include "tests/fuzz/memory_file.h"
#include "tests/fuzz/program.h"
#include "tools/hovermodal/commands.h"

namespace tests::fuzz {
namespace {

using Words = std::vector<std::string>;

// Each bit of the first three bytes adds one of them.
const std::array<Words, 24> kOptions{{{"--rate-hz", "64"},
                                      {"--quantity", "a"},
                                      {"--base", "1"},
                                      {"--input", "2"},
                                      {"--no-header"},
                                      {"--keep-all"},
                                      {"--differences", "2"},
                                      {"--max-frequency", "8"},
                                      {"--max-frequency", "90"},
                                      {"--segment", "16"},
                                      {"--segment", "64"},
                                      {"--block-rows", "3"},
                                      {"--block-rows", "8"},
                                      {"--channels", "1", "3"},
                                      {"--delays-ms", "0,3"},
                                      {"--reference", "b"},
                                      {"--merge", "--reference", "a"},
                                      {"--quantity", "d,v"},
                                      {"--title", "T <b>"},
                                      {"--note", "place: P"},
                                      {"--base", "floor"},
                                      {"--json"},
                                      {"--rate-hz", "6400"},
                                      {"--channels", "9"}}};

// `hovermodal identify` as a whole: options by three bytes, then a table (or UFF, MAT) of any content, twice with
// --merge.
void run(Bytes bytes) {
  const Silence silence;
  Input input(bytes);
  const std::uint32_t chosen =
      input.byte() | static_cast<std::uint32_t>(input.byte()) << 8U | static_cast<std::uint32_t>(input.byte()) << 16U;
  const MemoryFile file(input.rest());
  const Folder folder;
  Words arguments{"identify", "--quiet", "--series", file.path()};
  constexpr std::uint32_t kMerge = 1U << 16U;
  if ((chosen & kMerge) != 0) arguments.push_back(file.path());
  const std::string report = folder.path() + "/report";
  arguments.insert(arguments.end(), {"--report", report});
  for (std::size_t i = 0; i < kOptions.size(); ++i) {
    if ((chosen >> i & 1U) != 0) arguments.insert(arguments.end(), kOptions[i].begin(), kOptions[i].end());
  }
  if (!run_program(tools::add_identify, arguments).empty()) return;
  if ((chosen & kMerge) == 0) {
    require(std::filesystem::exists(report + "/report.html"), "a report has its page");
    require(drivers::read_json_file(report + "/modal.json").contains("modes"), "a result has its modes");
  }
}

const Registration kTarget("identify", &run);

}  // namespace
}  // namespace tests::fuzz
