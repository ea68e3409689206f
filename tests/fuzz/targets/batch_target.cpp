#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>

#include "tests/fuzz/program.h"
#include "tools/hovermodal/batch/combine.h"
#include "tools/hovermodal/batch/dispatch.h"
#include "tools/hovermodal/commands.h"

namespace tests::fuzz {
namespace {

namespace fs = std::filesystem;

// A flight in this process, where `hovermodal batch` starts another one.
class HereAtOnce final : public tools::Workers {
 public:
  [[nodiscard]] bool has_room() const override { return !ended_; }
  void start(std::size_t number, const tools::FlightOrder& order) override {
    fs::create_directories(order.into);
    ended_ = tools::FlightEnd{number, run_program(tools::add_batch_flight, tools::arguments_of(order))};
  }
  [[nodiscard]] std::optional<tools::FlightEnd> poll() override { return std::exchange(ended_, std::nullopt); }

 private:
  std::optional<tools::FlightEnd> ended_;
};

// Pieces, each a letter and its bytes behind their length: t tracks.csv, c config.yaml, r record, d the next folder.
void write_flights(Bytes bytes, const fs::path& root) {
  constexpr int kMostFlights = 6;
  Input input(bytes);
  int n = 1;
  for (fs::path folder = root / "1"; !input.empty() && n <= kMostFlights;) {
    const char kind = static_cast<char>(input.byte());
    const Bytes content = input.piece();
    fs::create_directories(folder);
    const char* name = kind == 't'   ? "tracks.csv"
                       : kind == 'c' ? "config.yaml"
                       : kind == 'r' ? "x_run0001_000.lcm"
                                     : "";
    if (*name != '\0') {
      std::ofstream(folder / name, std::ios::binary)
          .write(reinterpret_cast<const char*>(content.data()), static_cast<std::streamsize>(content.size()));
    } else {
      folder = root / std::to_string(++n);
    }
  }
}

// `hovermodal batch` as a whole, but for the processes: a folder of flights of any content, each flight, all together.
void run(Bytes bytes) {
  const Silence silence;
  const Folder folder;
  const std::string flights = folder.path() + "/flights", out = folder.path() + "/out";
  fs::create_directories(flights);
  write_flights(bytes, flights);
  const tools::Inventory found = tools::find_flights(flights, out, "");
  // What memory and time grow with.
  const std::vector<std::string> small = {"spectrum.segment=32", "identification.block_rows=4", "camera.driver=file",
                                          "camera.source=none"};
  const std::vector<tools::FlightOrder> orders = tools::orders_of(found, small, out);
  std::vector<std::unique_ptr<tools::Workers>> workers;
  workers.push_back(std::make_unique<HereAtOnce>());
  const std::vector<std::string> failures = tools::work_on_all(orders, workers, true);
  const tools::BatchResult result = tools::combine_flights(orders, failures);
  require(nlohmann::json::accept(tools::batch_json(result)), "batch.json is JSON");
  require(!tools::batch_text(result).empty(), "a batch has its text");
  (void)tools::batch_svg(result);
}

const Registration kTarget("batch", &run);

}  // namespace
}  // namespace tests::fuzz
