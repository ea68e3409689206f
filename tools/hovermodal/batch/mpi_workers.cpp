#include "tools/hovermodal/batch/mpi_workers.h"

#include <cstdlib>
#include <stdexcept>

#ifdef HOVERMODAL_WITH_MPI
#include <mpi.h>

#include <algorithm>
#include <chrono>
#include <climits>
#include <exception>
#include <filesystem>
#include <list>
#include <map>
#include <thread>
#include <utility>

#include "drivers/storage/json.h"
#include "drivers/storage/text_file.h"

namespace tools {

namespace {

namespace fs = std::filesystem;

constexpr int kOrder = 1, kEnd = 2;  // tags
constexpr std::size_t kMostBytes = INT_MAX / 2;
constexpr auto kPause = std::chrono::milliseconds(10);  // waiting inside MPI would occupy a processor that flights need

// Texts one after the other, each preceded by its length.
std::string packed(const std::vector<std::string>& texts) {
  std::string bytes;
  for (const std::string& text : texts) bytes += std::to_string(text.size()) + ":" + text;
  return bytes;
}

std::vector<std::string> unpacked(const std::string& bytes) {
  std::vector<std::string> texts;
  for (std::size_t at = 0; at < bytes.size();) {
    const std::size_t colon = bytes.find(':', at);
    const std::size_t size = std::stoull(bytes.substr(at, colon - at));
    texts.push_back(bytes.substr(colon + 1, size));
    at = colon + 1 + size;
  }
  return texts;
}

void send(int rank, int tag, const std::string& bytes) {
  MPI_Send(bytes.data(), static_cast<int>(bytes.size()), MPI_CHAR, rank, tag, MPI_COMM_WORLD);
}

struct Letter {
  int rank = 0;
  std::string bytes;
};

// The next message with that tag, if one has arrived.
std::optional<Letter> received(int rank, int tag) {
  int has_come = 0, n_bytes = 0;
  MPI_Status status;
  MPI_Iprobe(rank, tag, MPI_COMM_WORLD, &has_come, &status);
  if (has_come == 0) return std::nullopt;
  MPI_Get_count(&status, MPI_CHAR, &n_bytes);
  Letter letter{status.MPI_SOURCE, std::string(static_cast<std::size_t>(n_bytes), '\0')};
  MPI_Recv(letter.bytes.data(), n_bytes, MPI_CHAR, letter.rank, tag, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
  return letter;
}

// number, failure, modal.json, sums
std::string packed_end(const FlightEnd& end, const std::string& into) {
  std::vector<std::string> texts{std::to_string(end.number), end.failure, "", ""};
  if (end.failure.empty()) {
    try {
      texts[2] = drivers::read_text_file((fs::path(into) / kModesFile).string(), kMostBytes);
      texts[3] = drivers::read_text_file((fs::path(into) / kSumsFile).string(), kMostBytes);
      if (texts[2].size() + texts[3].size() > kMostBytes) throw std::runtime_error("its sums are too large to be sent");
    } catch (const std::exception& e) {
      texts[1] = e.what(), texts[2].clear(), texts[3].clear();
    }
  }
  return packed(texts);
}

std::string packed_order(std::size_t number, const FlightOrder& order) {
  std::vector<std::string> texts{std::to_string(number), order.into, to_string(order.flight.kind), order.flight.path,
                                 order.flight.config};
  texts.insert(texts.end(), order.overrides.begin(), order.overrides.end());
  return packed(texts);
}

FlightOrder order_of(const std::vector<std::string>& texts) {
  FlightOrder order;
  order.into = texts.at(1);
  order.flight = {"", flight_kind(texts.at(2)), texts.at(3), texts.at(4)};
  order.overrides.assign(texts.begin() + 5, texts.end());
  return order;
}

class MpiWorkers final : public Workers {
 public:
  MpiWorkers(int n_ranks, int jobs) : n_busy_(static_cast<std::size_t>(n_ranks), 0) { n_busy_[0] = jobs; }
  // Waits for ranks still at work, whose messages otherwise would have no receiver.
  ~MpiWorkers() override {
    for (int rank = 1; rank < static_cast<int>(n_busy_.size()); ++rank) send_later(rank, "");
    while (std::any_of(n_busy_.begin() + 1, n_busy_.end(), [](int n) { return n > 0; })) {
      if (!MpiWorkers::poll()) std::this_thread::sleep_for(kPause);
    }
    for (Sending& one : sending_) MPI_Wait(&one.request, MPI_STATUS_IGNORE);
  }

  [[nodiscard]] bool has_room() const override { return free_rank() > 0; }

  void start(std::size_t number, const FlightOrder& order) override {
    const int rank = free_rank();
    ++n_busy_[static_cast<std::size_t>(rank)];
    if (into_.size() <= number) into_.resize(number + 1);
    into_[number] = order.into;
    send_later(rank, packed_order(number, order));
  }

  [[nodiscard]] std::optional<FlightEnd> poll() override {
    const auto letter = received(MPI_ANY_SOURCE, kEnd);
    if (!letter) return std::nullopt;
    --n_busy_[static_cast<std::size_t>(letter->rank)];
    const std::vector<std::string> texts = unpacked(letter->bytes);
    FlightEnd end{std::stoull(texts.at(0)), texts.at(1)};
    try {
      if (end.failure.empty()) keep(into_.at(end.number), texts.at(2), texts.at(3));
    } catch (const std::exception& e) {
      end.failure = e.what();
    }
    return end;
  }

 private:
  struct Sending {
    MPI_Request request;
    std::string bytes;
  };

  // Never waits, because the rank may be sending to this one at the same time.
  void send_later(int rank, std::string bytes) {
    std::erase_if(sending_, [](Sending& one) {
      int is_done = 0;
      MPI_Test(&one.request, &is_done, MPI_STATUS_IGNORE);
      return is_done != 0;
    });
    Sending& one = sending_.emplace_back(Sending{{}, std::move(bytes)});
    MPI_Isend(one.bytes.data(), static_cast<int>(one.bytes.size()), MPI_CHAR, rank, kOrder, MPI_COMM_WORLD,
              &one.request);
  }

  // The least busy rank; 0: none has room.
  [[nodiscard]] int free_rank() const {
    int best = 0;
    for (int rank = 1; rank < static_cast<int>(n_busy_.size()); ++rank) {
      if (n_busy_[static_cast<std::size_t>(rank)] < n_busy_[static_cast<std::size_t>(best)]) best = rank;
    }
    return best;
  }

  // Where machines share no disk, this stores the flight's results here, too, except its pictures.
  static void keep(const fs::path& into, const std::string& modes, const std::string& sums) {
    fs::create_directories(into);
    drivers::write_file_atomically((into / kModesFile).string(), modes);
    drivers::write_file_atomically((into / kSumsFile).string(), sums);
  }

  std::vector<int> n_busy_;  // per rank; rank 0 counts as full
  std::list<Sending> sending_;
  std::vector<std::string> into_;
};

}  // namespace

MpiSession::MpiSession() {
  MPI_Init(nullptr, nullptr);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
  MPI_Comm_size(MPI_COMM_WORLD, &n_ranks_);
}

MpiSession::~MpiSession() { MPI_Finalize(); }

std::unique_ptr<Workers> MpiSession::others(int jobs) { return std::make_unique<MpiWorkers>(n_ranks_, jobs); }

void MpiSession::serve(LocalWorkers& workers) {
  std::map<std::size_t, std::string> into;  // of those at work
  bool is_wanted = true;
  while (is_wanted || !into.empty()) {
    const auto letter = is_wanted ? received(0, kOrder) : std::nullopt;
    if (letter && letter->bytes.empty()) is_wanted = false;
    if (letter && !letter->bytes.empty()) {
      const std::vector<std::string> texts = unpacked(letter->bytes);
      const std::size_t number = std::stoull(texts.at(0));
      const FlightOrder order = order_of(texts);
      into[number] = order.into;
      workers.start(number, order);
    }
    const auto end = workers.poll();
    if (end) {
      send(0, kEnd, packed_end(*end, into[end->number]));
      into.erase(end->number);
    }
    if (!letter && !end) std::this_thread::sleep_for(kPause);
  }
}

}  // namespace tools

#else

namespace tools {

MpiSession::MpiSession() {
  throw std::invalid_argument(
      "--mpi: this build has no MPI; tools/setup.sh --mpi, cmake --preset mpi, cmake --build build/mpi makes one");
}
MpiSession::~MpiSession() = default;
std::unique_ptr<Workers> MpiSession::others(int) { return nullptr; }
void MpiSession::serve(LocalWorkers&) {}

}  // namespace tools

#endif

namespace tools {

bool is_one_of_several() {
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"}) {
    const char* size = std::getenv(name);
    if (size != nullptr && std::atoi(size) > 1) return true;
  }
  return false;
}

}  // namespace tools
