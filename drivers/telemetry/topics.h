#pragma once

#include <array>
#include <cstddef>

namespace drivers {

// What a run tells, on one LCM channel each: prefix + suffix.
enum Topic : std::size_t { kModal, kDisplacement, kSpectrum, kTracks, kClosure, kHealth, kPreview, kTopics };
inline constexpr std::array<const char*, kTopics> kTopicSuffixes{"_MODAL",   "_DISPLACEMENT", "_SPECTRUM", "_TRACKS",
                                                                 "_CLOSURE", "_HEALTH",       "_PREVIEW"};

}  // namespace drivers
