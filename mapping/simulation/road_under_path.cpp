
#include "mapping/simulation/road_under_path.hpp"

#include <algorithm>
#include <cstddef>

namespace macadam {
namespace {

constexpr double letting_down_m = 100;

/// Height by which a lane is lifted in one wheel track, since a position of the route.
struct Lift {
    double since_m = 0;
    double height_m = 0;

    double at(double route_m) const {
        const double x = std::clamp((route_m - since_m) / letting_down_m, 0.0, 1.0);
        return height_m * (1 - x * x * (3 - 2 * x));
    }
};

/// Profile of one wheel track over the lanes, read from front to back.
class Track {
public:
    /// Continues in another lane at a position of the route.
    void enter(double route_m, double elevation_m) { lift_ = {route_m, last_m_ - elevation_m}; }

    float lifted(double route_m, double elevation_m) {
        last_m_ = elevation_m + lift_.at(route_m);
        return static_cast<float>(last_m_);
    }

private:
    Lift lift_;
    double last_m_ = 0;
};

/// Interpolates an ascending table, read from front to back.
class TableCursor {
public:
    explicit TableCursor(const std::vector<double>& x) : x_{x} {}

    void to(double x) {
        while (at_ + 2 < x_.size() && x_[at_ + 1] <= x) {
            ++at_;
        }
        share_ = std::clamp((x - x_[at_]) / (x_[at_ + 1] - x_[at_]), 0.0, 1.0);
    }
    double of(const std::vector<double>& y) const {
        return y[at_] + share_ * (y[at_ + 1] - y[at_]);
    }

private:
    const std::vector<double>& x_;
    std::size_t at_ = 0;
    double share_ = 0;
};

} // namespace

RoadUnderWheels road_under(const DrivenPath& path, const LaneSource& lanes, double half_track_m) {
    RoadUnderWheels road;
    const auto count = static_cast<std::size_t>(path.travel_m.back() / road.step_m) + 1;
    road.left_m.reserve(count);
    road.right_m.reserve(count);

    TableCursor cursor{path.travel_m};
    Track left;
    Track right;
    std::size_t piece = 0;
    auto surface = lanes(path.pieces.front().lane);
    for (std::size_t i = 0; i < count; ++i) {
        cursor.to(static_cast<double>(i) * road.step_m);
        const double route_m = cursor.of(path.route_m);
        const double wander_m = cursor.of(path.wander_m);
        const auto under = [&](double side_m) {
            const auto& at = path.pieces[piece];
            return elevation_m(*surface, at.station_m + (route_m - at.from_m), wander_m + side_m);
        };
        while (piece + 1 < path.pieces.size() && path.pieces[piece].to_m <= route_m) {
            ++piece;
            surface = lanes(path.pieces[piece].lane);
            left.enter(route_m, under(half_track_m));
            right.enter(route_m, under(-half_track_m));
        }
        road.left_m.push_back(left.lifted(route_m, under(half_track_m)));
        road.right_m.push_back(right.lifted(route_m, under(-half_track_m)));
    }
    return road;
}

} // namespace macadam
