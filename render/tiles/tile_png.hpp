#pragma once

#include "render/scene/scene.hpp"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace macadam {

/// A square part of a picture.
struct PictureCut {
    int left_px, top_px;
    int side_px;
};

/// Tiles as PNG files of one byte a pixel, with one palette for all tiles of a style.
///
/// The palette has the colours of the style and even steps between any two that can lie side by
/// side. A pixel is given the nearest of them (in squared RGB), whatever else is on the tile, so
/// that tiles fit each other as the pictures do; what has a colour of the style keeps it exactly,
/// and edges are off by a few levels at most. The stream is compressed by libdeflate.
class TilePng {
public:
    /// \throws InputError  for an unknown ramp
    explicit TilePng(const MapStyle& style);
    ~TilePng();
    TilePng(TilePng&&) noexcept;
    TilePng& operator=(TilePng&&) noexcept;

    /// \param cut  inside the picture
    std::vector<std::uint8_t> encode(const Image& image, const PictureCut& cut);

    /// A tile without a road.
    std::vector<std::uint8_t> empty(int side_px);

    /// 0xRRGGBB, at most 255.
    std::span<const std::uint32_t> palette() const;

    /// The colour with which one is shown.
    std::uint32_t shown(std::uint32_t rgb);

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace macadam
