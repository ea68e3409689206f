// Counts the calls of the run path to libc: allocations and locks of every stage's thread over a whole run, by hooks.
//   HOVERMODAL_HOOK_FRAMES   frames of the run (default 400)
//   HOVERMODAL_HOOK_REPORT   file for the counts and call sites, tab-separated
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <map>

#include "tests/hooks/call_hooks.h"
#include "tests/support/pipeline_rig.h"

namespace {

std::uint64_t n_frames() {
  const char* asked = std::getenv("HOVERMODAL_HOOK_FRAMES");
  return asked != nullptr ? std::strtoull(asked, nullptr, 10) : 400;
}

void write_report(std::uint64_t frames) {
  const char* path = std::getenv("HOVERMODAL_HOOK_REPORT");
  if (path == nullptr) return;
  std::ofstream out(path);
  out << "frames\t" << frames << '\n';
  for (const auto& t : hooks::thread_calls()) {
    out << "thread\t" << t.thread << '\t' << t.n_allocations << '\t' << t.n_frees << '\t' << t.n_locks << '\t'
        << t.n_waits << '\n';
  }
  for (const auto& s : hooks::call_sites()) {
    out << "site\t" << s.thread << '\t' << s.what << '\t' << s.n << '\t' << s.library << '\t' << s.function << '\t'
        << s.through << '\t' << (s.in_opencv ? "library" : "ours") << '\n';
  }
}

TEST(RunPathCalls, CaptureTrackingAndSpectrumNeitherAllocateNorLockBeyondOpenCv) {
  tests::Rig rig(tests::frames(n_frames()));  // served from memory
  hooks::start_counting();
  const auto outcome = rig.run(tests::kPatience + std::chrono::seconds(n_frames() / 10));  // every call is traced back
  hooks::stop_counting();
  ASSERT_EQ(outcome.health.frames_processed, n_frames());
  write_report(n_frames());
  std::map<std::string, std::uint64_t> n_identify;
  for (const auto& site : hooks::call_sites()) {
    if (site.thread == "hm-identify") n_identify[site.what] += site.n;
    if (site.thread != "hm-capture" && site.thread != "hm-tracking" && site.thread != "hm-spectrum") continue;
    EXPECT_TRUE(site.in_opencv) << site.thread << ": " << site.n << " times " << site.what << " in " << site.function
                                << " (" << site.library << ") from " << site.through;
    EXPECT_EQ(site.thread, "hm-tracking") << site.what << " in " << site.function;
  }
  EXPECT_GT(n_identify["allocation"], 0U) << "the hooks count at all";
}

}  // namespace
