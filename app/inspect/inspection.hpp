#pragma once

#include "app/inspect/file_kind.hpp"
#include "app/inspect/trip_summary.hpp"
#include "estimator/common/progress.hpp"
#include "storage/trips/detection/detected_mapping.hpp"
#include "storage/trips/source/trip_source.hpp"

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace macadam {

/// Result of inspecting one file or trip.
struct Inspection {
    std::string name{}; ///< of the file, or of the trip within a folder or archive
    FileKind kind{};
    std::optional<DetectedLog> detected{}; ///< of the log of another program
    bool has_positions = false;            ///< of another file
    std::string mapping{};                 ///< of that log, as TOML
    std::optional<TripSummary> trip{};     ///< `std::nullopt`: not a trip, or not readable as one
    std::string error{};                   ///< reason why it cannot be read; "" if it can

    /// Tests for a log of another program of which at least a column was recognised.
    bool finds_columns() const {
        return detected && !mapping.empty() && (detected->time || !detected->channels.empty());
    }

    /// Tests whether 'import' would read it without a mapping.
    bool is_sure() const { return detected && sure_mapping(*detected, has_positions) != nullptr; }
};

/// Inspects a path: a file, or all trips and other files of a folder or an archive.
///
/// CSV files in an archive are inspected if it holds no other trips.
///
/// \param mapping  of the trips of the path; null: found out
/// \param search  of the search for trips in a folder; its stop token ends the inspection.
/// \param tell    called for each of them; errors are part of the result.
void inspect(const std::filesystem::path& path,
             const std::shared_ptr<const TripMapping>& mapping,
             std::size_t max_files,
             const Progress& search,
             const std::function<void(const Inspection&)>& tell);

} // namespace macadam
