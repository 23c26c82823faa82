#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace macadam {

/// Colours from smooth to rough; the colours of classes are taken from it at equal distances.
struct ColourRamp {
    std::string_view name;
    std::span<const std::uint32_t> colours;          ///< 0xRRGGBB
    std::span<const std::uint32_t> colours_of_three; ///< for class tables of three classes
};

/// Returns the shipped ramps, the default first.
std::span<const ColourRamp> colour_ramps();

} // namespace macadam
