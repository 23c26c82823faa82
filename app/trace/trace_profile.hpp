#pragma once

#include "app/pipeline/pipeline.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace macadam {

/// A profile that was written, for those who look on.
struct WrittenProfile {
    std::filesystem::path file;
    double from_m; ///< travel
    double to_m;
    bool tracks; ///< left and right; false: their mean alone
};

/// Writes the estimated elevations of a trip as ERD files: left and right where both tracks were
/// observed, else their mean. ERD knows no gaps, so every part of the trip without one gets a file
/// of its own, road.erd, road-2.erd, ..., in which the station is the travel. Parts that are all
/// lead-in get none.
///
/// \param trace  of a pipeline whose EstimatorConfig::profile was set
/// \throws InputError  if there is nothing to write, or a file cannot be written.
std::vector<WrittenProfile> write_profiles(const std::filesystem::path& file,
                                           const TripTrace& trace,
                                           const Vehicle& vehicle,
                                           Method method);

} // namespace macadam
