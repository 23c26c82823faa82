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
    double along_m; ///< from the link's beginning, in its way's own direction
};

/// The place of a link that is nearest to a position.
struct NearPlace {
    LinkId link;
    double along_m;
    double distance_m;
    double course_rad; ///< of the line there, in its way's own direction
    double right_m;    ///< the position lies so far right of the line, however far it goes on
};

/// The roads near one trip, in its plane. Links are projected when first asked for, each once.
class CandidateIndex {
public:
    CandidateIndex(const RoadNetwork& roads, const LocalFrame& frame)
        : roads_{roads}, frame_{frame} {}

    std::span<const LinePoint> line(LinkId link);

    /// Places within `radius_m` of a position, nearest first. A link that comes near twice, as a
    /// hairpin does, gives a place each time.
    std::vector<NearPlace> near(const PointEn& at, const GeoPoint& place, double radius_m);

    /// The place of a link that is nearest to a position.
    NearPlace nearest(LinkId link, const PointEn& at);

private:
    struct Drawn {
        std::uint32_t first; ///< in points_
        std::uint32_t count;
        PointEn low; ///< corners of the line's box
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

    std::vector<Nearby> nearby_; ///< links around nearby_at_, for the next positions too
    PointEn nearby_at_{};
    double nearby_radius_m_ = -1;
};

} // namespace macadam
