#pragma once

#include "app/pipeline/pipeline.hpp"

#include <filesystem>
#include <vector>

namespace macadam {

/// Profile file that was written.
struct WrittenProfile {
    std::filesystem::path file;
    double from_m; ///< travel distance
    double to_m;
    bool tracks; ///< left and right; false: their mean only
};

/// Writes the estimated elevations of a trip as ERD files: left and right where both tracks were
/// observed, otherwise their mean. ERD has no gaps, so each gapless part of the trip gets its own
/// file, road.erd, road-2.erd, ..., with the travel as station. Parts that are all lead-in get
/// none.
///
/// \param trace        from a pipeline with EstimatorConfig::profile set
/// \throws InputError  if there is no profile to write, or a file cannot be written.
std::vector<WrittenProfile> write_profiles(const std::filesystem::path& file,
                                           const TripTrace& trace,
                                           const Vehicle& vehicle,
                                           Method method);

} // namespace macadam
