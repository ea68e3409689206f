// The ring compared with boost::lockfree::spsc_queue in one program: items of one word, and frames. Both ends spin,
// both have equal capacity, and the two are run alternately. "burst": one thread fills and empties, measured in CPU
// time, which other load hardly changes: the instructions alone. Each line: what, nanoseconds per item of the ring and
// of Boost, and the ratio of the two times of one round: medians over all rounds.
//   ring_speed [ROUNDS [ITEMS [FRAMES]]]
#include <algorithm>
#include <boost/lockfree/spsc_queue.hpp>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <functional>
#include <memory>
#include <thread>
#include <vector>

#include "rt/clock.h"
#include "rt/spsc_ring.h"

namespace {

constexpr std::size_t kSlots = 1024, kFrameSlots = 8, kFrameBytes = 1280 * 720;

struct Frame {
  std::uint64_t number = 0;
  unsigned char pixels[kFrameBytes]{};
};

// Simulates a camera: writes every pixel of the slot.
void expose(Frame& frame, std::uint64_t number) noexcept {
  frame.number = number;
  std::memset(frame.pixels, static_cast<int>(number & 0xFFU), sizeof frame.pixels);
}
// Simulates a tracker: reads the frame in place.
std::uint64_t look(const Frame& frame) noexcept { return frame.number + frame.pixels[frame.number % kFrameBytes]; }

volatile std::uint64_t sink = 0;

double time_ns(std::uint64_t n, const std::function<void()>& write, const std::function<std::uint64_t()>& read) {
  const std::int64_t begin_ns = rt::monotonic_ns();
  std::thread writer(write);
  sink = read();
  writer.join();
  return static_cast<double>(rt::monotonic_ns() - begin_ns) / static_cast<double>(n);
}

double cpu_time_ns() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e9 * static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec);
}

double ours_burst(std::uint64_t n) {
  rt::SpscRing<std::uint64_t> ring(kSlots, 0);
  auto writer = ring.writer();
  auto reader = ring.reader();
  const double begin_ns = cpu_time_ns();
  std::uint64_t sum = 0;
  for (std::uint64_t i = 0; i < n;) {
    while (std::uint64_t* slot = writer.try_claim()) *slot = i++, writer.publish();
    while (const std::uint64_t* item = reader.front()) sum += *item, reader.pop();
  }
  sink = sum;
  return (cpu_time_ns() - begin_ns) / static_cast<double>(n);
}

double boost_burst(std::uint64_t n) {
  boost::lockfree::spsc_queue<std::uint64_t, boost::lockfree::capacity<kSlots>> queue;
  const double begin_ns = cpu_time_ns();
  std::uint64_t sum = 0, item = 0;
  for (std::uint64_t i = 0; i < n;) {
    while (queue.push(i)) ++i;
    while (queue.pop(item)) sum += item;
  }
  sink = sum;
  return (cpu_time_ns() - begin_ns) / static_cast<double>(n);
}

double ours_words(std::uint64_t n) {
  rt::SpscRing<std::uint64_t> ring(kSlots, 0);
  return time_ns(
      n,
      [&] {
        auto writer = ring.writer();
        for (std::uint64_t i = 0; i < n;) {
          if (std::uint64_t* slot = writer.try_claim()) *slot = i++, writer.publish();
        }
      },
      [&] {
        auto reader = ring.reader();
        std::uint64_t sum = 0;
        for (std::uint64_t i = 0; i < n;) {
          if (const std::uint64_t* item = reader.front()) sum += *item, reader.pop(), ++i;
        }
        return sum;
      });
}

double boost_words(std::uint64_t n) {
  boost::lockfree::spsc_queue<std::uint64_t, boost::lockfree::capacity<kSlots>> queue;
  return time_ns(
      n,
      [&] {
        for (std::uint64_t i = 0; i < n;) i += queue.push(i) ? 1U : 0U;
      },
      [&] {
        std::uint64_t sum = 0;
        std::uint64_t item = 0;
        for (std::uint64_t i = 0; i < n;) {
          if (queue.pop(item)) sum += item, ++i;
        }
        return sum;
      });
}

double ours_frames(std::uint64_t n) {
  const auto prototype = std::make_unique<Frame>();
  rt::SpscRing<Frame> ring(kFrameSlots, *prototype);
  return time_ns(
      n,
      [&] {
        auto writer = ring.writer();
        for (std::uint64_t i = 0; i < n;) {
          if (Frame* slot = writer.try_claim()) expose(*slot, i++), writer.publish();
        }
      },
      [&] {
        auto reader = ring.reader();
        std::uint64_t sum = 0;
        for (std::uint64_t i = 0; i < n;) {
          if (const Frame* frame = reader.front()) sum += look(*frame), reader.pop(), ++i;
        }
        return sum;
      });
}

// Boost's reader can also read in place (consume_one); its writer must copy a frame.
double boost_frames(std::uint64_t n) {
  const auto queue = std::make_unique<boost::lockfree::spsc_queue<Frame, boost::lockfree::capacity<kFrameSlots>>>();
  return time_ns(
      n,
      [&] {
        const auto frame = std::make_unique<Frame>();
        for (std::uint64_t i = 0; i < n; ++i) {
          expose(*frame, i);
          while (!queue->push(*frame)) {
          }
        }
      },
      [&] {
        std::uint64_t sum = 0;
        for (std::uint64_t i = 0; i < n;) i += queue->consume_one([&](const Frame& frame) { sum += look(frame); });
        return sum;
      });
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

void compare(const char* what, int rounds, std::uint64_t n, double (*ours)(std::uint64_t),
             double (*theirs)(std::uint64_t)) {
  std::vector<double> our_ns, their_ns, ratio;
  for (int round = 0; round < rounds; ++round) {
    our_ns.push_back(ours(n));
    their_ns.push_back(theirs(n));
    ratio.push_back(their_ns.back() / our_ns.back());
  }
  std::printf("%s\t%.2f\t%.2f\t%.2f\n", what, median(our_ns), median(their_ns), median(ratio));
}

}  // namespace

int main(int argc, char** argv) {
  const auto number = [&](int i, long fallback) { return argc > i ? std::atol(argv[i]) : fallback; };
  const int rounds = static_cast<int>(number(1, 40));
  compare("burst", rounds, static_cast<std::uint64_t>(number(2, 1'000'000)), ours_burst, boost_burst);
  compare("words", rounds, static_cast<std::uint64_t>(number(2, 1'000'000)), ours_words, boost_words);
  compare("frames", rounds, static_cast<std::uint64_t>(number(3, 100)), ours_frames, boost_frames);
  return 0;
}
