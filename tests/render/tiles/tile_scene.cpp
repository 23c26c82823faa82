#include "tile_scene.hpp"

#include <cmath>
#include <numbers>
#include <random>

namespace macadam::testing {
namespace {

GeoPoint place_at(const WorldWindow& window, double x_px, double y_px) {
    const double per_px = 1.0 / window.scale.tile_px;
    return geo_point(
        {(double(window.left_px) + x_px) * per_px, (double(window.top_px) + y_px) * per_px},
        window.scale.zoom);
}

/// A street from crossing to crossing, cut into pieces, there and perhaps back.
class Builder {
public:
    explicit Builder(const WorldWindow& window) : window_{window} {}

    void street(const std::vector<PointEn>& places_px, int rank) {
        const bool oneway = number_ % 5 == 0;
        const bool measured = number_ % 7 != 0;
        ++number_;
        for (std::size_t i = 1; i < places_px.size(); ++i) {
            add({places_px[i - 1], places_px[i]}, rank, measured, !oneway, true);
        }
        for (std::size_t i = places_px.size() - 1; i > 0 && !oneway; --i) {
            add({places_px[i], places_px[i - 1]}, rank, measured, true, false);
        }
    }

    std::vector<MapLine> lines;

private:
    void add(const std::vector<PointEn>& places_px,
             int rank,
             bool measured,
             bool both_ways,
             bool forward) {
        auto line = line_at(window_, places_px, measured ? int(random_() % 3) : -1, rank);
        line.both_ways = both_ways;
        line.forward = forward;
        line.certain = random_() % 3 != 0;
        lines.push_back(std::move(line));
    }

    WorldWindow window_;
    std::mt19937 random_{11};
    int number_ = 1;
};

std::vector<PointEn> bent(const PointEn& from, const PointEn& to, double bend_px) {
    std::vector<PointEn> places;
    const double dx = to.east_m - from.east_m;
    const double dy = to.north_m - from.north_m;
    const double length = std::hypot(dx, dy);
    const int pieces = std::max(1, int(length / 20));
    for (int i = 0; i <= pieces; ++i) {
        const double t = double(i) / pieces;
        const double aside = bend_px * std::sin(t * std::numbers::pi) / length;
        places.push_back({from.east_m + t * dx - aside * dy, from.north_m + t * dy + aside * dx});
    }
    return places;
}

} // namespace

MapLine
line_at(const WorldWindow& window, const std::vector<PointEn>& places_px, int iri_class, int rank) {
    MapLine line;
    for (const auto& [x_px, y_px] : places_px) {
        line.line.push_back(place_at(window, x_px, y_px));
    }
    line.iri_class = iri_class;
    line.rank = rank;
    return line;
}

std::vector<MapLine> town_in(const WorldWindow& window, double block_px) {
    std::mt19937 random{7};
    std::uniform_real_distribution<double> shift{-0.25 * block_px, 0.25 * block_px};
    const int side = int(window.side_px / block_px) + 3;
    std::vector<PointEn> crossings;
    for (int i = 0; i < side * side; ++i) {
        crossings.push_back(
            {(i % side - 1) * block_px + shift(random), (i / side - 1) * block_px + shift(random)});
    }
    Builder town{window};
    for (int i = 0; i < side * side; ++i) {
        const int rank = i % 4 == 0 ? 2 : i % 6 == 0 ? 5 : 4;
        if (i % side + 1 < side) {
            town.street(bent(crossings[i], crossings[i + 1], shift(random)), rank);
        }
        if (i / side + 1 < side) {
            town.street(bent(crossings[i], crossings[i + side], shift(random)), rank);
        }
    }
    const double far_px = window.side_px;
    town.street(
        {{-3 * far_px, 0.2 * far_px}, {0.5 * far_px, 0.45 * far_px}, {5 * far_px, 0.9 * far_px}},
        0);
    const double half_px = far_px / 2;
    town.street({{half_px - 60, half_px},
                 {half_px + 60, half_px + 5},
                 {half_px - 60, half_px + 10},
                 {half_px + 60, half_px + 15}},
                3);
    return std::move(town.lines);
}

} // namespace macadam::testing
