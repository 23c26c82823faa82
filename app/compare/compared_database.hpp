#pragma once

#include "mapping/comparison/method_agreement.hpp"
#include "storage/store/reader/store_reader.hpp"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace macadam {

/// Value of one segment by one source.
struct SourceSegment {
    double iri; ///< mm/m
    double
        from_m; ///< along the way; both NaN for a survey, which is placed on the other's segments
    double to_m;
    std::string highway; ///< OSM's class, "" if the source does not know it
};

using SourceSegments = std::map<SegmentKey, SourceSegment>;

/// Reads the IRI of all segments, from cars alone: surveys in the database do not count. Of a crowd
/// database that is its latest publication.
///
/// \param filter  conditions of the command line.
SourceSegments segments_by_cars(const StoreReader& store, SegmentFilter filter);

/// Reads the IRI of all segments by one car: the mean of its passes, weighted by the inverse of
/// their variances, as imported: neither aligned nor calibrated.
///
/// \param car  its pseudonym (car_named).
SourceSegments
segments_by_car(const StoreReader& store, const SegmentFilter& filter, const std::string& car);

/// Passes of cars over compared segments, by car and speed.
struct PassesOfCars {
    std::vector<std::optional<double>> speed_kmh; ///< mean over all passes, for each pair
    /// IRI of each car, for each pair; without calibration.
    std::vector<std::map<std::string, double>> iri_by_car;
};

/// Selection of passes.
struct PassesOfInterest {
    std::optional<Period> period; ///< only dated passes within it, as for SegmentFilter
    std::string car;              ///< only of the car with this pseudonym; "" = all cars
};

/// Reads the chosen passes over the segments of the pairs. `std::nullopt` for a crowd database:
/// single cars and speeds are not published.
std::optional<PassesOfCars> passes_of_cars(const StoreReader& store,
                                           const std::vector<AgreementPair>& pairs,
                                           const PassesOfInterest& of);

} // namespace macadam
