#include <filesystem>
#include <fstream>
#include <iterator>

#include "drivers/exchange/mat_writer.h"
#include "drivers/exchange/uff_writer.h"
#include "tests/fuzz/make_corpus.h"

namespace tests::fuzz {
namespace {

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

void write_exchange() {
  drivers::ExchangeRun run;
  run.name = "run";
  run.nodes = {{"a", 1.0, 2.0}};
  run.channels = {{"a", 0, 1.0, 0.0, 0.01}};
  run.rate_hz = 25.0;
  run.t_s = {0.0, 0.04, 0.08};
  run.value = {{1.5, -2.0, 3.25}};
  const std::filesystem::path path = std::filesystem::temp_directory_path() / "hovermodal_make_corpus";
  drivers::write_uff(run, path.string());
  const std::string even = bytes_of(path);
  keep("series", "universal", "u" + even);
  run.t_s[2] = 0.09;
  drivers::write_uff(run, path.string());
  keep("series", "universal_uneven", "u" + bytes_of(path));
  drivers::write_mat(run, path.string());
  keep("series", "mat", "m" + bytes_of(path));
  std::filesystem::remove(path);
}

}  // namespace tests::fuzz
