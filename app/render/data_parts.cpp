#include "app/render/data_parts.hpp"

#include "mapping/geometry/far_parts.hpp"
#include "storage/store/reader/store_background.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace macadam {
namespace {

constexpr double margin_share = 0.02; // of the driven extent, to keep roads off the frame
constexpr double min_margin_m = 50;
constexpr double max_lat_deg = 85;
constexpr double min_shape = 0.3; // of the shorter side, relative to the longer

constexpr double max_share = 0.4;    // of the main part's diagonal, relative to that of all
constexpr double min_apart_m = 5000; // of the whole's diagonal
constexpr std::size_t max_parts = 4;

double diagonal_m(const GeoBox& box) {
    return distance_m({box.south_deg, box.west_deg}, {box.north_deg, box.east_deg});
}

constexpr double shows_all_denominator = 6000; // of a detail: its map has all names, too
constexpr int cells_per_side = 6;              // of an area's shorter side
constexpr double min_share = 1.0 / 3;          // of the first area's measured length
constexpr double max_cells = 4e6;

/// Lengths in square cells on the ground, row by row from the south-west.
struct LengthGrid {
    int columns, rows;
    double cell_m;
    std::vector<double> length_m;

    double& at(int column, int row) {
        return length_m[std::size_t(row) * std::size_t(columns) + std::size_t(column)];
    }
};

/// Area in cells.
struct Area {
    int column, row, columns, rows;
};

/// Returns the area with the greatest sum. Source of the running sums: F. C. Crow, "Summed-area
/// tables for texture mapping", SIGGRAPH 1984.
std::pair<Area, double> fullest_area(LengthGrid& grid, int columns, int rows) {
    std::vector<double> sums(std::size_t(grid.columns + 1) * std::size_t(grid.rows + 1));
    const auto sum = [&](int column, int row) -> double& {
        return sums[std::size_t(row) * std::size_t(grid.columns + 1) + std::size_t(column)];
    };
    for (int row = 0; row < grid.rows; ++row) {
        for (int column = 0; column < grid.columns; ++column) {
            sum(column + 1, row + 1) = grid.at(column, row) + sum(column, row + 1) +
                                       sum(column + 1, row) - sum(column, row);
        }
    }
    std::pair<Area, double> best{{0, 0, columns, rows}, -1};
    for (int row = 0; row + rows <= grid.rows; ++row) {
        for (int column = 0; column + columns <= grid.columns; ++column) {
            const double inside = sum(column + columns, row + rows) - sum(column, row + rows) -
                                  sum(column + columns, row) + sum(column, row);
            if (inside > best.second) {
                best = {{column, row, columns, rows}, inside};
            }
        }
    }
    return best;
}

/// Moves an area so that what is measured in it lies around its middle.
GeoBox centred(const GeoBox& area, const std::vector<MeasuredLength>& measured) {
    GeoBox inside;
    for (const auto& each : measured) {
        if (contains(area, each.at)) {
            inside = including(inside, each.at);
        }
    }
    if (is_empty(inside)) {
        return area;
    }
    const double half_width_deg = (area.east_deg - area.west_deg) / 2;
    const double half_height_deg = (area.north_deg - area.south_deg) / 2;
    const double lon_deg = (inside.west_deg + inside.east_deg) / 2;
    const double lat_deg = (inside.south_deg + inside.north_deg) / 2;
    return {.west_deg = lon_deg - half_width_deg,
            .south_deg = lat_deg - half_height_deg,
            .east_deg = lon_deg + half_width_deg,
            .north_deg = lat_deg + half_height_deg};
}

bool overlap(const GeoBox& a, const GeoBox& b) {
    return a.west_deg < b.east_deg && b.west_deg < a.east_deg && a.south_deg < b.north_deg &&
           b.south_deg < a.north_deg;
}

constexpr double rounding = 1e-6; // of a cell: a place at its edge is in no other

int first_cell(double place) {
    return std::max(0, int(std::floor(place + rounding)));
}

int past_cell(double place, int cells) {
    return std::min(cells, int(std::ceil(place - rounding)));
}

/// Sorts areas from west to east, or from north to south if they lie rather so.
void sort_for_reading(std::vector<GeoBox>& areas) {
    GeoBox all;
    for (const auto& area : areas) {
        all = including(all, {area.north_deg, area.west_deg});
    }
    if (is_empty(all)) {
        return;
    }
    const GeoPoint north_west{all.north_deg, all.west_deg};
    const bool is_row = distance_m(north_west, {all.north_deg, all.east_deg}) >
                        distance_m(north_west, {all.south_deg, all.west_deg});
    std::ranges::sort(areas, [&](const GeoBox& a, const GeoBox& b) {
        return is_row ? a.west_deg < b.west_deg : a.north_deg > b.north_deg;
    });
}

/// Returns the measured lengths of a filter; of a network without trips the lengths of all roads.
std::vector<MeasuredLength> lengths_in(const StoreReader& store, const SegmentFilter& filter) {
    std::vector<MeasuredLength> lengths;
    const auto add = [&](const SegmentRecord& record) {
        const auto& segment = record.segment;
        if (!segment.line.empty()) {
            lengths.push_back(
                {segment.line[segment.line.size() / 2], segment.to_m - segment.from_m});
        }
    };
    store.visit(filter, add);
    if (lengths.empty()) {
        auto all = filter;
        all.with_state_only = false;
        store.visit(all, add);
    }
    return lengths;
}

/// Tells whether an area has more to show than a road that runs through it.
bool has_several_roads(const GeoBox& area, const std::vector<MeasuredLength>& measured) {
    constexpr double both_directions_with_bends = 3; // of the area's diagonal
    double inside_m = 0;
    for (const auto& each : measured) {
        inside_m += contains(area, each.at) ? each.length_m : 0;
    }
    return inside_m > both_directions_with_bends * diagonal_m(area);
}

} // namespace

