#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

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
