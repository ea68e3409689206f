// Preloaded: the wall clock (CLOCK_REALTIME) steps by an hour, forward and back, at every call. CLOCK_MONOTONIC stays.
// The functions of libc are replaced under their own names.
#include <dlfcn.h>
#include <sys/time.h>

#include <atomic>
#include <ctime>

namespace {

constexpr time_t kStep_s = 3600;
std::atomic<unsigned> n_calls{0};  // relaxed: only its lowest bits matter

// +1 h, 0, -1 h, 0, ...
time_t step() noexcept {
  switch (n_calls.fetch_add(1, std::memory_order_relaxed) % 4) {
    case 0:
      return kStep_s;
    case 2:
      return -kStep_s;
    default:
      return 0;
  }
}

}  // namespace

extern "C" {

int clock_gettime(clockid_t clock, timespec* out) noexcept {
  using Call = int(clockid_t, timespec*);
  static Call* const real = reinterpret_cast<Call*>(dlsym(RTLD_NEXT, "clock_gettime"));
  const int status = real(clock, out);
  if (status == 0 && clock == CLOCK_REALTIME) out->tv_sec += step();
  return status;
}

int gettimeofday(timeval* out, void*) noexcept {
  timespec now{};
  const int status = clock_gettime(CLOCK_REALTIME, &now);
  if (status == 0) *out = {now.tv_sec, now.tv_nsec / 1000};
  return status;
}

time_t time(time_t* out) noexcept {
  timespec now{};
  (void)clock_gettime(CLOCK_REALTIME, &now);
  if (out != nullptr) *out = now.tv_sec;
  return now.tv_sec;
}

}  // extern "C"
