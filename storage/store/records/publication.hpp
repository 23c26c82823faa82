#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace macadam {

/// Audience for which a database is read.
enum class Audience {
    anyone,    ///< only the latest publication of a crowd database
    operator_, ///< everything, if the key lies beside the database; a database of own cars needs no
               ///< key
};

/// Totals of a publication of a crowd database, and of the data that it omits.
struct Publication {
    std::int64_t number = 0;
    std::string month;         ///< of the publication, "2026-11"
    std::size_t segments = 0;  ///< published
    double km = 0;             ///< of the published segments
    std::size_t left_out = 0;  ///< segments with passes that are not published, rounded to tens
    double left_out_km = 0;    ///< of those, rounded to tenths
    std::int32_t trips = 0;    ///< lower bound, rounded by published_count()
    std::int32_t vehicles = 0; ///< likewise
    friend bool operator==(const Publication&, const Publication&) = default;
};

/// Number and length of segments.
struct PublishedTotal {
    std::int64_t segments = 0;
    std::int64_t length_um = 0;
};

/// Part of a database from which its next publication is made, and what the rest adds to its
/// totals.
struct PublishedPart {
    std::vector<std::int64_t> chunks{}; ///< that may change, ascending
    std::int64_t last_segment = 0;      ///< row of the last segment of all
    std::int64_t trips = 0;             ///< of cars, in all
    std::int64_t cars = 0;              ///< in all
    PublishedTotal shown_elsewhere{};   ///< published segments of other chunks
    PublishedTotal left_elsewhere{};    ///< driven ones of other chunks that are not published
};

/// Data removed when a database of own cars became a crowd database.
struct CrowdMade {
    std::size_t trips = 0;          ///< trimmed
    std::size_t passes = 0;         ///< removed
    std::size_t trimmed_before = 0; ///< trips that their recorders had trimmed, left as they are
    bool log_is_clean =
        true; ///< false: the WAL still holds the removed data, because others are reading
};

/// Result of making a publication.
struct Published {
    Publication publication;
    std::size_t changed = 0; ///< segments that are new in it or have more passes
};

} // namespace macadam
