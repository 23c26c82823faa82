#pragma once

#include "mapping/analysis/worst_sections.hpp"
#include "mapping/fusion/segment_record.hpp"
#include "mapping/style/iri_class.hpp"
#include "render/report/words/messages.hpp"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace macadam {

// JSON of a site (docs/reference/site.md), the same from a folder and from a server.

/// State of a segment from the passes of one month.
struct SegmentMonth {
    std::string month; ///< "2026-03"
    SegmentState state;
};

/// Formats a measured segment with its months.
std::string segment_json(const SegmentRecord& record,
                         const ClassTable& classes,
                         std::span<const SegmentMonth> months);

/// Formats the worst sections, roughest first.
/// \param records  those from which the sections were made
std::string worst_json(std::span<const WorstSection> sections,
                       std::span<const SegmentRecord> records);

/// Formats the messages of a language that the page uses.
std::string words_json(const Language& language);

/// Formats a box as [west, south, east, north].
std::string box_json(const GeoBox& box);

/// Returns the box around a line; the empty box for no point.
GeoBox box_around(std::span<const GeoPoint> line);

/// Returns the box around both.
GeoBox joined_box(const GeoBox& a, const GeoBox& b);

} // namespace macadam