std::string place_in(const StoreReader& store, const GeoBox& box) {
    const auto places = StoreBackground{store}.places(box);
    return places.empty() ? std::string{} : places.front().name;
}

/// Returns the box with ground around it: a single road gets some on both sides.
GeoBox box_with_margin(const GeoBox& box) {
    auto around = grown(box, std::max(min_margin_m, margin_share * diagonal_m(box)));
    const GeoPoint middle{(around.south_deg + around.north_deg) / 2,
                          (around.west_deg + around.east_deg) / 2};
    const double width_m =
        distance_m({middle.lat_deg, around.west_deg}, {middle.lat_deg, around.east_deg});
    const double height_m =
        distance_m({around.south_deg, middle.lon_deg}, {around.north_deg, middle.lon_deg});
    const double missing_width = min_shape * height_m / width_m;
    if (missing_width > 1) {
        const double half_deg = (around.east_deg - around.west_deg) / 2 * missing_width;
        around.west_deg = middle.lon_deg - half_deg;
        around.east_deg = middle.lon_deg + half_deg;
    }
    const double missing_height = min_shape * width_m / height_m;
    const double half_deg = (around.north_deg - around.south_deg) / 2 * missing_height;
    if (missing_height > 1 && std::abs(middle.lat_deg) + half_deg < max_lat_deg) {
        around.south_deg = middle.lat_deg - half_deg;
        around.north_deg = middle.lat_deg + half_deg;
    }
    return around;
}

void set_insets(const StoreReader& store, const SegmentFilter& filter, MapScene& scene) {
    if (diagonal_m(scene.box) < min_apart_m || scene.box.east_deg > 180) {
        return;
    }
    FarParts data{scene.box};
    store.visit(filter, [&](const SegmentRecord& record) {
        const auto& segment = record.segment;
        for (const auto& point : segment.line) {
            data.add(point, (segment.to_m - segment.from_m) / double(segment.line.size()));
        }
    });
    const auto parts = data.parts();
    if (parts.size() < 2 || parts.size() > max_parts ||
        diagonal_m(parts[0].box) > max_share * diagonal_m(scene.box)) {
        return;
    }
    scene.box = box_with_margin(parts[0].box);
    scene.data_box = parts[0].box;
    scene.place = place_in(store, scene.box);
    for (std::size_t i = 1; i < parts.size(); ++i) {
        auto& inset = scene.insets.emplace_back();
        inset.box = box_with_margin(parts[i].box);
        inset.name = place_in(store, inset.box);
        if (inset.name.empty()) { // something that the overview can repeat
            inset.name = char('A' + int(i) - 1);
        }
    }
}

