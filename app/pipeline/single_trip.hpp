#pragma once

#include "estimator/common/error.hpp"
#include "estimator/common/trip.hpp"
#include "storage/trips/trip_reader.hpp"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace macadam {

/// The one trip of a path: a log, a phone's export or, with a mapping, a foreign file.
///
/// \throws InputError  if it is a folder of logs, or holds several.
TripSource one_trip(const std::filesystem::path& path,
                    const std::shared_ptr<const TripMapping>& mapping = nullptr);

/// What `work` returns; its refusals get the trip's name before them, for the engine knows no file.
template <typename Work>
auto with_trip_name(const std::string& trip, Work work) {
    try {
        return work();
    } catch (const InputError& error) {
        throw InputError{trip + ": " + error.what()};
    }
}

/// Where the car was at a time, straight between its fixes, their latency taken off.
class TripPositions {
public:
    explicit TripPositions(const TripLog& trip);

    /// Nothing before the first and after the last fix, and in silences of more than ten seconds.
    std::optional<GeoPoint> operator()(double t_s) const;

private:
    std::vector<double> t_s_;
    std::vector<GeoPoint> at_;
};

} // namespace macadam
