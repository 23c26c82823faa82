#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

namespace macadam {

/// Colour vision of a reader.
enum class ColourVision { normal, protanopia, deuteranopia, tritanopia };

inline constexpr std::array all_sights{ColourVision::normal,
                                       ColourVision::protanopia,
                                       ColourVision::deuteranopia,
                                       ColourVision::tritanopia};

std::string_view name_of(ColourVision sight);

/// Computes the perceived difference of two sRGB colours (0xRRGGBB), CIEDE2000: 0 for identical
/// colours, about 1 for a just noticeable difference, 10 for map classes that are distinguished at
/// a glance.
///
/// Source: G. Sharma, W. Wu, E. N. Dalal, "The CIEDE2000 color-difference formula", Color Research
/// and Application 30 (2005), pp. 21-30; full deficiencies after G. M. Machado, M. M. Oliveira, L.
/// A. F. Fernandes, "A physiologically-based model for simulation of color vision deficiency", IEEE
/// TVCG 15 (2009), pp. 1291-1298, on linear RGB.
double colour_difference(std::uint32_t a, std::uint32_t b, ColourVision sight);

/// Pair of colours with the smallest difference.
struct NearestColours {
    std::size_t a = 0, b = 0; ///< a < b
    ColourVision sight = ColourVision::normal;
    double difference = 0;
};

/// Finds the pair over all colours and kinds of vision. \param colours  at least two
NearestColours nearest_colours(std::span<const std::uint32_t> colours);

/// Returns the contrast ratio of lightness, 1 (none) to 21: W3C, "Web Content Accessibility
/// Guidelines 2.1", contrast ratio.
double contrast_ratio(std::uint32_t a, std::uint32_t b);

} // namespace macadam
