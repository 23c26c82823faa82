#pragma once

#include "mapping/geometry/local_frame.hpp"
#include "mapping/network/road_network.hpp"

#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

namespace macadam {

/// A point of a link's line in the plane.
struct LinePoint {
    PointEn at;
    double along_m; ///< from the start of the link, in its way's own direction
};

/// The point of a link nearest to a position.
struct NearestPoint {
    LinkId link;
    double along_m;
    double distance_m;
    double course_rad; ///< of the line at that point, in its way's own direction
    double right_m;    ///< signed distance of the position to the right of the line extended
};

/// Spatial index of the roads near one trip, in its plane. Each link is projected once, on first
/// use.
class CandidateIndex {
public:
    CandidateIndex(const RoadNetwork& roads, const LocalFrame& frame)
        : roads_{roads}, frame_{frame} {}

    std::span<const LinePoint> line(LinkId link);

    /// Finds the points within `radius_m` of a position, nearest first. A link that approaches
    /// twice, as a hairpin does, yields two.
    std::vector<NearestPoint> near(const PointEn& at, const GeoPoint& place, double radius_m);

    /// Finds the point of a link nearest to a position.
    NearestPoint nearest(LinkId link, const PointEn& at);

private:
    struct Drawn {
        std::uint32_t first; ///< index into points_
        std::uint32_t count;
        PointEn low; ///< bounding box of the line
        PointEn high;
    };
    struct Nearby {
        LinkId link;
        Drawn drawn;
    };

    Drawn drawn(LinkId link);
    void look_around(const PointEn& at, const GeoPoint& place, double radius_m);

    const RoadNetwork& roads_;
    LocalFrame frame_;
    std::vector<LinePoint> points_;
    std::unordered_map<std::uint32_t, Drawn> drawn_; ///< by LinkId

    std::vector<Nearby> nearby_; ///< links around nearby_at_, cached for the next positions
    PointEn nearby_at_{};
    double nearby_radius_m_ = -1;
};

} // namespace macadam
