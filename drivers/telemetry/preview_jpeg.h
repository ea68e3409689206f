#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/types/preview.h"

namespace drivers {

inline constexpr std::size_t kPreviewJpegBytes = 12'000;  // target; fine texture at the lowest quality may take more

// A gray JPEG of the preview's pixels, with a quality that keeps it small. Throws std::runtime_error unless there are
// width x height pixels.
[[nodiscard]] std::vector<std::uint8_t> preview_jpeg(const core::Preview& preview);

}  // namespace drivers
