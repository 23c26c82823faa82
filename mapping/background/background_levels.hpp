#pragma once

#include "mapping/background/background.hpp"

#include <array>
#include <cstdint>

namespace macadam {

/// A generalisation of the background for a range of scales, in tiles of a Web Mercator zoom.
struct BackgroundLevel {
    std::uint8_t zoom;
    double tolerance;       ///< of simplified lines, in cells
    double min_area;        ///< of areas, in cells
    double max_denominator; ///< smallest scale for which it serves, 1:N on paper
};

inline constexpr int background_cell_bits = 13;
inline constexpr std::int32_t background_cells = 1 << background_cell_bits; ///< along a tile's side

/// From the finest to the coarsest. At 47 degrees of latitude a cell is 0.2, 1.6 and 13 m wide.
inline constexpr std::array<BackgroundLevel, 3> background_levels{{
    {.zoom = 14, .tolerance = 1.5, .min_area = 4, .max_denominator = 40'000},
    {.zoom = 11, .tolerance = 3, .min_area = 400, .max_denominator = 250'000},
    {.zoom = 8, .tolerance = 3, .min_area = 400, .max_denominator = 1e12},
}};

/// Tests whether a kind is stored at a level.
constexpr bool is_at_level(BackgroundKind kind, const BackgroundLevel& level) {
    return level.zoom == background_levels[0].zoom ||
           (kind != BackgroundKind::building && kind != BackgroundKind::stream &&
            kind != BackgroundKind::siding);
}

/// Returns the level that serves a map of scale 1 : `denominator`.
constexpr const BackgroundLevel& background_level(double denominator) {
    for (const auto& level : background_levels) {
        if (denominator <= level.max_denominator) {
            return level;
        }
    }
    return background_levels.back();
}

/// Smallest scale at which buildings are shown, 1:N.
inline constexpr double building_denominator = 15'000;

} // namespace macadam
