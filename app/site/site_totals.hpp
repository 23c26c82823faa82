#pragma once

#include "mapping/fusion/segment_record.hpp"
#include "mapping/style/iri_class.hpp"

#include <array>
#include <compare>
#include <map>
#include <string>
#include <vector>

namespace macadam {

/// Kilometres of measured road by class, highway, passes, confidence and IRI: the numbers that
/// legend and distribution of a site show for any filter, in a size that does not grow with the
/// network.
class SiteTotals {
public:
    explicit SiteTotals(const ClassTable& classes) : classes_{&classes} {}

    /// Adds a measured segment.
    void add(const SegmentRecord& record);

    /// OSM classes of the roads in alphabetical order, "" if some have none.
    std::vector<std::string> highways() const;

    double km() const;

    std::string json() const;

private:
    struct Cell {
        std::string highway;
        std::array<int, 4> numbers; ///< class, passes, confidence, bin
        friend auto operator<=>(const Cell&, const Cell&) = default;
    };
    const ClassTable* classes_;
    std::map<Cell, double> length_m_;
};

} // namespace macadam
