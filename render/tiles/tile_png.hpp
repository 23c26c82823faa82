#pragma once

#include "render/scene/scene.hpp"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace macadam {

/// Square part of a picture.
struct PictureCut {
    int left_px, top_px;
    int side_px;
};

/// Encoder of tiles as PNG files of one byte per pixel, with one palette for all tiles of a style.
///
/// The palette has the colours of the style and even steps between any two that can be adjacent. A
/// pixel gets the nearest of them (in squared RGB), independent of the rest of the tile, so that
/// tiles match as the pictures do; colours of the style are exact, and edges differ by a few levels
/// at most. The stream is compressed by libdeflate.
class TilePng {
public:
    /// \param has_background  false: the palette has no colours of a background, and more steps
    /// \throws InputError  for an unknown ramp
    explicit TilePng(const MapStyle& style, bool has_background = false);
    ~TilePng();
    TilePng(TilePng&&) noexcept;
    TilePng& operator=(TilePng&&) noexcept;

    /// \param cut  inside the picture
    std::vector<std::uint8_t> encode(const Image& image, const PictureCut& cut);

    /// Returns a tile of the ground alone.
    std::vector<std::uint8_t> empty(int side_px);

    /// 0xRRGGBB, at most 255.
    std::span<const std::uint32_t> palette() const;

    /// Returns the palette colour that represents a colour.
    std::uint32_t shown(std::uint32_t rgb);

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace macadam
