#include "render/tiles/tile_labels.hpp"

#include "render/map/map_labels.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

namespace macadam {
namespace {

constexpr std::array named_from_zoom{11, 11, 13, 13, 15, 15}; // by rank
constexpr double max_labelled_zoom = 22; // labels store a pixel of the world as an int

bool is_named(const MapLine& line, const WorldWindow& window) {
    const int rank = std::clamp(line.rank, 0, 5);
    return !line.name.empty() && zoom_of_256_px(window.scale) >= named_from_zoom[std::size_t(rank)];
}

/// Rounds a position to 1/256 px: equally good places for a name must not be told apart by the last
/// bits of a coordinate.
PixelPoint rounded(const PixelPoint& at) {
    constexpr double per_px = 256;
    return {std::round(at.x * per_px) / per_px, std::round(at.y * per_px) / per_px};
}

std::vector<PointName> places_in(std::span<const PointName> places, const PixelBox& box) {
    std::vector<PointName> within;
    std::ranges::copy_if(places, std::back_inserter(within), [&](const PointName& place) {
        return place.at.x >= box.left && place.at.x < box.right && place.at.y >= box.top &&
               place.at.y < box.bottom;
    });
    return within;
}

} // namespace

std::vector<Label> tile_labels(std::span<const MapLine> lines,
                               std::span<const PointName> places,
                               const WorldWindow& window,
                               const LineWidths& widths,
                               TypeSetter& setter) {
    const auto has_name = [&](const MapLine& line) { return is_named(line, window); };
    if (zoom_of_256_px(window.scale) > max_labelled_zoom ||
        (places.empty() && std::ranges::none_of(lines, has_name))) {
        return {};
    }
    auto roads = road_names(lines, world_frame(window.scale), widths, has_name);
    for (auto& road : roads) {
        std::ranges::transform(road.line, road.line.begin(), rounded);
    }
    std::vector<Label> labels;
    const auto first_of = [](std::int64_t px) { return px / label_cell_px; };
    const auto last_row = first_of(window.top_px + window.side_px - 1);
    const auto last_column = first_of(window.left_px + window.side_px - 1);
    for (auto row = first_of(window.top_px); row <= last_row; ++row) {
        for (auto column = first_of(window.left_px); column <= last_column; ++column) {
            const auto cell =
                label_cell_at(double(column) * label_cell_px, double(row) * label_cell_px);
            std::ranges::move(
                placed_labels(roads, places_in(places, cell.box), cell, LabelConfig{}, setter),
                std::back_inserter(labels));
        }
    }
    return labels;
}

} // namespace macadam
