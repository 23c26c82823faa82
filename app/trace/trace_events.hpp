#pragma once

#include "app/pipeline/pipeline.hpp"
#include "app/pipeline/single_trip.hpp"

#include <cstddef>
#include <filesystem>

namespace macadam {

/// Writes the potholes, bumps, joints and rails of a trip in order of travel: a line of CSV each, a
/// JSON array of objects, or points of GeoJSON, as the name of the file ends in .csv, .json or
/// .geojson. GeoJSON leaves out events without a position.
///
/// \param trace        from a pipeline with EstimatorConfig::profile set, by the smoother
/// \param ahead_m      distance of the antenna ahead of the centre of gravity
/// \returns            number of events in the trip
/// \throws InputError  if the trip has no elevations, or the file cannot be written.
std::size_t write_events(const std::filesystem::path& file,
                         const TripTrace& trace,
                         const TripPositions& place,
                         double ahead_m);

} // namespace macadam
