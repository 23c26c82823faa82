#pragma once

#include "storage/trips/detection/log_detection.hpp"

#include <memory>
#include <string>

namespace macadam {

/// Mapping of what is at least as sure as `least`, as a file for --mapping. Remarks say how sure
/// each column is, and which are missing.
///
/// \param files  pattern of the names of such files, "*.csv".
std::string mapping_toml(const DetectedLog& log, Confidence least, const std::string& files);

/// Log and the pattern of the names of such files.
struct NamedLog {
    const DetectedLog& log;
    std::string files;
};

/// Mapping of two files that hold one trip, of what is at least likely; the second is its [[file]].
std::string mapping_toml(const NamedLog& first, const NamedLog& second);

/// Mapping of what is sure; null unless that serves `match` or `trace`.
///
/// \param has_positions  from another file; vertical acceleration then suffices
std::shared_ptr<const TripMapping> sure_mapping(const DetectedLog& log, bool has_positions = false);

/// Returns sure_mapping() for a file that was found rather than named: null also for results with a
/// column `iri`.
std::shared_ptr<const TripMapping> mapping_of_found(const std::optional<DetectedLog>& log,
                                                    bool has_positions = false);

/// Key of the meta data of a trip that was read by a detected mapping: its words.
inline constexpr const char* detected_key = "read_as";

} // namespace macadam
