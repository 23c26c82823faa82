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

/// Number of parts of each car that have readings, at least 1.
std::vector<std::size_t>
driven_parts(const std::vector<FleetReading>& readings, const Parts& parts, std::size_t cars) {
    std::vector<bool> is_driven(parts.all().size());
    for (const auto& reading : readings) {
        is_driven[reading.car] = true;
    }
    std::vector<std::size_t> driven(cars, 0);
    for (std::size_t i = 0; i < is_driven.size(); ++i) {
        driven[parts.all()[i].car] += is_driven[i] ? 1 : 0;
    }
    for (auto& count : driven) {
        count = std::max<std::size_t>(1, count);
    }
    return driven;
}

/// Calibrates the parts as cars. The parts of a car together have the weight of one car.
FleetCalibration calibrate_parts(const std::vector<FleetReading>& readings,
                                 const Parts& parts,
                                 const std::vector<std::optional<double>>& known,
                                 const FleetPrior& prior,
                                 const std::vector<double>& stated_sd,
                                 const std::vector<double>& scatter) {
    const auto driven = driven_parts(readings, parts, known.size());
    std::vector<std::optional<double>> known_parts;
    std::vector<double> stated_parts;
    std::vector<double> shares;
    for (const auto& part : parts.all()) {
        known_parts.push_back(known[part.car]);
        shares.push_back(1 / static_cast<double>(driven[part.car]));
        if (!stated_sd.empty()) {
            stated_parts.push_back(stated_sd[part.car]);
        }
    }
    return calibrate_fleet(readings, known_parts, prior, stated_parts, scatter, shares);
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

/// A period with the part that it is.
struct PartPeriod {
    std::size_t part;
    CarPeriod period;
};

double square(double x) {
    return x * x;
}

/// Change of a car between two calibrated periods; what was found by a search decides whether
/// level or scatter changed.
CarChange change_between(const PartPeriod& before,
                         const PartPeriod& after,
                         const FleetCalibration& found,
                         const FleetPrior& prior) {
    CarChange change = *after.period.change;
    const auto& first = *before.period.calibration;
    const auto& second = *after.period.calibration;
    const auto read = [&](const CarCalibration& car) {
        return car.gain + car.offset_um / found.middle_um;
    };
    if (change.level_sd > 0) {
        const double ratio = read(second) / read(first);
        const double floors = 2 * square(prior.min_car_sd); // in both sds, not of the change
        const double variance =
            std::max(0.0, square(first.relative_sd) + square(second.relative_sd) - floors);
        change.level = ratio - 1;
        change.level_sd = ratio * std::sqrt(variance);
    }
    if (change.scatter != 1) {
        change.scatter = found.scatter[after.part] / found.scatter[before.part];
    }
    return change;
}

/// Periods of the cars, in the order of time.
std::vector<std::vector<CarPeriod>> periods_of(const Parts& parts,
                                               const FleetCalibration& found,
                                               std::size_t cars,
                                               const FleetPrior& prior) {
    std::vector<std::vector<PartPeriod>> of_cars(cars);
    for (std::size_t i = 0; i < parts.all().size(); ++i) {
        if (const auto& [car, from_ms, change, undated] = parts.all()[i]; !undated) {
            of_cars[car].push_back({i, {from_ms, change, found.cars[i], found.shared[i]}});
        }
    }
    std::vector<std::vector<CarPeriod>> periods;
    for (auto& of_car : of_cars) {
        std::ranges::sort(of_car, {}, [](const PartPeriod& part) { // std::nullopt is first
            return part.period.from_ms;
        });
        periods.emplace_back();
        for (std::size_t i = 0; i < of_car.size(); ++i) {
            periods.back().push_back(of_car[i].period);
            if (i > 0 && of_car.size() > 2 && of_car[i].period.calibration &&
                of_car[i - 1].period.calibration) {
                periods.back().back().change =
                    change_between(of_car[i - 1], of_car[i], found, prior);
            }
        }
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
    auto periods = periods_of(parts, found, known.size(), prior);
    const auto left_out = leave_cars_out(readings, trips, found, prior);
    return {std::move(found), std::move(periods), left_out};
}

} // namespace macadam
