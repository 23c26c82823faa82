#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace macadam {

/// Who reads a database.
enum class Reader {
    anyone,    ///< of a crowd only what its latest publication tells
    operator_, ///< all, if the key lies beside the database; of one's own cars anyone does
};

/// What a publication of a crowd tells in all, and what it leaves out.
struct Publication {
    std::int64_t number = 0;
    std::string month;         ///< in which it was made, "2026-11"
    std::size_t segments = 0;  ///< that it shows
    double km = 0;             ///< of them
    std::size_t left_out = 0;  ///< segments with passes that it does not show, up to tens
    double left_out_km = 0;    ///< of them, up to tenths
    std::int32_t trips = 0;    ///< at least so many, as told_count() has it
    std::int32_t vehicles = 0; ///< likewise
};

/// What was taken out when a database of one's own cars became a crowd's.
struct CrowdMade {
    std::size_t trips = 0;
    std::size_t passes = 0;   ///< taken out
    bool log_is_clean = true; ///< false: others read the store, and its log still holds them
};

/// What making a publication did.
struct Published {
    Publication publication;
    std::size_t changed = 0; ///< segments that are new in it or tell of more passes
};

} // namespace macadam
