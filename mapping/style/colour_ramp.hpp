#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace macadam {

/// Colours from smooth to rough, between which those of classes are taken at even distances.
struct ColourRamp {
    std::string_view name;
    std::span<const std::uint32_t> colours;          ///< 0xRRGGBB
    std::span<const std::uint32_t> colours_of_three; ///< where a map has three classes
};

/// The shipped ones, the default first.
std::span<const ColourRamp> colour_ramps();

} // namespace macadam