std::vector<GeoBox> densest_areas(const std::vector<MeasuredLength>& measured,
                                  const GeoBox& box,
                                  const DetailRoom& room) {
    const GeoPoint south_west{box.south_deg, box.west_deg};
    const double middle_deg = (box.south_deg + box.north_deg) / 2;
    const double width_m = distance_m({middle_deg, box.west_deg}, {middle_deg, box.east_deg});
    const double height_m = distance_m(south_west, {box.north_deg, box.west_deg});
    const double lon_deg_per_m = (box.east_deg - box.west_deg) / std::max(1.0, width_m);
    const double lat_deg_per_m = (box.north_deg - box.south_deg) / std::max(1.0, height_m);

    const double cell_m = std::min(room.width_m, room.height_m) / cells_per_side;
    const auto cells = [&](double length_m) {
        return std::max(1, int(std::ceil(length_m / cell_m - rounding)));
    };
    if (!(width_m / cell_m * (height_m / cell_m) < max_cells)) {
        return {};
    }
    const int columns = cells(room.width_m);
    const int rows = cells(room.height_m);
    LengthGrid grid{.columns = std::max(columns, cells(width_m)),
                    .rows = std::max(rows, cells(height_m)),
                    .cell_m = cell_m,
                    .length_m = {}};
    grid.length_m.resize(std::size_t(grid.columns) * std::size_t(grid.rows));
    for (const auto& [at, length_m] : measured) {
        const double x_m = (at.lon_deg - box.west_deg) / lon_deg_per_m;
        const double y_m = (at.lat_deg - box.south_deg) / lat_deg_per_m;
        grid.at(std::clamp(int(x_m / cell_m), 0, grid.columns - 1),
                std::clamp(int(y_m / cell_m), 0, grid.rows - 1)) += length_m;
    }
    std::vector<GeoBox> areas;
    double first_m = 0;
    while (areas.size() < room.count) {
        const auto [area, inside_m] = fullest_area(grid, columns, rows);
        first_m = areas.empty() ? inside_m : first_m;
        if (inside_m <= 0 || inside_m < min_share * first_m) {
            break;
        }
        const double west_deg = box.west_deg + area.column * cell_m * lon_deg_per_m;
        const double south_deg = box.south_deg + area.row * cell_m * lat_deg_per_m;
        const GeoBox found{.west_deg = west_deg,
                           .south_deg = south_deg,
                           .east_deg = west_deg + room.width_m * lon_deg_per_m,
                           .north_deg = south_deg + room.height_m * lat_deg_per_m};
        const auto moved = centred(found, measured);
        const bool is_free =
            std::ranges::none_of(areas, [&](const GeoBox& other) { return overlap(moved, other); });
        areas.push_back(is_free ? moved : found);
        const auto cell = [&](double deg, double from_deg, double deg_per_m) {
            return (deg - from_deg) / deg_per_m / cell_m;
        };
        const auto& taken = areas.back();
        const int past_row =
            past_cell(cell(taken.north_deg, box.south_deg, lat_deg_per_m), grid.rows);
        const int past_column =
            past_cell(cell(taken.east_deg, box.west_deg, lon_deg_per_m), grid.columns);
        for (int row = first_cell(cell(taken.south_deg, box.south_deg, lat_deg_per_m));
             row < past_row;
             ++row) {
            for (int column = first_cell(cell(taken.west_deg, box.west_deg, lon_deg_per_m));
                 column < past_column;
                 ++column) {
                grid.at(column, row) = -first_m; // no other area may overlap
            }
        }
    }
    sort_for_reading(areas);
    return areas;
}

void set_details(const StoreReader& store,
                 const SegmentFilter& filter,
                 const DetailRoom& room,
                 MapScene& scene) {
    const auto lengths = lengths_in(store, filter);
    for (const auto& area : densest_areas(lengths, scene.box, room)) {
        if (room.scale_denominator <= shows_all_denominator && !has_several_roads(area, lengths)) {
            continue;
        }
        scene.insets.push_back({.box = area,
                                .name = place_in(store, area),
                                .scale_denominator = room.scale_denominator});
    }
}

bool centre_on_densest_area(const StoreReader& store,
                            const SegmentFilter& filter,
                            const DetailRoom& room,
                            MapScene& scene) {
    const auto& shown = is_empty(scene.data_box) ? scene.box : scene.data_box;
    const double middle_deg = (shown.south_deg + shown.north_deg) / 2;
    const GeoPoint south_west{shown.south_deg, shown.west_deg};
    if (distance_m({middle_deg, shown.west_deg}, {middle_deg, shown.east_deg}) <= room.width_m &&
        distance_m(south_west, {shown.north_deg, shown.west_deg}) <= room.height_m) {
        return false;
    }
    const auto areas = densest_areas(lengths_in(store, filter), scene.box, room);
    if (areas.empty()) {
        return false;
    }
    scene.box = scene.data_box = areas.front();
    return true;
}

} // namespace macadam
