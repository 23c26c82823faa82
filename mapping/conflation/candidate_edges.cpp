#include "mapping/conflation/candidate_edges.hpp"

#include "estimator/common/angle.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>

namespace macadam {
namespace {

constexpr std::size_t max_places = 8;

struct Vector {
    double east_m;
    double north_m;
};

Vector operator-(const PointEn& a, const PointEn& b) {
    return {a.east_m - b.east_m, a.north_m - b.north_m};
}

double dot(const Vector& a, const Vector& b) {
    return a.east_m * b.east_m + a.north_m * b.north_m;
}

/// A local plane for a few hundred metres around a position.
class SmallPlane {
public:
    explicit SmallPlane(const GeoPoint& origin)
        : origin_{origin}, east_m_per_deg_{distance_m(origin,
                                                      {origin.lat_deg, origin.lon_deg + step_deg})},
          north_m_per_deg_{distance_m(origin, {origin.lat_deg - step_deg, origin.lon_deg})} {
        east_m_per_deg_ /= step_deg;
        north_m_per_deg_ /= step_deg;
    }

    PointEn operator()(const GeoPoint& place) const {
        return {(place.lon_deg - origin_.lon_deg) * east_m_per_deg_,
                (place.lat_deg - origin_.lat_deg) * north_m_per_deg_};
    }

private:
    static constexpr double step_deg = 0.001;
    GeoPoint origin_;
    double east_m_per_deg_;
    double north_m_per_deg_;
};

/// A step between two points of a way's line.
struct LineStep {
    std::uint32_t link;
    PointEn from;
    Vector step;
    double squared_m2;
    double along_m; ///< of its start, along the way
    double length_m;
};

GeoBox box_around(std::span<const RoadSample> samples, double margin_m) {
    GeoBox box;
    for (const auto& sample : samples) {
        box = including(box, sample.at);
    }
    return grown(box, margin_m);
}

bool meets(const GeoBox& box, const GeoPoint& a, const GeoPoint& b) {
    return std::min(a.lat_deg, b.lat_deg) <= box.north_deg &&
           std::max(a.lat_deg, b.lat_deg) >= box.south_deg &&
           std::min(a.lon_deg, b.lon_deg) <= box.east_deg &&
           std::max(a.lon_deg, b.lon_deg) >= box.west_deg;
}

std::vector<LineStep> steps_in(const RoadNetwork& roads,
                               const std::vector<bool>& left_out,
                               const GeoBox& box,
                               const SmallPlane& plane) {
    std::vector<LineStep> steps;
    for (const auto number : links_near(roads, box)) {
        const auto link = link_at(roads, number);
        if (left_out[link.way]) {
            continue;
        }
        const auto way = way_at(roads, link.way);
        for (auto i = link.first_point; i < link.last_point; ++i) {
            const double length_m = way.along_m[i + 1] - way.along_m[i];
            if (length_m > 0 && meets(box, way.line[i], way.line[i + 1])) {
                const auto from = plane(way.line[i]);
                const auto step = plane(way.line[i + 1]) - from;
                steps.push_back({static_cast<std::uint32_t>(number),
                                 from,
                                 step,
                                 dot(step, step),
                                 way.along_m[i],
                                 length_m});
            }
        }
    }
    return steps;
}

/// A sample in the plane with its courses: through it, up to it and from it.
struct ProjectedSample {
    PointEn at;
    std::array<Vector, 3> courses;
};

ProjectedSample placed(const RoadSample& sample, const SmallPlane& plane) {
    const auto behind = plane(sample.behind);
    const auto at = plane(sample.at);
    const auto ahead = plane(sample.ahead);
    return {at, {ahead - behind, at - behind, ahead - at}};
}

bool run_alike(const Vector& a, const Vector& b, double min_cosine) {
    const double product = dot(a, b);
    return product > 0 && product * product >= min_cosine * min_cosine * dot(a, a) * dot(b, b);
}

/// Directions of a step that match one of the sample's courses.
struct Runs {
    bool forward;
    bool backward;
};

Runs runs_of(const ProjectedSample& sample, const LineStep& step, double min_cosine) {
    const Vector back{-step.step.east_m, -step.step.north_m};
    Runs runs{false, false};
    for (const auto& course : sample.courses) {
        runs.forward = runs.forward || run_alike(course, step.step, min_cosine);
        runs.backward = runs.backward || run_alike(course, back, min_cosine);
    }
    return runs;
}

/// Compares courses by chords, for bends with few points in one of the networks.
Runs runs_around(const ProjectedSample& sample, const Vector& chord, double min_cosine) {
    const auto& course = sample.courses[0];
    return {run_alike(course, chord, min_cosine),
            run_alike(course, {-chord.east_m, -chord.north_m}, min_cosine)};
}

/// Adds a position, keeping only the nearest per edge.
void take(std::vector<EdgeCandidate>& places, const EdgeCandidate& place) {
    const auto same = std::ranges::find(places, place.edge, &EdgeCandidate::edge);
    if (same == places.end()) {
        places.push_back(place);
    } else if (place.across_m < same->across_m) {
        *same = place;
    }
}

/// Foot of the perpendicular from a sample to a step.
struct Foot {
    double along_m; ///< along the way
    double across_m;
};

Foot foot_on(const LineStep& step, const PointEn& at) {
    const auto to_sample = at - step.from;
    const double share = std::clamp(dot(to_sample, step.step) / step.squared_m2, 0.0, 1.0);
    return {step.along_m + share * step.length_m,
            std::hypot(to_sample.east_m - share * step.step.east_m,
                       to_sample.north_m - share * step.step.north_m)};
}

std::vector<EdgeCandidate> nearest_first(std::vector<EdgeCandidate> places) {
    std::ranges::sort(places, {}, [](const EdgeCandidate& place) {
        return std::tuple{place.across_m, place.edge};
    });
    places.resize(std::min(places.size(), max_places));
    return places;
}

} // namespace

GeoPoint place_along(const WayView& way, double along_m) {
    const auto next =
        std::ranges::upper_bound(way.along_m.begin() + 1, way.along_m.end() - 1, along_m);
    const auto i = static_cast<std::size_t>(next - way.along_m.begin());
    const double step_m = way.along_m[i] - way.along_m[i - 1];
    const double share = step_m > 0 ? (along_m - way.along_m[i - 1]) / step_m : 0.0;
    return between(way.line[i - 1], way.line[i], std::clamp(share, 0.0, 1.0));
}

CandidateEdges::CandidateEdges(const RoadNetwork& roads,
                               const std::vector<bool>& left_out,
                               const ChangeConfig& config)
    : roads_{&roads}, left_out_{&left_out}, config_{config},
      min_cosine_{std::cos(config.max_turned_deg * rad_per_deg)} {}

std::vector<std::vector<EdgeCandidate>>
CandidateEdges::around(std::span<const RoadSample> samples) const {
    const SmallPlane plane{samples.front().at};
    const auto steps =
        steps_in(*roads_, *left_out_, box_around(samples, config_.farthest_m), plane);
    std::vector<std::vector<EdgeCandidate>> around;
    around.reserve(samples.size());
    for (const auto& each : samples) {
        const auto sample = placed(each, plane);
        std::vector<EdgeCandidate> places;
        for (const auto& step : steps) {
            const auto foot = foot_on(step, sample.at);
            if (!(foot.across_m <= config_.farthest_m)) {
                continue;
            }
            const auto link = link_at(*roads_, LinkId{step.link});
            auto runs = runs_of(sample, step, min_cosine_);
            if (!runs.forward && !runs.backward) {
                const auto way = way_at(*roads_, link.way);
                runs = runs_around(sample,
                                   plane(place_along(way, foot.along_m + half_chord_m)) -
                                       plane(place_along(way, foot.along_m - half_chord_m)),
                                   min_cosine_);
            }
            if (runs.forward && link.forward) {
                take(places,
                     {edge_of(LinkId{step.link}, true), foot.along_m - link.from_m, foot.across_m});
            }
            if (runs.backward && link.backward) {
                take(places,
                     {edge_of(LinkId{step.link}, false), link.to_m - foot.along_m, foot.across_m});
            }
        }
        around.push_back(nearest_first(std::move(places)));
    }
    return around;
}

} // namespace macadam
