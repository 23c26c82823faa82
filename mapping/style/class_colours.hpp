#pragma once

#include <cstddef>
#include <cstdint>

namespace macadam {

/// The colour of class `index` of `count`, from smooth to rough, as 0xRRGGBB: what files that carry
/// a style of their own show. ColorBrewer RdYlBu, good is blue: its classes stay apart under every
/// colour-vision deficiency.
std::uint32_t class_rgb(std::size_t index, std::size_t count);

} // namespace macadam
