#pragma once

#include "render/scene/scene.hpp"

#include <cstdint>
#include <vector>

namespace macadam {

/// Encodes a picture as a PNG file of one byte per pixel, less than half as large as by
/// encode_png(), for pages that carry their pictures. Up to 256 colours remain as they are. Of
/// more, the 128 most frequent remain, and every other colour becomes one that is no farther than
/// necessary: on maps some levels, along the edges of lines and letters.
std::vector<std::uint8_t> encode_palette_png(const Image& image);

} // namespace macadam
