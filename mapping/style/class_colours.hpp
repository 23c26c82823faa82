#pragma once

#include <cstddef>
#include <cstdint>

namespace macadam {

/// Returns the colour of class `index` of `count`, from smooth to rough, as 0xRRGGBB, for files
/// with an embedded style. ColorBrewer RdYlBu with blue for good: its classes remain distinct under
/// every colour-vision deficiency.
std::uint32_t class_rgb(std::size_t index, std::size_t count);

} // namespace macadam
