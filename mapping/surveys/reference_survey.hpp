#pragma once

#include "mapping/surveys/survey_row.hpp"

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace macadam {

/// An interval of a way: from_m < to_m along it from its first node.
struct WayPart {
    std::int64_t way_id;
    bool forward; ///< direction of the interval
    double from_m;
    double to_m;
    friend bool operator==(const WayPart&, const WayPart&) = default;
};

/// Location method of the rows of a reference survey.
enum class ReferenceLocation : std::uint8_t {
    on_ways, ///< interval of a way
    ends,    ///< start and end coordinates
    middles  ///< midpoint coordinates, with a heading or in driving order
};

/// A survey row to be imported into a database. Whether `way`, `begin`, `end` and `heading` are set
/// depends on ReferenceLocation; a row without a position has none of them.
struct ReferenceRow {
    SurveyRow values; ///< `at` and `length_m` for midpoints
    bool placed = true;
    std::optional<WayPart> way{};
    std::optional<GeoPoint> begin{};
    std::optional<GeoPoint> end{};
    std::optional<double>
        heading_deg{}; ///< clockwise from north; for midpoints, which then have length_m too
};

struct ReferenceSurvey {
    ReferenceLocation places;
    std::vector<ReferenceRow> rows;
    std::string sha256; ///< of the file's decompressed text
};

/// Headline IRI of a row, mm/m: the mean of both tracks, or its substitute.
struct ReferenceIri {
    double mm_per_m;
    bool from_hri; ///< inferred: MRI = HRI / hri_over_mri
};

/// Selects the headline of a row: MRI; otherwise the mean of left and right, then an IRI of
/// unspecified kind, which usually means MRI, then HRI. `std::nullopt` if the row has none of them,
/// or one track alone.
std::optional<ReferenceIri> headline_of(const SurveyRow& row);

} // namespace macadam
