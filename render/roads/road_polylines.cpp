#include "render/roads/road_polylines.hpp"

#include "estimator/common/error.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

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
    Growing(int rank, std::size_t max_points) {
        polyline_.rank = rank;
        polyline_.points.reserve(max_points);
        polyline_.looks.reserve(max_points);
    }

    void begin(const PixelPoint& point) { polyline_.points.push_back(point); }

    void go_on(const PixelPoint& point, int look) {
        // An invisibly short line segment must not pass its look to a long one after it.
        if (waiting_look_ != nothing_ && waiting_look_ != look &&
            apart_px(polyline_.points.back(), waiting_) > 1e-6 &&
            apart_px(polyline_.points.back(), point) >= min_piece_px) {
            take();
        }
        waiting_look_ = std::max(waiting_look_, look);
        waiting_ = point;
        if (apart_px(polyline_.points.back(), point) >= min_piece_px) {
            take();
        }
    }

    Polyline finished() && {
        // The remainder is too short to see but closes the gap to the next road.
        if (waiting_look_ != nothing_ && apart_px(polyline_.points.back(), waiting_) > 1e-6) {
            take();
        }
        return std::move(polyline_);
    }

private:
    void take() {
        if (goes_straight_on()) {
            passed_.push_back(polyline_.points.back());
            polyline_.points.back() = waiting_;
        } else {
            passed_.clear();
            polyline_.points.push_back(waiting_);
            polyline_.looks.push_back(waiting_look_);
        }
        waiting_look_ = nothing_;
    }

    bool goes_straight_on() const {
        if (polyline_.looks.empty() || polyline_.looks.back() != waiting_look_ ||
            passed_.size() >= max_passed) {
            return false;
        }
        const auto& start = polyline_.points[polyline_.points.size() - 2];
        const auto lies_between = [&](const PixelPoint& point) {
            return between(start, waiting_, point);
        };
        return lies_between(polyline_.points.back()) && std::ranges::all_of(passed_, lies_between);
    }

    static constexpr int nothing_ = -100;
    Polyline polyline_;
    PixelPoint waiting_;
    int waiting_look_ = nothing_;
    std::vector<PixelPoint> passed_; // points skipped by the last line segment
};

/// Makes one line segment of the last two if the last is invisibly short; a joint with it would not
/// fit.
Polyline without_short_end(Polyline polyline) {
    auto& [points, looks, rank, first, past] = polyline;
    if (looks.size() > 1 && apart_px(points.back(), points[points.size() - 2]) < min_piece_px) {
        points.erase(points.end() - 2);
        looks.pop_back();
    }
    return polyline;
}

/// Number of a neighbour's line segments that shape a joint: where a line is offset, the end of the
/// first depends on the second.
constexpr std::size_t context = 2;

/// Polyline of one line between the nearest line segments of its neighbours.
class InContext {
public:
    InContext(const std::vector<Polyline>& alone, const Neighbours& neighbours)
        : alone_{alone}, neighbours_{neighbours} {}

    Polyline at(std::size_t use) const {
        Polyline polyline{.points = {}, .looks = {}, .rank = alone_[use].rank};
        polyline.points.reserve(alone_[use].points.size() + 2 * context);
        polyline.looks.reserve(alone_[use].looks.size() + 2 * context);
        add_before(polyline, neighbours_.previous[use]);
        polyline.first = polyline.looks.size();
        const auto& own = alone_[use];
        polyline.points.insert(polyline.points.end(), own.points.begin(), own.points.end());
        polyline.looks.insert(polyline.looks.end(), own.looks.begin(), own.looks.end());
        polyline.past = polyline.looks.size();
        add_after(polyline, neighbours_.next[use]);
        return polyline;
    }

private:
    /// Adds the beginnings of the last line segments before a joint.
    void add_before(Polyline& polyline, std::size_t use) const {
        for (; use != no_neighbour && !alone_[use].looks.empty() && polyline.looks.size() < context;
             use = neighbours_.previous[use]) {
            const auto& [points, looks, rank, first, past] = alone_[use];
            for (auto i = looks.size(); i > 0 && polyline.looks.size() < context; --i) {
                polyline.points.insert(polyline.points.begin(), points[i - 1]);
                polyline.looks.insert(polyline.looks.begin(), looks[i - 1]);
            }
        }
    }

