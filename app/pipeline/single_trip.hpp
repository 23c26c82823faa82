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

/// Finds the only trip of a path: a log, a phone's export or, with a mapping, a foreign file.
///
/// \param positions  file with its positions; empty: its own, or beside it
/// \throws InputError  if it is a folder of logs, or holds several.
TripSource one_trip(const std::filesystem::path& path,
                    const std::shared_ptr<const TripMapping>& mapping = nullptr,
                    const std::filesystem::path& positions = {});

/// Calls `work` and prefixes the message of any InputError with the trip's name, which the engine
/// does not know.
template <typename Work>
auto with_trip_name(const std::string& trip, Work work) {
    try {
        return work();
    } catch (const InputError& error) {
        throw InputError{trip + ": " + error.what()};
    }
}

/// Position of the car at a time, interpolated linearly between fixes and corrected for latency.
class TripPositions {
public:
    explicit TripPositions(const TripLog& trip);

    /// `std::nullopt` before the first fix, after the last, and in gaps of more than ten seconds.
    std::optional<GeoPoint> operator()(double t_s) const;

private:
    std::vector<double> t_s_;
    std::vector<GeoPoint> at_;
};

} // namespace macadam
