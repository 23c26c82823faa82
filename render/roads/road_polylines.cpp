#include "render/roads/road_polylines.hpp"

#include <algorithm>
#include <cmath>

namespace macadam {
namespace {

constexpr double min_piece_px = 0.3;
constexpr double flat_px =
    0.05; // maximum distance of a removable point from the line between its neighbours
constexpr std::size_t max_passed = 64; // bounds the cost of long straights

double apart_px(const PixelPoint& a, const PixelPoint& b) {
    return std::hypot(a.x - b.x, a.y - b.y);
}

bool between(const PixelPoint& from, const PixelPoint& to, const PixelPoint& point) {
    const PixelPoint way{to.x - from.x, to.y - from.y};
    const PixelPoint part{point.x - from.x, point.y - from.y};
    const double length = std::hypot(way.x, way.y);
    const double along = (part.x * way.x + part.y * way.y) / length;
    const double aside = std::abs(part.x * way.y - part.y * way.x) / length;
    return along > 0 && along < length && aside < flat_px;
}

/// Polyline under construction, point by point.
class Growing {
public:
    explicit Growing(int rank) { strand_.rank = rank; }

    void begin(const PixelPoint& point) { strand_.points.push_back(point); }

    void go_on(const PixelPoint& point, int look) {
        // An invisibly short line segment must not pass its look to a long one after it.
        if (waiting_look_ != nothing_ && waiting_look_ != look &&
            apart_px(strand_.points.back(), waiting_) > 1e-6 &&
            apart_px(strand_.points.back(), point) >= min_piece_px) {
            take();
        }
        waiting_look_ = std::max(waiting_look_, look);
        waiting_ = point;
        if (apart_px(strand_.points.back(), point) >= min_piece_px) {
            take();
        }
    }

    Polyline finished() && {
        // The remainder is too short to see but closes the gap to the next road.
        if (waiting_look_ != nothing_ && apart_px(strand_.points.back(), waiting_) > 1e-6) {
            take();
        }
        return std::move(strand_);
    }

private:
    void take() {
        if (goes_straight_on()) {
            passed_.push_back(strand_.points.back());
            strand_.points.back() = waiting_;
        } else {
            passed_.clear();
            strand_.points.push_back(waiting_);
            strand_.looks.push_back(waiting_look_);
        }
        waiting_look_ = nothing_;
    }

    bool goes_straight_on() const {
        if (strand_.looks.empty() || strand_.looks.back() != waiting_look_ ||
            passed_.size() >= max_passed) {
            return false;
        }
        const auto& start = strand_.points[strand_.points.size() - 2];
        const auto lies_between = [&](const PixelPoint& point) {
            return between(start, waiting_, point);
        };
        return lies_between(strand_.points.back()) && std::ranges::all_of(passed_, lies_between);
    }

    static constexpr int nothing_ = -100;
    Polyline strand_;
    PixelPoint waiting_;
    int waiting_look_ = nothing_;
    std::vector<PixelPoint> passed_; // points skipped by the last line segment
};

} // namespace

int line_look(const MapLine& line) {
    if (line.iri_class < 0) {
        return unmeasured_look;
    }
    return line.few_passes ? few_passes_look : look_of(line.iri_class, line.certain);
}

Polyline strand_of(std::span<const MapLine> lines,
                   const std::vector<LineUse>& chain,
                   const MapFrame& frame) {
    Growing strand{lines[chain.front().line].rank};
    bool begun = false;
    for (const auto& [index, reversed] : chain) {
        const auto& line = lines[index];
        const int look = line_look(line);
        for (std::size_t i = 0; i < line.line.size(); ++i) {
            const auto& place = line.line[reversed ? line.line.size() - 1 - i : i];
            const auto point = to_pixel(frame, place);
            if (begun) {
                strand.go_on(point, look);
            } else {
                strand.begin(point);
                begun = true;
            }
        }
    }
    return std::move(strand).finished();
}

} // namespace macadam
