#pragma once

#include "storage/store/server/server_tables.hpp"

#include <array>
#include <span>

namespace macadam {
namespace server_columns {

// Of publications of a crowd, named as in a file.

inline constexpr std::array publication{
    ServerColumn{"number", "bigint NOT NULL", "From 1"},
    ServerColumn{"month", "text NOT NULL UNIQUE", "In which it was made: 2026-11"},
    ServerColumn{"last_trip", "bigint NOT NULL", "Row of the last trip at that time"},
    ServerColumn{"last_segment", "bigint NOT NULL", "Row of the last segment at that time"},
    ServerColumn{"segments", "bigint NOT NULL", "Published segments"},
    ServerColumn{"length_m", "double precision NOT NULL", "Their length, m"},
    ServerColumn{"left_segments", "bigint NOT NULL", "Segments of too few cars, rounded up"},
    ServerColumn{"left_m", "double precision NOT NULL", "Their length, rounded up, m"},
    ServerColumn{"trips", "bigint NOT NULL", "Trips, rounded down"},
    ServerColumn{"cars", "bigint NOT NULL", "Cars, rounded down"}};

inline constexpr std::array published_state{
    ServerColumn{"fid", "bigint NOT NULL", "Row of the segment"},
    ServerColumn{"iri", "double precision NOT NULL", "IRI, mm/m"},
    ServerColumn{"iri_sd", "double precision NOT NULL", "Its standard uncertainty, mm/m"},
    ServerColumn{"iri_low", "double precision NOT NULL", "Lower end of its 90 % interval, mm/m"},
    ServerColumn{"iri_high", "double precision NOT NULL", "Upper end, mm/m"},
    ServerColumn{"iri_left", "double precision", "IRI of the left track, mm/m"},
    ServerColumn{"iri_right", "double precision", "IRI of the right track, mm/m"},
    ServerColumn{"index", "text NOT NULL", "MRI, or HRI>MRI if it was estimated from HRI"},
    ServerColumn{"class", "text NOT NULL", "Roughness class"},
    ServerColumn{"passes", "bigint NOT NULL", "Passes, rounded down"},
    ServerColumn{"vehicles", "bigint NOT NULL", "Cars, rounded down"},
    ServerColumn{"first_seen", "text", "First month, as its first day"},
    ServerColumn{"last_seen", "text", "Last month, as its first day"},
    ServerColumn{"trend_per_year", "double precision", "Change of the IRI, mm/m a year"},
    ServerColumn{"trend_sd", "double precision", "Its standard uncertainty"},
    ServerColumn{"changed", "text", "Month of a step of the road, as its first day"},
    ServerColumn{"change", "double precision", "Level after it minus level before, mm/m"},
    ServerColumn{"validity", "text NOT NULL", "What limits the value, in words"},
    ServerColumn{"first_seen_ms", "bigint", "First month, ms since 1970 UTC"},
    ServerColumn{"last_seen_ms", "bigint", "Last month, ms since 1970 UTC"},
    ServerColumn{"changed_ms", "bigint", "Month of the step, ms since 1970 UTC"},
    ServerColumn{"flags",
                 "bigint NOT NULL",
                 "Sum of 1 too slow, 2 start-up, 4 gap, 8 indicative, 16 lateral vibration alone"}};

inline constexpr std::array published_until{
    ServerColumn{"segment", "bigint NOT NULL", "Row of the segment"},
    ServerColumn{"last_trip",
                 "bigint NOT NULL",
                 "Passes of trips up to this row are published, but for published_pending"}};

inline constexpr std::array published_pending{
    ServerColumn{"segment", "bigint NOT NULL", "Row of the segment"},
    ServerColumn{"trip", "bigint NOT NULL REFERENCES macadam.trip", "Trip"},
    ServerColumn{"occurrence", "bigint NOT NULL", "Of the pass, which waits for four other cars"}};

inline constexpr std::array published_figure{
    ServerColumn{"segment", "bigint NOT NULL", "Row of the segment"},
    ServerColumn{"number", "bigint NOT NULL", "Of its batches of passes, from 1"},
    ServerColumn{"publication",
                 "bigint NOT NULL REFERENCES macadam.publication DEFERRABLE INITIALLY DEFERRED",
                 "In which it was published"},
    ServerColumn{"from_ms", "bigint", "First month, ms since 1970 UTC"},
    ServerColumn{"until_ms", "bigint", "End of the last month, ms since 1970 UTC"},
    ServerColumn{"iri_um", "bigint NOT NULL", "IRI, um/m"},
    ServerColumn{"sd_um", "bigint NOT NULL", "Its standard uncertainty, um/m"},
    ServerColumn{"low_um", "bigint NOT NULL", "Lower end of its 90 % interval, um/m"},
    ServerColumn{"high_um", "bigint NOT NULL", "Upper end, um/m"},
    ServerColumn{"left_um", "bigint", "IRI of the left track, um/m"},
    ServerColumn{"right_um", "bigint", "IRI of the right track, um/m"},
    ServerColumn{"centre_only", "bigint NOT NULL", "1: MRI was estimated from HRI"},
    ServerColumn{"flags", "bigint NOT NULL", "As in published_state"},
    ServerColumn{"passes", "bigint NOT NULL", "Passes, rounded down"},
    ServerColumn{"vehicles", "bigint NOT NULL", "Cars, rounded down"}};

inline constexpr std::array published_event{
    ServerColumn{"segment", "bigint NOT NULL", "Row of the segment"},
    ServerColumn{"number", "bigint NOT NULL", "In its chunk, from 0"},
    ServerColumn{"kind", "bigint NOT NULL", "0 pothole, 1 bump, 2 joint, 3 rail"},
    ServerColumn{"track", "bigint NOT NULL", "0 unknown, 1 left, 2 right, 3 both"},
    ServerColumn{"at_mm", "bigint NOT NULL", "Along the way from its first node, mm"},
    ServerColumn{"place_sd_mm", "bigint NOT NULL", "Uncertainty of at_mm, mm"},
    ServerColumn{"size_um", "bigint NOT NULL", "Depth or height, um"},
    ServerColumn{"sd_um", "bigint NOT NULL", "Uncertainty of size_um, um"},
    ServerColumn{"length_mm", "bigint NOT NULL", "Length, mm"},
    ServerColumn{"passes", "bigint NOT NULL", "Passes that report it, rounded down"},
    ServerColumn{"passes_over", "bigint NOT NULL", "Passes over the place, rounded down"},
    ServerColumn{"vehicles", "bigint NOT NULL", "Cars that report it, rounded down"},
    ServerColumn{"first_seen_ms", "bigint", "First month, ms since 1970 UTC"},
    ServerColumn{"last_seen_ms", "bigint", "Last month, ms since 1970 UTC"}};

} // namespace server_columns

/// Table of migration 7.
consteval ServerTable published_table(const char* name,
                                      const char* meaning,
                                      std::span<const ServerColumn> columns,
                                      const char* constraints) {
    return {.name = name,
            .meaning = meaning,
            .use = ServerUse::trips,
            .columns = columns,
            .constraints = constraints,
            .file_table = name,
            .migration = 7};
}

/// Publications of a crowd. Readers' rights on them: reader_rights.hpp.
inline constexpr std::array published_tables{
    published_table("publication",
                    "Publications of a crowd",
                    server_columns::publication,
                    "PRIMARY KEY (number)"),
    published_table("published_state",
                    "Published values",
                    server_columns::published_state,
                    "PRIMARY KEY (fid)"),
    published_table("published_until",
                    "Which passes are published",
                    server_columns::published_until,
                    "PRIMARY KEY (segment)"),
    published_table("published_pending",
                    "Passes that wait for a publication, though later trips are published",
                    server_columns::published_pending,
                    "PRIMARY KEY (segment, trip, occurrence)"),
    published_table("published_figure",
                    "Published history: values of batches of five cars or more",
                    server_columns::published_figure,
                    "PRIMARY KEY (segment, number)"),
    published_table("published_event",
                    "Published potholes and other defects",
                    server_columns::published_event,
                    "PRIMARY KEY (segment, number)")};

} // namespace macadam
