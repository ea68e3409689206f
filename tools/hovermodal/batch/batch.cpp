// hovermodal batch: processes a folder of flights in several processes, and combines their results.
#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <thread>
#include <utility>

#include "drivers/host/command_line.h"
#include "drivers/storage/json.h"
#include "drivers/storage/printable.h"
#include "firmware_app/report/earlier_files.h"
#include "tools/hovermodal/answer.h"
#include "tools/hovermodal/batch/combine.h"
#include "tools/hovermodal/batch/dispatch.h"
#include "tools/hovermodal/batch/mpi_workers.h"
#include "tools/hovermodal/commands.h"

namespace tools {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostShown = 500;

struct Options {
  std::string folder, out, config;
  std::vector<std::string> overrides;
  int jobs = 0;  // 0 = one for each processor; under MPI one for each rank
  bool mpi = false;
  Answer answer;
};

std::string absolute(const std::string& path) {
  if (path.empty()) return "";
  const fs::path whole = fs::absolute(path).lexically_normal();
  return (whole.has_filename() ? whole : whole.parent_path()).string();  // "flights/" is "flights"
}

// Not the path of the file, because the program may be rebuilt while a batch is running.
std::string this_program() { return "/proc/self/exe"; }

int jobs_of(const Options& options) {
  if (options.jobs > 0) return options.jobs;
  return options.mpi ? 1 : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
}

// batch.json, batch.txt, batch.svg, and the report of each view of several flights.
void write_result(const BatchResult& result, const fs::path& out) {
  app::keep_earlier(out.string(), "batch", {"batch.json", "batch.txt", "batch.svg"});
  drivers::write_file_atomically((out / "batch.json").string(), batch_json(result));
  drivers::write_file_atomically((out / "batch.txt").string(), batch_text(result));
  if (const std::string svg = batch_svg(result); !svg.empty())
    drivers::write_file_atomically((out / "batch.svg").string(), svg);
  fs::remove_all(out / "views");
  for (std::size_t v = 0; v < result.views.size(); ++v) {
    if (result.views[v].flights.size() < 2) continue;
    const fs::path folder = out / "views" / std::to_string(v + 1);
    fs::create_directories(folder);
    drivers::write_file_atomically((folder / kModesFile).string(), app::modal_json(result.views[v].report));
  }
}

// Removes the folder from the names of files, so that the result does not depend on where the folder lies.
std::string without_folder(std::string text, const std::string& folder) {
  const std::string start = folder + "/";
  for (std::size_t at = text.find(start); at != std::string::npos; at = text.find(start, at))
    text.erase(at, start.size());
  return text;
}

void combine(const std::vector<FlightOrder>& orders, std::vector<std::string> failures, const Options& options) {
  const std::string& out = options.out;
  for (std::string& failure : failures) failure = without_folder(std::move(failure), options.folder);
  const BatchResult result = combine_flights(orders, failures);
  for (const FlightOrder& order : orders) fs::remove(fs::path(order.into) / kSumsFile);
  write_result(result, out);
  options.answer.document(batch_json(result));
  options.answer.text("{}results: {}\n", batch_text(result), out);
  std::size_t n_failed = 0;
  for (const FlightResult& flight : result.flights) n_failed += flight.failure.empty() ? 0U : 1U;
  if (n_failed > 0) {
    throw std::runtime_error(
        fmt::format("{} of {} flights failed, named in batch.txt; the result is that of the others", n_failed,
                    result.flights.size()));
  }
}

struct Worked {
  std::vector<FlightOrder> orders;
  std::vector<std::string> failures;
};

// `workers`: in addition to those of this machine.
Worked work(const Options& options, std::vector<std::unique_ptr<Workers>> workers) {
  const Inventory found = find_flights(options.folder, options.out, options.config);
  for (const std::string& line : found.left_out) {
    if (!options.answer.quiet) fmt::print(stderr, "left out: {}\n", drivers::printable(line, kMostShown));
  }
  if (found.flights.empty())
    throw std::invalid_argument(options.folder + ": no flight in it; hovermodal batch --help explains what one is");
  Worked worked{orders_of(found, options.overrides, options.out), {}};
  workers.push_back(std::make_unique<LocalWorkers>(this_program(), jobs_of(options)));
  worked.failures = work_on_all(worked.orders, workers, options.answer.quiet);
  return worked;
}

// The result at rank 0; empty at the other ranks, which have nothing more to do.
std::optional<Worked> work_with_others(const Options& options) {
  MpiSession session;
  if (session.rank() > 0) {
    LocalWorkers workers(this_program(), jobs_of(options));
    session.serve(workers);
    return std::nullopt;
  }
  std::vector<std::unique_ptr<Workers>> others;
  if (session.n_ranks() > 1) others.push_back(session.others(jobs_of(options)));
  return work(options, std::move(others));
}

void batch(Options options) {
  options.folder = absolute(options.folder);
  options.out = absolute(options.out);
  options.config = absolute(options.config);
  if (!options.mpi && is_one_of_several())
    throw std::invalid_argument("batch: several were started together, and each would do everything: give --mpi");
  const std::optional<Worked> worked = options.mpi ? work_with_others(options) : work(options, {});
  if (worked) combine(worked->orders, worked->failures, options);
}

}  // namespace

void add_batch(drivers::Command& app) {
  auto options = std::make_shared<Options>();
  drivers::Command command = app.subcommand(
      "batch",
      "Process a folder of flights, several at a time, and combine their results\n"
      "  hovermodal batch flights --out together\n"
      "  mpirun -n 16 hovermodal batch flights --out together --mpi     (a build with WITH_MPI; or Slurm's srun)\n"
      "A flight is, at any depth below the folder,\n"
      "  NAME_runNNNN_000.lcm   a record of the service (record.directory), with the files that follow it;\n"
      "  tracks.csv             with config.yaml beside it, as `simulate --tracks-only` leaves them;\n"
      "  NAME.mp4               or .mkv, .avi, .mov, .m4v: a clip, with NAME.yaml or config.yaml beside it.\n"
      "Each is worked on by a process of its own, as `replay` does: one that fails is named, and the rest goes on.\n"
      "It leaves flights/NAME (report and log of each), batch.json, batch.txt and batch.svg (all together).\n"
      "Flights of one view (same regions, rate, scale and spectra) are added up, spectra before modes, and identified\n"
      "together (views/N/modal.json); different views are combined by inverse variance, modes matched by frequency "
      "and\n"
      "shape. The result is the same to the last bit for any number of processes and machines.");
  command.option("folder", options->folder, "Folder with the flights").required().type_name("FOLDER");
  command.option("--out", options->out, "Folder for the results").required().type_name("DIR");
  command
      .option("--jobs", options->jobs,
              "Flights at a time; default: one for each processor, with --mpi one for each rank")
      .range(1, 1024);
  command.option("--config", options->config, "Configuration of tracks and clips that have none beside them")
      .type_name("FILE");
  command.option("--set", options->overrides, "Override one key for all flights")
      .type_name("section.key=value")
      .repeated();
  command.flag("--mpi", options->mpi, "Share the flights with all processes that mpirun or srun has started");
  add_answer_options(command, options->answer, "batch.json");
  command.on_run([options] { batch(*options); });
}

}  // namespace tools
