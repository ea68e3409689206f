// Ring and triple buffer carry N items far wider than a machine word from one thread to another, every word checked,
// while other threads keep the CPUs busy. One line each; exit code 1 when an item was torn, lost or out of order.
//   ring_transfers N [LOAD_THREADS]
#include <atomic>
#include <chrono>
#include <cinttypes>
#include <cstdio>
#include <cstdlib>
#include <thread>
#include <vector>

#include "rt/clock.h"
#include "rt/spsc_ring.h"
#include "rt/triple_buffer.h"
#include "tests/stress/payload.h"

namespace {

using namespace std::chrono_literals;
using stress::Payload;

class Load {
 public:
  explicit Load(int n_threads) {
    for (int i = 0; i < n_threads; ++i) {
      threads_.emplace_back([this] {
        std::uint64_t x = 1;
        while (!stop_.load(std::memory_order_relaxed)) {
          for (int k = 0; k < 10'000; ++k) x = x * 6364136223846793005U + 1U;
          sink_.store(x, std::memory_order_relaxed);
        }
      });
    }
  }
  ~Load() {
    stop_.store(true, std::memory_order_relaxed);
    for (std::thread& thread : threads_) thread.join();
  }
  Load(const Load&) = delete;
  Load& operator=(const Load&) = delete;

 private:
  std::atomic<bool> stop_{false};
  std::atomic<std::uint64_t> sink_{0};
  std::vector<std::thread> threads_;
};

struct Result {
  std::uint64_t n_written = 0, n_read = 0, n_bad = 0;
  bool ok = false;
};

void tell(const char* what, const Result& result, std::int64_t begin_ns) {
  std::printf("%s\t%" PRIu64 "\twritten\t%" PRIu64 "\tread\t%" PRIu64 "\tbad\t%.1f\ts\n", what, result.n_written,
              result.n_read, result.n_bad, static_cast<double>(rt::monotonic_ns() - begin_ns) * 1e-9);
  std::fflush(stdout);
}

void write_ring(rt::SpscRing<Payload>& ring, rt::Wakeup& wakeup, std::uint64_t n) {
  rt::RingWriter<Payload> writer = ring.writer();
  for (std::uint64_t i = 0; i < n;) {
    const rt::Wakeup::Ticket ticket = wakeup.ticket();
    if (Payload* slot = writer.try_claim()) {
      slot->fill(i++);
      writer.publish();
    } else {
      wakeup.wait(ticket, 1h);
    }
  }
  writer.close();
}

// Lossless: both ends wait for each other, so that every item must arrive, once, whole, in order.
Result run_ring(std::uint64_t n) {
  rt::SpscRing<Payload> ring(8, Payload{});
  rt::Wakeup reader_wakeup, writer_wakeup;
  ring.set_reader_wakeup(&reader_wakeup);
  ring.set_writer_wakeup(&writer_wakeup);
  std::thread producer([&] { write_ring(ring, writer_wakeup, n); });
  rt::RingReader<Payload> reader = ring.reader();
  Result result{n};
  for (;;) {
    const rt::Wakeup::Ticket ticket = reader_wakeup.ticket();
    if (const Payload* item = reader.front()) {
      result.n_bad += item->whole() && item->number() == result.n_read ? 0U : 1U;
      ++result.n_read;
      reader.pop();
    } else if (reader.finished()) {
      break;
    } else {
      reader_wakeup.wait(ticket, 1h);
    }
  }
  producer.join();
  result.ok = result.n_bad == 0 && result.n_read == n;
  return result;
}

void write_triple_buffer(rt::TripleBuffer<Payload>& buffer, rt::Wakeup& wakeup, std::uint64_t n) {
  constexpr std::uint64_t kMeetEvery = 16;
  for (std::uint64_t i = 1; i <= n;) {
    const rt::Wakeup::Ticket ticket = wakeup.ticket();
    if (i % kMeetEvery == 0 && !buffer.taken()) {
      wakeup.wait(ticket, 1h);
      continue;
    }
    buffer.back().fill(i++);
    buffer.publish();
  }
  buffer.close();
}

// The newest wins: received values must be complete and newer than the last, and the last one written must arrive. At
// intervals the writer waits for the reader: on busy CPUs the two would otherwise rarely overlap.
Result run_triple_buffer(std::uint64_t n) {
  rt::TripleBuffer<Payload> buffer{Payload{}};
  rt::Wakeup reader_wakeup, writer_wakeup;
  buffer.set_reader_wakeup(&reader_wakeup);
  buffer.set_writer_wakeup(&writer_wakeup);
  std::thread writer([&] { write_triple_buffer(buffer, writer_wakeup, n); });
  Result result{n};
  std::uint64_t last = 0;
  while (!buffer.finished()) {
    const rt::Wakeup::Ticket ticket = reader_wakeup.ticket();
    if (!buffer.refresh()) {
      if (!buffer.finished()) reader_wakeup.wait(ticket, 1h);
      continue;
    }
    result.n_bad += buffer.front().whole() && buffer.front().number() > last ? 0U : 1U;
    last = buffer.front().number();
    ++result.n_read;
  }
  writer.join();
  result.ok = result.n_bad == 0 && last == n;
  return result;
}

}  // namespace

int main(int argc, char** argv) {
  const std::uint64_t n = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 0;
  if (n == 0) {
    std::fprintf(stderr, "usage: ring_transfers N [LOAD_THREADS]\n");
    return 2;
  }
  const Load load(argc > 2 ? std::atoi(argv[2]) : 0);
  std::int64_t begin_ns = rt::monotonic_ns();
  const Result ring = run_ring(n);
  tell("ring", ring, begin_ns);
  begin_ns = rt::monotonic_ns();
  const Result triple_buffer = run_triple_buffer(n);
  tell("triple_buffer", triple_buffer, begin_ns);
  return ring.ok && triple_buffer.ok ? 0 : 1;
}
