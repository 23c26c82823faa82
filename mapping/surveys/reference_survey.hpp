#pragma once

#include "mapping/surveys/survey_row.hpp"

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace macadam {

/// A part of a way: from_m < to_m along it from its first node.
struct WayPart {
    std::int64_t way_id;
    bool forward; ///< the direction that is meant
    double from_m;
    double to_m;
    friend bool operator==(const WayPart&, const WayPart&) = default;
};

/// How rows of a reference survey say where they are.
enum class ReferencePlaces : std::uint8_t {
    on_ways, ///< each by the part of a way
    ends,    ///< each by its begin and end
    middles  ///< each by its middle, and with a heading or in the order in which it was driven
};

/// A row of a survey that is to enter a store. What it has of `way`, `begin`, `end` and `heading`
/// depends on ReferencePlaces; a row without its place has none.
struct ReferenceRow {
    SurveyRow values; ///< `at` and `length_m` for middles
    bool placed = true;
    std::optional<WayPart> way{};
    std::optional<GeoPoint> begin{};
    std::optional<GeoPoint> end{};
    std::optional<double> heading_deg{}; ///< clockwise from north; for middles, then length_m too
};

struct ReferenceSurvey {
    ReferencePlaces places;
    std::vector<ReferenceRow> rows;
    std::string sha256; ///< of the file's decompressed text
};

/// The IRI that a row states as its headline, mm/m: the mean of both tracks, or what stands for it.
struct ReferenceIri {
    double mm_per_m;
    bool from_hri; ///< inferred: MRI = HRI / hri_over_mri
};

/// MRI; failing that the mean of left and right, then an IRI of a kind that is not told, which
/// surveys mean for MRI, then HRI. Nothing: the row has none of them, or one track alone.
std::optional<ReferenceIri> headline_of(const SurveyRow& row);

} // namespace macadam
