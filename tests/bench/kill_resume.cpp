// Kills a run of the spectrum and checkpoint stages at random moments (SIGKILL), resumes it from its state file each
// time, and compares the final sums with those of a run that was never interrupted and lacks the same samples.
//   kill_resume FOLDER [KILLS [SEED]]
// Prints: kills, states refused, largest loss as a share of the period, resumes, and whether the sums are equal bit by
// bit. Exit code 1 unless half of the runs were resumed, no state was refused, no loss exceeds the period, and the sums
// are equal.
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cinttypes>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <random>
#include <thread>

#include "core/spectrum/welch_cpsd.h"
#include "drivers/storage/checkpoint_file.h"
#include "firmware_app/service/stages/checkpoint_stage.h"
#include "firmware_app/service/stages/spectrum_stage.h"
#include "rt/clock.h"
#include "rt/stage_runner.h"

namespace {

constexpr double kRate_hz = 10'000.0, kPeriod_s = 0.5;
constexpr std::size_t kMostKills = 2000, kSnapshots = 32;  // after 1, 2, 4 ... hops, and at the end
constexpr int kChannels = 3;

core::WelchConfig config() {
  core::WelchConfig welch;
  welch.n_channels = kChannels;
  welch.segment = 1024;
  welch.rate_hz = kRate_hz;
  welch.bridge_losses = true;
  return welch;
}

struct Gap {
  std::uint64_t first_lost = 0, next_seen = 0;
};

// Shared with the children; outlives them. The stream continues whatever happens to a process.
struct Stream {
  std::atomic<std::uint64_t> next_cell{0};
  std::atomic<std::uint64_t> end_cell{UINT64_MAX};
  std::atomic<std::uint64_t> n_down{0};      // cells that passed before the present child, while none was running
  std::atomic<std::uint64_t> first_cell{0};  // of the sums
  std::atomic<std::uint64_t> worst_loss{0};  // cells that a killed run had taken
  std::atomic<std::uint32_t> n_resumed{0}, n_refused{0}, n_gaps{0};
  std::array<Gap, kMostKills + 1> gaps{};
};

void sample_at(std::uint64_t cell, core::DisplacementSample& out) {
  out.sequence = cell;
  out.t_start_ns = 1'000'000'000 + static_cast<std::int64_t>(cell) * 100'000;
  for (std::size_t c = 0; c < kChannels; ++c) {
    std::uint64_t x = (cell * kChannels + c + 1) * 0x9E3779B97F4A7C15U;  // splitmix64
    x = (x ^ (x >> 30U)) * 0xBF58476D1CE4E5B9U;
    x = (x ^ (x >> 27U)) * 0x94D049BB133111EBU;
    x ^= x >> 31U;
    out.value_mm[c] = static_cast<double>(x >> 11U) * 0x1p-53 - 0.5;
    out.seen[c] = x % 50 == 0 ? 0 : 1;
  }
}

core::DisplacementSample empty_sample() {
  core::DisplacementSample sample;
  sample.value_mm.assign(kChannels, 0.0);
  sample.sigma_mm = sample.value_mm;
  sample.seen.assign(kChannels, 0);
  sample.n_points.assign(kChannels, 0);
  return sample;
}

app::RunState view() {
  app::RunState state;
  state.config_hash = 1;
  state.rate_hz = kRate_hz;
  state.scale_mm_per_px = 1.0;
  state.channels.resize(kChannels);
  state.boot_id = drivers::boot_id();
  return state;
}

std::vector<double> numbers_of(const core::CpsdSums& sums) {
  std::vector<double> out{static_cast<double>(sums.n_segments), static_cast<double>(sums.n_samples),
                          static_cast<double>(sums.n_missing), sums.weight.sum, sums.weight.squares};
  for (const auto* list : {&sums.data_sum, &sums.mask_sum}) {
    for (const std::complex<double>& z : *list) out.push_back(z.real()), out.push_back(z.imag());
  }
  return out;
}

void raise(std::atomic<std::uint64_t>& worst, std::uint64_t value) {
  if (worst.load() < value) worst = value;
}

// Resumes from the previous child's state, if there is one, and counts the loss.
void resume(Stream& stream, const std::string& path, app::SpectrumAccumulator& spectra) {
  const drivers::CheckpointRead read = drivers::read_checkpoint(path);
  bool taken = false;
  if (read.exists && read.refused.empty()) {
    const app::RunState saved = app::run_state_of(read.bytes);
    taken = app::why_foreign(saved, view()).empty() && spectra.resume(saved.spectrum, true);
  }
  stream.n_resumed += taken ? 1U : 0U;
  stream.n_refused += read.exists && !taken ? 1U : 0U;
  const std::uint64_t first_lost = stream.first_cell.load() + (taken ? spectra.sums().n_samples : 0);
  const std::uint64_t next_cell = stream.next_cell.load();
  const std::uint64_t n_fed = next_cell - stream.n_down.load();
  if (n_fed > first_lost) raise(stream.worst_loss, n_fed - first_lost);
  if (taken) {
    stream.gaps[stream.n_gaps++] = {first_lost, next_cell};
  } else {
    stream.first_cell = next_cell;
  }
}

// The child: feeds samples at the pace of the stream until it is killed or the stream ends.
int run(Stream& stream, const std::string& folder) {
  const std::string path = folder + "/hovermodal.state";
  rt::SpscRing<core::DisplacementSample> samples(256, empty_sample());
  rt::SpscRing<app::SpectrumSnapshot> snapshots(kSnapshots,
                                                app::SpectrumSnapshot{core::WelchCpsd::empty_sums(config())});
  app::SpectrumAccumulator spectra(config(), 1'000'000);
  rt::TripleBuffer<app::StateBytes> states{app::StateBytes{std::vector<std::uint8_t>(spectra.state_bytes()), 0}};
  app::SpectrumStage spectrum({samples.reader(), snapshots.writer(), &states}, spectra, false);
  rt::TripleBuffer<app::StateBytes> modes{app::StateBytes{}};
  app::CheckpointStage checkpoint(states, modes, view(), path);
  samples.set_reader_wakeup(&spectrum.wakeup());
  states.set_reader_wakeup(&checkpoint.wakeup());
  spectra.keep_state(kPeriod_s);
  resume(stream, path, spectra);
  rt::StageRunner run_checkpoint(checkpoint, {"checkpoint"});
  rt::StageRunner run_spectrum(spectrum, {"spectrum"});
  run_checkpoint.start();
  run_spectrum.start();

  auto writer = samples.writer();
  const std::int64_t begin_ns = rt::monotonic_ns();
  for (std::uint64_t n_fed = 0; stream.next_cell.load() < stream.end_cell.load();) {
    if (static_cast<double>(rt::monotonic_ns() - begin_ns) * 1e-9 * kRate_hz < static_cast<double>(n_fed)) {
      std::this_thread::sleep_for(std::chrono::microseconds(500));
      continue;
    }
    core::DisplacementSample* slot = writer.try_claim();
    if (slot == nullptr) continue;
    sample_at(stream.next_cell.load(), *slot);
    writer.publish();
    ++stream.next_cell, ++n_fed;
  }
  writer.close();
  run_spectrum.join();
  run_checkpoint.join();
  auto reader = snapshots.reader();
  for (std::size_t n_before = snapshots.depth(); n_before > 1; --n_before) reader.pop();
  const app::SpectrumSnapshot* last = reader.front();
  if (last == nullptr) return 3;
  const std::vector<double> numbers = numbers_of(last->sums);
  std::FILE* out = std::fopen((folder + "/sums.bin").c_str(), "wb");
  if (out == nullptr) return 3;
  const bool written = std::fwrite(numbers.data(), sizeof(double), numbers.size(), out) == numbers.size();
  return std::fclose(out) == 0 && written ? 0 : 3;
}

// The gaps in the final sums: if two runs resumed from one state, only that of the later run.
std::vector<Gap> lasting_gaps(const Stream& stream) {
  std::vector<Gap> gaps;
  for (std::uint32_t g = 0; g < stream.n_gaps.load(); ++g) {
    while (!gaps.empty() && gaps.back().first_lost >= stream.gaps[g].first_lost) gaps.pop_back();
    gaps.push_back(stream.gaps[g]);
  }
  return gaps;
}

// The same samples without any interruption, those of the gaps missing.
std::vector<double> uninterrupted(const Stream& stream) {
  core::WelchCpsd welch(config());
  core::DisplacementSample sample = empty_sample();
  std::uint64_t cell = stream.first_cell.load();
  const auto push_until = [&](std::uint64_t end) {
    for (; cell < end; ++cell) {
      sample_at(cell, sample);
      (void)welch.push(sample.value_mm, sample.seen);
    }
  };
  for (const Gap& gap : lasting_gaps(stream)) {
    push_until(gap.first_lost);
    // As in the stage when frames are missing: beyond two transforms further masked cells have no effect.
    const std::uint64_t most = 2 * static_cast<std::uint64_t>(welch.sums().n_fft);
    for (std::uint64_t n = std::min(gap.next_seen - gap.first_lost, most); n > 0; --n) (void)welch.push_missing();
    cell = gap.next_seen;
  }
  push_until(stream.end_cell.load());
  welch.flush();
  return numbers_of(welch.sums());
}

std::vector<double> read_numbers(const std::string& path) {
  std::vector<double> numbers(std::filesystem::exists(path) ? std::filesystem::file_size(path) / sizeof(double) : 0);
  if (std::FILE* in = std::fopen(path.c_str(), "rb")) {
    numbers.resize(std::fread(numbers.data(), sizeof(double), numbers.size(), in));
    std::fclose(in);
  }
  return numbers;
}

bool run_and_kill(Stream& stream, const std::string& folder, std::uint32_t n_kills, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  for (std::uint32_t kill_number = 0; kill_number <= n_kills; ++kill_number) {
    const bool last = kill_number == n_kills;
    if (last) stream.end_cell = stream.next_cell.load() + 5000;
    const pid_t child = fork();
    if (child == 0) _exit(run(stream, folder));
    if (!last) {
      // In stream time, not wall-clock time, so that the child gets that far on a busy machine, too.
      const std::uint64_t until = stream.next_cell.load() + 200 + random() % 12'000;
      while (stream.next_cell.load() < until) std::this_thread::sleep_for(std::chrono::microseconds(200));
      kill(child, SIGKILL);
    }
    int status = 0;
    waitpid(child, &status, 0);
    if (last) return WIFEXITED(status) && WEXITSTATUS(status) == 0;
    stream.n_down = random() % 300;
    stream.next_cell += stream.n_down.load();
  }
  return false;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: kill_resume FOLDER [KILLS [SEED]]\n");
    return 2;
  }
  const std::string folder = argv[1];
  const auto n_kills = static_cast<std::uint32_t>(
      std::min<std::size_t>(argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 200, kMostKills));
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  void* memory = mmap(nullptr, sizeof(Stream), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) return 3;
  auto& stream = *new (memory) Stream;
  const bool ended = run_and_kill(stream, folder, n_kills, argc > 3 ? std::strtoull(argv[3], nullptr, 10) : 1);
  const double share = static_cast<double>(stream.worst_loss.load()) / (kPeriod_s * kRate_hz);
  const std::vector<double> sums = read_numbers(folder + "/sums.bin"), expected = uninterrupted(stream);
  const bool equal = ended && sums.size() == expected.size() &&
                     std::memcmp(sums.data(), expected.data(), sums.size() * sizeof(double)) == 0;
  std::printf("%u kills\t%u resumed\t%u refused\t%.2f of the period lost at most\t%s\n", n_kills,
              stream.n_resumed.load(), stream.n_refused.load(), share, equal ? "equal" : "DIFFERENT");
  const bool went_on = 2 * stream.n_resumed.load() >= n_kills;  // otherwise the test shows nothing
  return equal && went_on && stream.n_refused.load() == 0 && share <= 1.0 ? 0 : 1;
}
