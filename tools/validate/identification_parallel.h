#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <exception>
#include <thread>
#include <vector>

namespace tools {

// One result per seed first .. first + n_seeds - 1, in their order, whichever thread made it. The first exception is
// rethrown.
template <class Make>
[[nodiscard]] auto for_each_seed(int n_seeds, int n_threads, Make make, int first = 1) {
  std::vector<decltype(make(std::uint64_t{1}))> results(static_cast<std::size_t>(n_seeds));
  std::vector<std::exception_ptr> failures(results.size());
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t i = next++; i < results.size(); i = next++) {
      try {
        results[i] = make(static_cast<std::uint64_t>(i) + static_cast<std::uint64_t>(first));
      } catch (...) {
        failures[i] = std::current_exception();
      }
    }
  };
  {
    std::vector<std::jthread> threads;
    for (int t = 1; t < std::min(n_threads, n_seeds); ++t) threads.emplace_back(work);
    work();
  }
  for (const std::exception_ptr& failure : failures) {
    if (failure) std::rethrow_exception(failure);
  }
  return results;
}

// Of the seeds that the options name.
template <class Options, class Make>
[[nodiscard]] auto for_each_seed(const Options& options, Make make) {
  return for_each_seed(options.n_seeds, options.n_threads, make, options.first_seed);
}

}  // namespace tools
