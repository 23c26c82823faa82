#pragma once

#include "mapping/tiles/tile_features.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace macadam::testing {

/// Streets at random in some 8 km around Krems, of one direction or of both.
inline std::vector<TileSegment> tile_town(TileWords& words, std::size_t streets) {
    std::mt19937 random{41};
    constexpr double segment_units = 3300; // 20 m there
    const auto middle = world_point({48.4, 15.6});
    std::vector<TileSegment> segments;
    for (std::size_t street = 1; street <= streets; ++street) {
        double x = middle.x + double(random() % 1'300'000),
               y = middle.y + double(random() % 1'300'000);
        double angle = double(random() % 628) / 100;
        const bool is_oneway = random() % 3 == 0;
        const auto count = 1 + std::uint32_t(random() % 60);
        for (std::uint32_t i = 0; i < count; ++i) {
            const WorldPoint from{std::uint32_t(x), std::uint32_t(y)};
            x += segment_units * std::cos(angle);
            y += segment_units * std::sin(angle);
            angle += double(random() % 40) / 100 - 0.2;
            TileSegment made{};
            made.state.segment = {std::int64_t(street), true, i};
            made.state.iri_um = IriUm(700 + random() % 3000);
            made.state.passes = 1 + std::int32_t(random() % 9);
            made.state.validity = random() % 10 == 0 ? 8 : 0;
            made.name = words.number_of("Street " + std::to_string(street % 40));
            made.highway = words.number_of("residential");
            made.from_m = 20.0 * i;
            made.to_m = made.from_m + 20;
            made.line = {from, {std::uint32_t(x), std::uint32_t(y)}};
            segments.push_back(made);
            if (!is_oneway) {
                made.state.segment.forward = false;
                made.state.iri_um = IriUm(700 + random() % 3000);
                std::ranges::reverse(made.line);
                segments.push_back(made);
            }
        }
    }
    return segments;
}

} // namespace macadam::testing
