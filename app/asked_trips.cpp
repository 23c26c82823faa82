#include "app/asked_trips.hpp"

#include "estimator/common/error.hpp"

#include <fmt/format.h>

#include <utility>

namespace macadam {

AskedTrips asked_trips(const std::vector<std::filesystem::path>& paths,
                       const std::shared_ptr<const TripMapping>& mapping,
                       const Console& console) {
    AskedTrips all;
    for (const auto& path : paths) {
        TripSearch found;
        try {
            found = find_trips(path, mapping);
        } catch (const InputError& error) {
            TripOutcome outcome;
            outcome.file = path.string();
            outcome.error = error.what();
            all.refused.push_back(std::move(outcome));
            continue;
        }
        if (found.trips.empty()) {
            console.warn(fmt::format(
                "{}: holds no trip log (*.trip.csv, *.trip.csv.gz, *.trip.csv.zst, *.rawlog), nor "
                "an export of phyphox or Sensor Logger",
                path.string()));
        }
        if (found.other_files > 0) {
            console.say(
                fmt::format("{}: {} other files were not read", path.string(), found.other_files));
        }
        all.trips.insert(all.trips.end(), found.trips.begin(), found.trips.end());
    }
    return all;
}

} // namespace macadam
