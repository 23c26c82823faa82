#include "app/render/data_parts.hpp"

#include "mapping/geometry/far_parts.hpp"
#include "storage/store/reader/store_background.hpp"

#include <algorithm>
#include <cmath>
#include <string>
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

} // namespace macadam
