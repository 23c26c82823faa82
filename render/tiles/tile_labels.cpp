#include "render/tiles/tile_labels.hpp"

#include "render/map/map_labels.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

namespace macadam {
namespace {

constexpr std::array named_from_zoom{11, 11, 13, 13, 15, 15}; // by rank
constexpr double max_labelled_zoom = 22; // labels store a pixel of the world as an int

bool is_named(const MapLine& line, const WorldWindow& window) {
    const int rank = std::clamp(line.rank, 0, 5);
    return !line.name.empty() && zoom_of_256_px(window.scale) >= named_from_zoom[std::size_t(rank)];
}

RoadName road_name(const MapLine& line, const WorldWindow& window, const LineWidths& widths) {
    RoadName road{.line = {},
                  .name = is_named(line, window) ? line.name : "",
                  .rank = std::clamp(line.rank, 0, 5),
                  .quiet = line.iri_class < 0,
                  .half_width_px = painted_half_width_px(widths, line)};
    for (const auto& place : line.line) {
        const auto at = grid_point(place, window.scale);
        road.line.push_back({double(at.x) / grid_per_px, double(at.y) / grid_per_px});
    }
    return road;
}

} // namespace

std::vector<Label> tile_labels(std::span<const MapLine> lines,
                               const WorldWindow& window,
                               const LineWidths& widths,
                               TypeSetter& setter) {
    const auto has_name = [&](const MapLine& line) { return is_named(line, window); };
    if (zoom_of_256_px(window.scale) > max_labelled_zoom || std::ranges::none_of(lines, has_name)) {
        return {};
    }
    std::vector<RoadName> roads;
    for (const auto& line : lines) {
        roads.push_back(road_name(line, window, widths));
    }
    std::vector<Label> labels;
    const auto first_of = [](std::int64_t px) { return px / label_cell_px; };
    const auto last_row = first_of(window.top_px + window.side_px - 1);
    const auto last_column = first_of(window.left_px + window.side_px - 1);
    for (auto row = first_of(window.top_px); row <= last_row; ++row) {
        for (auto column = first_of(window.left_px); column <= last_column; ++column) {
            const auto cell =
                label_cell_at(double(column) * label_cell_px, double(row) * label_cell_px);
            std::ranges::move(placed_labels(roads, cell, LabelConfig{}, setter),
                              std::back_inserter(labels));
        }
    }
    return labels;
}

} // namespace macadam