    /// Adds the ends of the first line segments after a joint.
    void add_after(Polyline& polyline, std::size_t use) const {
        const auto most = polyline.past + context;
        for (; use != no_neighbour && !alone_[use].looks.empty() && polyline.looks.size() < most;
             use = neighbours_.next[use]) {
            const auto& [points, looks, rank, first, past] = alone_[use];
            for (std::size_t i = 0; i < looks.size() && polyline.looks.size() < most; ++i) {
                polyline.points.push_back(points[i + 1]);
                polyline.looks.push_back(looks[i]);
            }
        }
    }

    const std::vector<Polyline>& alone_;
    const Neighbours& neighbours_;
};

} // namespace

int line_look(const MapLine& line) {
    if (line.iri_class < 0) {
        return unmeasured_look;
    }
    return line.few_passes ? few_passes_look : look_of(line.iri_class, line.certain);
}

Polyline polyline_of(std::span<const MapLine> lines,
                     const std::vector<LineUse>& chain,
                     const MapFrame& frame) {
    // Most points of a long chain are left out.
    constexpr std::size_t enough = 16;
    const auto& first = lines[chain.front().line];
    Growing polyline{first.rank, std::min(enough, first.line.size())};
    bool begun = false;
    for (const auto& [index, reversed] : chain) {
        const auto& line = lines[index];
        const int look = line_look(line);
        for (std::size_t i = 0; i < line.line.size(); ++i) {
            const auto& place = line.line[reversed ? line.line.size() - 1 - i : i];
            const auto point = to_pixel(frame, place);
            if (begun) {
                polyline.go_on(point, look);
            } else {
                polyline.begin(point);
                begun = true;
            }
        }
    }
    return std::move(polyline).finished();
}

std::vector<Polyline> joined_polylines(std::span<const MapLine> lines,
                                       const std::vector<LineUse>& uses,
                                       const MapFrame& frame) {
    std::vector<Polyline> polylines;
    for (const auto& chain : joined(lines, uses)) {
        auto polyline = polyline_of(lines, chain, frame);
        if (!polyline.looks.empty()) {
            polylines.push_back(std::move(polyline));
        }
    }
    return polylines;
}

std::vector<Polyline> separate_polylines(std::span<const MapLine> lines,
                                         const std::vector<LineUse>& uses,
                                         const MapFrame& frame) {
    std::vector<Polyline> alone;
    alone.reserve(uses.size());
    std::vector<LineUse> chain(1);
    for (const auto& use : uses) {
        chain.front() = use;
        alone.push_back(without_short_end(polyline_of(lines, chain, frame)));
    }
    const auto neighbours = neighbours_of(lines, uses);
    const InContext in_context{alone, neighbours};
    std::vector<Polyline> polylines;
    polylines.reserve(uses.size());
    for (std::size_t use = 0; use < uses.size(); ++use) {
        if (!alone[use].looks.empty()) {
            polylines.push_back(in_context.at(use));
        }
    }
    return polylines;
}

std::vector<Polyline> side_by_side(std::span<const MapLine> lines,
                                   const MapFrame& frame,
                                   const LineWidths& widths,
                                   bool left_hand_traffic,
                                   MakePolylines make) {
    std::vector<LineUse> alone;
    std::vector<LineUse> paired;
    for (const auto& use : all_lines(lines)) {
        const auto& line = lines[use.line];
        (line.both_ways && line.iri_class >= 0 ? paired : alone).push_back(use);
    }
    auto polylines = make(lines, alone, frame);
    const auto centred = make(lines, paired, frame);
    polylines.reserve(polylines.size() + centred.size());
    for (const auto& polyline : centred) {
        const double right_px = way_offset_px(widths, polyline.rank);
        polylines.push_back(beside(polyline, left_hand_traffic ? -right_px : right_px));
    }
    return polylines;
}

void check_classes(std::span<const MapLine> lines, const ClassTable& table) {
    if (table.classes.empty() || table.classes.size() > max_classes) {
        throw InputError{fmt::format("table '{}' has {} classes, expected 1 to {}",
                                     table.name,
                                     table.classes.size(),
                                     max_classes)};
    }
    const int last = int(table.classes.size()) - 1;
    for (const auto& line : lines) {
        if (line.iri_class < -1 || line.iri_class > last) {
            throw InputError{fmt::format("a line of class '{}', expected -1 to {} as in table '{}'",
                                         line.iri_class,
                                         last,
                                         table.name)};
        }
    }
}

} // namespace macadam
