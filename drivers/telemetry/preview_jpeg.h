#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/types/preview.h"

namespace drivers {

inline constexpr std::size_t kPreviewJpegBytes = 12'000;  // aimed at; fine texture at the lowest quality may take more

// A gray JPEG of the preview's pixels, of a quality that keeps it small. Throws std::runtime_error where the pixels are
// not width x height.
[[nodiscard]] std::vector<std::uint8_t> preview_jpeg(const core::Preview& preview);

}  // namespace drivers
