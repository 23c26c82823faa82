#include "mapping/fusion/fleet/left_out_cars.hpp"

#include "estimator/common/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>

namespace macadam {
namespace {

double square(double x) {
    return x * x;
}

/// Readings of the calibrated cars over the median level, as shares of it: gain plus offset.
class ReadShares {
public:
    explicit ReadShares(const FleetCalibration& fleet) : middle_um_{fleet.middle_um} {
        for (const auto& car : fleet.cars) {
            if (car) {
                sorted_.push_back(of(*car));
            }
        }
        std::ranges::sort(sorted_);
    }

    std::size_t size() const { return sorted_.size(); }

    /// Median of all but one, which is among them.
    double median_without(const CarCalibration& car) const {
        const auto own =
            static_cast<std::size_t>(std::ranges::lower_bound(sorted_, of(car)) - sorted_.begin());
        const auto left = [&](std::size_t i) { return sorted_[i < own ? i : i + 1]; };
        const auto count = sorted_.size() - 1;
        return (left((count - 1) / 2) + left(count / 2)) / 2;
    }

private:
    double of(const CarCalibration& car) const { return car.gain + car.offset_um / middle_um_; }

    double middle_um_;
    std::vector<double> sorted_;
};

/// Level of a place by one car.
struct CarLevel {
    std::uint32_t car; ///< whatever period of it
    double weight = 0; ///< 1 / variance of its readings' mean, relative
    double sum = 0;
    double own_variance = 0; ///< of car and trip, relative

    double um() const { return sum / weight; }
    double precision() const { return 1 / (own_variance + 1 / weight); }
};

/// A place with its calibrated readings.
class SegmentReadings {
public:
    SegmentReadings(std::span<const FleetReading> readings,
                    const FleetTrips& trips,
                    const FleetCalibration& fleet,
                    const FleetPrior& prior)
        : trips_{&trips}, fleet_{&fleet}, prior_{&prior} {
        std::ranges::copy_if(readings, std::back_inserter(readings_), [&](const auto& reading) {
            return fleet.cars[reading.car].has_value();
        });
        std::ranges::stable_sort(
            readings_, {}, [&](const auto& reading) { return trips.car[reading.trip]; });
        double sum_um = 0;
        for (const auto& reading : readings_) {
            sum_um += level_um(reading);
        }
        mean_um_ =
            std::max(1.0, sum_um / static_cast<double>(std::max<std::size_t>(1, readings_.size())));
        std::ranges::for_each(readings_, [&](const auto& reading) { add(reading); });
        for (const auto& car : cars_) {
            precision_ += car.precision();
            sum_ += car.precision() * car.um();
        }
    }

    const std::vector<FleetReading>& readings() const { return readings_; }

    /// Variance of a reading about its trip, relative.
    double pass_variance(const FleetReading& reading) const {
        return square(fleet_->cars[reading.car]->scatter) *
               (square(fleet_->rest_sd) + square(prior_->rest_sd_um / mean_um_));
    }

    struct Level {
        double um, variance; ///< the variance is relative
    };
    /// Level by all cars but that of a reading; `std::nullopt` without another.
    std::optional<Level> level_without(const FleetReading& reading) const {
        if (cars_.size() < 2) {
            return std::nullopt;
        }
        const auto own =
            std::ranges::lower_bound(cars_, trips_->car[reading.trip], {}, &CarLevel::car);
        const double precision = precision_ - own->precision();
        const double um = (sum_ - own->precision() * own->um()) / precision;
        return Level{std::max(1.0, um), 1 / precision};
    }

private:
    double level_um(const FleetReading& reading) const {
        const auto& car = *fleet_->cars[reading.car];
        return (reading.read_um - car.offset_um) / car.gain;
    }

    void add(const FleetReading& reading) {
        const auto number = trips_->car[reading.trip];
        if (cars_.empty() || cars_.back().car != number) {
            const double own =
                square(fleet_->cars[reading.car]->relative_sd) + square(fleet_->trip_sd);
            cars_.push_back({.car = number, .own_variance = own});
        }
        const double weight = 1 / pass_variance(reading);
        cars_.back().weight += weight;
        cars_.back().sum += weight * level_um(reading);
    }

    const FleetTrips* trips_;
    const FleetCalibration* fleet_;
    const FleetPrior* prior_;
    std::vector<FleetReading> readings_; ///< by car
    std::vector<CarLevel> cars_;         ///< by their numbers
    double mean_um_ = 1;
    double precision_ = 0; ///< of all cars
    double sum_ = 0;       ///< of their levels, each times its precision
};

} // namespace

LeftOutReadings leave_cars_out(const std::vector<FleetReading>& readings,
                               const FleetTrips& trips,
                               const FleetCalibration& fleet,
                               const FleetPrior& prior) {
    LeftOutReadings found;
    const ReadShares shares{fleet};
    if (shares.size() < 2) {
        return found;
    }
    const double of_median = std::numbers::pi / 2 / static_cast<double>(shares.size() - 1);
    const double car_variance = square(fleet.car_sd) * (1 + of_median);
    for (std::size_t first = 0, past = 0; first < readings.size(); first = past) {
        while (past < readings.size() && readings[past].place == readings[first].place) {
            ++past;
        }
        const SegmentReadings place{
            std::span{readings}.subspan(first, past - first), trips, fleet, prior};
        for (const auto& reading : place.readings()) {
            if (const auto level = place.level_without(reading)) {
                const double expected_um =
                    level->um * shares.median_without(*fleet.cars[reading.car]);
                const double variance = car_variance + square(fleet.trip_sd) +
                                        place.pass_variance(reading) + level->variance;
                ++found.count;
                found.held += std::abs(reading.read_um / expected_um - 1) <=
                              normal_interval_90 * std::sqrt(variance);
            }
        }
    }
    return found;
}

} // namespace macadam
