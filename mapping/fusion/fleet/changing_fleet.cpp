#include "mapping/fusion/fleet/changing_fleet.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace macadam {
namespace {

/// Part of a car's trips that is calibrated as a car of its own.
struct Part {
    std::uint32_t car;
    std::optional<std::int64_t> from_ms; ///< `std::nullopt`: since ever
    std::optional<CarChange> change{};
    bool undated = false; ///< the undated trips of a car that changed
};

/// Cars in parts, which are split one by one. The first parts are the cars themselves, in their
/// order.
class Parts {
public:
    explicit Parts(std::size_t cars) : of_car_(cars) {
        for (std::uint32_t car = 0; car < cars; ++car) {
            add({.car = car, .from_ms = {}});
        }
    }

    const std::vector<Part>& all() const { return parts_; }

    void split(const FoundChange& found) {
        const auto car = parts_[found.car].car;
        if (of_car_[car].size() == 1) {
            add({.car = car, .from_ms = {}, .undated = true});
        }
        const auto& [part, utc_ms, level, log_scatter] = found;
        CarChange change;
        if (level) {
            change.level = std::expm1(level->size);
            change.level_sd = level->sd * std::exp(level->size);
        }
        change.scatter = log_scatter ? std::exp(log_scatter->size) : 1;
        add({.car = car, .from_ms = utc_ms, .change = change});
    }

    /// Part of a trip of a car.
    std::uint32_t at(std::uint32_t car, const std::optional<std::int64_t>& utc_ms) const {
        auto best = of_car_[car].front();
        for (const auto i : of_car_[car]) {
            const auto& part = parts_[i];
            if (part.undated ? !utc_ms
                             : utc_ms && part.from_ms && *part.from_ms <= *utc_ms &&
                                   !(parts_[best].from_ms > part.from_ms)) {
                best = i;
            }
        }
        return best;
    }

    /// Number of parts of the car of a part.
    std::size_t siblings(std::size_t part) const { return of_car_[parts_[part].car].size(); }

private:
    void add(const Part& part) {
        of_car_[part.car].push_back(static_cast<std::uint32_t>(parts_.size()));
        parts_.push_back(part);
    }

    std::vector<Part> parts_;
    std::vector<std::vector<std::uint32_t>> of_car_;
};

void assign_parts(std::vector<FleetReading>& readings,
                  const FleetTrips& trips,
                  const Parts& parts) {
    std::vector<std::uint32_t> of_trip;
    for (std::size_t trip = 0; trip < trips.car.size(); ++trip) {
        of_trip.push_back(parts.at(trips.car[trip], trips.utc_ms[trip]));
    }
    for (auto& reading : readings) {
        reading.car = of_trip[reading.trip];
    }
}

/// Calibrates the parts as cars. The parts of a car together have the weight of one car.
FleetCalibration calibrate_parts(const std::vector<FleetReading>& readings,
                                 const Parts& parts,
                                 const std::vector<std::optional<double>>& known,
                                 const FleetPrior& prior,
                                 const std::vector<double>& stated_sd,
                                 const std::vector<double>& scatter) {
    std::vector<std::optional<double>> known_parts;
    std::vector<double> stated_parts;
    for (std::size_t i = 0; i < parts.all().size(); ++i) {
        const auto car = parts.all()[i].car;
        known_parts.push_back(known[car]);
        if (!stated_sd.empty()) {
            stated_parts.push_back(stated_sd[car] *
                                   std::sqrt(static_cast<double>(parts.siblings(i))));
        }
    }
    return calibrate_fleet(readings, known_parts, prior, stated_parts, scatter);
}

/// Factors on the sd of the passes of parts that are out of line.
std::vector<double> scatter_factors(const FleetCalibration& found, double min_scatter) {
    std::vector<double> factors;
    for (const double scatter : found.scatter) {
        factors.push_back(scatter >= min_scatter ? scatter : 1);
    }
    return factors;
}

bool is_any_large(const std::vector<double>& factors) {
    return std::ranges::any_of(factors, [](double factor) { return factor > 1; });
}

std::vector<std::vector<CarPeriod>>
periods_of(const Parts& parts, const FleetCalibration& found, std::size_t cars) {
    std::vector<std::vector<CarPeriod>> periods(cars);
    for (std::size_t i = 0; i < parts.all().size(); ++i) {
        if (const auto& [car, from_ms, change, undated] = parts.all()[i]; !undated) {
            periods[car].push_back({from_ms, change, found.cars[i], found.shared[i]});
        }
    }
    for (auto& of_car : periods) {
        std::ranges::sort(of_car, {}, &CarPeriod::from_ms); // std::nullopt is first
    }
    return periods;
}

} // namespace

ChangingFleet calibrate_changing_fleet(std::vector<FleetReading> readings,
                                       const FleetTrips& trips,
                                       const std::vector<std::optional<double>>& known,
                                       const FleetPrior& prior,
                                       const std::vector<double>& stated_sd,
                                       const ChangeSearch& search) {
    Parts parts{known.size()};
    auto found = calibrate_parts(readings, parts, known, prior, stated_sd, {});
    bool is_final = false;
    for (int round = 0; round < search.max_rounds && !is_final; ++round) {
        const auto changes =
            find_car_changes(car_days(readings, trips, found), search, prior.min_shared);
        std::ranges::for_each(changes, [&](const FoundChange& change) { parts.split(change); });
        if (!changes.empty()) {
            assign_parts(readings, trips, parts);
            found = calibrate_parts(readings, parts, known, prior, stated_sd, {});
        }
        is_final = changes.empty();
    }
    if (const auto scatter = scatter_factors(found, search.min_scatter); is_any_large(scatter)) {
        found = calibrate_parts(readings, parts, known, prior, stated_sd, scatter);
    }
    auto periods = periods_of(parts, found, known.size());
    return {std::move(found), std::move(periods)};
}

} // namespace macadam
