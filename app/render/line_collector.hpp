#pragma once

#include "mapping/fusion/segment_record.hpp"
#include "mapping/style/iri_class.hpp"
#include "render/scene/scene.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace macadam {

/// Joining of segments to lines as a map is loaded. At small scales a segment is a dot: a network
/// of a million would take memory for what nobody sees.
struct LineJoining {
    /// Segments of a way that become one line, where they look alike but for their class: the class
    /// is that of their mean IRI. 1: none are joined.
    std::uint32_t segments = 1;
    const ClassTable* classes = nullptr; ///< of the lines; null: only equal classes are joined
    double tolerance_m = 0;              ///< of joined lines, of which bends are left out
};

/// Returns the joining at a map's scale: a line stays below half the length of the shortest change
/// of class that the map shows, and deviates by less than a twentieth of a millimetre.
LineJoining
joining_at(double scale_denominator, double segment_length_m, const ClassTable& classes);

/// Collects the lines of a map, segment by segment.
class LineCollector {
public:
    explicit LineCollector(const LineJoining& joining) : joining_{joining} {}

    /// Adds the line of a segment. Segments come in key order.
    void add(const Segment& segment, MapLine line);

    /// Returns the lines, and marks the roads that have both directions. A road driven one way only
    /// is still two-way if the map allows both.
    std::vector<MapLine> finished() &&;

private:
    /// Origin of a line.
    struct Origin {
        std::int64_t way_id;
        std::uint32_t group; ///< of `joining_.segments` segments of the way
        std::size_t line;
    };

    bool continues(const Origin& origin, const MapLine& line) const;
    void join(double length_m, MapLine line);
    void close();

    LineJoining joining_;
    std::vector<MapLine> lines_;
    std::vector<Origin> origins_; ///< of each line
    double length_m_ = 0;         ///< of the last line
    double certain_m_ = 0;        ///< of it, with a narrow interval
};

} // namespace macadam
