#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace macadam {

/// Trip of a database, without where it went.
struct StoredTrip {
    std::string sha256;  ///< of its content
    std::string vehicle; ///< pseudonym
    std::string vehicle_model;
    std::string method;
    std::optional<std::int64_t> start_ms; ///< ms since 1970 UTC
    std::int64_t driven_mm = 0;
    std::int64_t matched_mm = 0;
    std::int64_t passes = 0; ///< over segments
    std::int64_t rows_read = 0;
    std::int64_t rows_used = 0;
};

/// Reads all trips of cars, also those that are not published, latest import first. Takes time in
/// proportion to the passes.
/// \throws InputError  if the file cannot be read.
std::vector<StoredTrip> stored_trips(const std::filesystem::path& store);

} // namespace macadam
