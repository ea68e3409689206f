#include "tests/hooks/call_hooks.h"

#include <cxxabi.h>
#include <dlfcn.h>
#include <execinfo.h>
#include <pthread.h>
#include <sys/prctl.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <map>
#include <tuple>

#include "tests/hooks/libc_allocator.h"

namespace {

enum Kind : std::uint8_t { kAllocation, kLock, kWait, kFree };
constexpr std::array<const char*, 4> kKindNames{"allocation", "lock", "wait", "free"};
constexpr std::size_t kThreads = 32, kSites = 1024, kDepth = 32;

struct Site {
  Kind kind = kAllocation;
  std::uint64_t hash = 0, n = 0;
  int n_frames = 0;
  std::array<void*, kDepth> frames{};
};
struct ThreadRecord {
  std::array<char, 16> name{};
  std::array<std::uint64_t, 4> n{};
  std::array<Site, kSites> sites{};
  std::size_t n_sites = 0;
};

// Static: nothing is allocated while counting.
std::array<ThreadRecord, kThreads> records;
std::atomic<std::size_t> n_records{0};
std::atomic<bool> counting{false};
thread_local ThreadRecord* own_record = nullptr;
thread_local bool inside = false;

ThreadRecord* record_of_this_thread() noexcept {
  if (own_record != nullptr) return own_record;
  std::array<char, 16> name{};
  prctl(PR_GET_NAME, name.data());
  if (std::strncmp(name.data(), "hm-", 3) != 0) return nullptr;
  const std::size_t i = n_records.fetch_add(1);
  if (i >= kThreads) return nullptr;
  records[i].name = name;
  return own_record = &records[i];
}

void note_site(ThreadRecord& record, Kind kind) noexcept {
  std::array<void*, kDepth> frames{};
  const int n_frames = backtrace(frames.data(), static_cast<int>(kDepth));
  std::uint64_t hash = static_cast<std::uint64_t>(kind) + 1;
  for (int i = 0; i < n_frames; ++i)
    hash = (hash ^ reinterpret_cast<std::uintptr_t>(frames[static_cast<std::size_t>(i)])) * 0x100000001b3U;
  for (std::size_t s = 0; s < record.n_sites; ++s) {
    if (record.sites[s].hash == hash) return static_cast<void>(++record.sites[s].n);
  }
  if (record.n_sites < kSites) record.sites[record.n_sites++] = {kind, hash, 1, n_frames, frames};
}

void note(Kind kind) noexcept {
  if (inside || !counting.load(std::memory_order_relaxed)) return;
  inside = true;  // backtrace() may call a hook itself
  if (ThreadRecord* record = record_of_this_thread()) {
    ++record->n[kind];
    if (kind != kFree) note_site(*record, kind);
  }
  inside = false;
}

template <class Function>
Function next(const char* name) noexcept {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

std::string library_of(const Dl_info& info) {
  const std::string path = info.dli_fname == nullptr ? "" : info.dli_fname;
  return path.substr(path.rfind('/') + 1);
}
std::string function_of(const Dl_info& info) {
  if (info.dli_sname == nullptr) return "(internal)";
  int status = 0;
  char* plain = abi::__cxa_demangle(info.dli_sname, nullptr, nullptr, &status);
  std::string name = status == 0 ? plain : info.dli_sname;
  std::free(plain);
  return name.substr(0, name.find('('));
}
bool is_plumbing(const std::string& library, const std::string& function) {
  return library.starts_with("libc.so") || library.starts_with("libstdc++") || library.starts_with("libgcc") ||
         function == "malloc" || function == "calloc" || function == "realloc" || function == "free" ||
         function == "posix_memalign" || function == "aligned_alloc" || function == "memalign" ||
         function.starts_with("pthread_") || function.starts_with("operator new");
}

hooks::CallSite resolve(const ThreadRecord& record, const Site& site) {
  hooks::CallSite out{record.name.data(), kKindNames[site.kind], "", "", "", false, site.n};
  for (std::size_t i = 2; i < static_cast<std::size_t>(site.n_frames); ++i) {  // 0, 1: note_site, note
    Dl_info info{};
    if (dladdr(site.frames[i], &info) == 0) continue;
    const std::string library = library_of(info), function = function_of(info);
    if (is_plumbing(library, function)) continue;
    const bool is_ours = library.find(".so") == library.npos;
    if (out.library.empty()) out.library = library, out.function = function;
    if (!is_ours || function.find("cv::") == 0) {
      out.in_opencv = true;
    } else if (function != "(internal)" || i + 1 == static_cast<std::size_t>(site.n_frames)) {
      out.through = function;  // the innermost function of this project that has a name
      break;
    }
  }
  return out;
}

}  // namespace

extern "C" {

void* malloc(std::size_t size) {
  note(kAllocation);
  return __libc_malloc(size);
}
void* calloc(std::size_t n, std::size_t size) {
  note(kAllocation);
  return __libc_calloc(n, size);
}
void* realloc(void* memory, std::size_t size) {
  note(kAllocation);
  return __libc_realloc(memory, size);
}
void* memalign(std::size_t alignment, std::size_t size) {
  note(kAllocation);
  return __libc_memalign(alignment, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  note(kAllocation);
  return __libc_memalign(alignment, size);
}
int posix_memalign(void** memory, std::size_t alignment, std::size_t size) {
  note(kAllocation);
  *memory = __libc_memalign(alignment, size);
  return *memory == nullptr ? ENOMEM : 0;
}
void free(void* memory) {
  if (memory != nullptr) note(kFree);
  __libc_free(memory);
}

int pthread_mutex_lock(pthread_mutex_t* mutex) {
  static const auto real = next<int (*)(pthread_mutex_t*)>("pthread_mutex_lock");
  note(kLock);
  return real(mutex);
}
int pthread_rwlock_rdlock(pthread_rwlock_t* lock) {
  static const auto real = next<int (*)(pthread_rwlock_t*)>("pthread_rwlock_rdlock");
  note(kLock);
  return real(lock);
}
int pthread_rwlock_wrlock(pthread_rwlock_t* lock) {
  static const auto real = next<int (*)(pthread_rwlock_t*)>("pthread_rwlock_wrlock");
  note(kLock);
  return real(lock);
}
int pthread_cond_wait(pthread_cond_t* condition, pthread_mutex_t* mutex) {
  static const auto real = next<int (*)(pthread_cond_t*, pthread_mutex_t*)>("pthread_cond_wait");
  note(kWait);
  return real(condition, mutex);
}
int pthread_cond_timedwait(pthread_cond_t* condition, pthread_mutex_t* mutex, const timespec* until) {
  static const auto real = next<int (*)(pthread_cond_t*, pthread_mutex_t*, const timespec*)>("pthread_cond_timedwait");
  note(kWait);
  return real(condition, mutex, until);
}

}  // extern "C"

namespace hooks {

void start_counting() {
  std::array<void*, 4> frames{};
  (void)backtrace(frames.data(), 4);  // loads the unwinder now, not during counting
  counting.store(true);
}

void stop_counting() noexcept { counting.store(false); }

std::vector<ThreadCalls> thread_calls() {
  std::vector<ThreadCalls> out;
  for (std::size_t i = 0; i < std::min(kThreads, n_records.load()); ++i) {
    const ThreadRecord& r = records[i];
    out.push_back({r.name.data(), r.n[kAllocation], r.n[kFree], r.n[kLock], r.n[kWait]});
  }
  return out;
}

std::vector<CallSite> call_sites() {
  std::map<std::tuple<std::string, std::string, std::string, std::string, std::string>, CallSite> joined;
  for (std::size_t i = 0; i < std::min(kThreads, n_records.load()); ++i) {
    for (std::size_t s = 0; s < records[i].n_sites; ++s) {
      const CallSite site = resolve(records[i], records[i].sites[s]);
      auto [at, is_new] = joined.try_emplace({site.thread, site.what, site.library, site.function, site.through}, site);
      if (!is_new) at->second.n += site.n;
    }
  }
  std::vector<CallSite> out;
  for (auto& [key, site] : joined) out.push_back(std::move(site));
  std::stable_sort(out.begin(), out.end(), [](const CallSite& a, const CallSite& b) { return a.n > b.n; });
  return out;
}

}  // namespace hooks
