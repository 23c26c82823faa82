#include "mapping/fusion/fleet_fit.hpp"

#include <algorithm>
#include <cmath>

namespace macadam {
namespace {

constexpr double dof = 4;        // of Student's t, as in TailModel
constexpr double min_gain = 0.1; // of car and trip together: far below any real car
constexpr double trips_of_prior = 5;
constexpr std::size_t mixing_depth = 8;
constexpr double trip_counts_from = 20; // readings needed for a meaningful trip mean

double square(double x) {
    return x * x;
}

} // namespace

FleetFit::FleetFit(const std::vector<FleetReading>& readings,
                   const std::vector<std::optional<double>>& known,
                   const FleetPrior& prior,
                   const std::vector<double>& anchor_weights,
                   const std::vector<double>& scatter)
    : cars(known.size()), trip_sd{prior.trip_sd}, rest_sd{prior.rest_sd}, readings_{&readings},
      known_{&known}, anchor_weights_{&anchor_weights},
      scatter_{scatter.empty() ? std::vector<double>(known.size(), 1) : scatter}, prior_{prior}, trust_(readings.size(), 1),
      leverage_(readings.size(), 0), mixing_{mixing_depth} {
    std::uint32_t trips = 0;
    for (std::size_t i = 0; i < readings.size(); ++i) {
        if (i == 0 || readings[i].place != readings[i - 1].place) {
            first_of_place_.push_back(i);
        }
        trips = std::max(trips, readings[i].trip + 1);
    }
    first_of_place_.push_back(readings.size());
    level_um_.resize(place_count(), 0);
    trips_.resize(trips);
    for (const auto& reading : readings) {
        trips_[reading.trip].car = reading.car;
        ++trips_[reading.trip].readings;
    }
    fit_levels();
}

/// Returns gains and relative offsets of the cars, then the errors of the trips.
Eigen::VectorXd FleetFit::errors() const {
    Eigen::VectorXd errors(static_cast<Eigen::Index>(2 * cars.size() + trips_.size()));
    Eigen::Index i = 0;
    for (const auto& car : cars) {
        errors[i++] = car.gain;
        errors[i++] = car.offset_um / middle_um_;
    }
    for (const auto& trip : trips_) {
        errors[i++] = trip.error;
    }
    return errors;
}

void FleetFit::set_errors(const Eigen::VectorXd& errors) {
    Eigen::Index i = 0;
    for (auto& car : cars) {
        car.gain = errors[i++];
        car.offset_um = errors[i++] * middle_um_;
    }
    for (auto& trip : trips_) {
        trip.error = errors[i++];
    }
}

double FleetFit::settle() {
    const std::vector<Car> before = cars;
    const auto errors_before = errors();
    fit_levels();
    hold_against_known();
    sum_trips();
    fit_cars();
    centre_cars();
    trust_readings();
    double moved = 0;
    for (std::size_t car = 0; car < cars.size(); ++car) {
        moved = std::max({moved,
                          std::abs(cars[car].gain - before[car].gain),
                          std::abs(cars[car].offset_um - before[car].offset_um) / middle_um_});
    }
    set_errors(mixing_.next(errors_before, errors()));
    return moved;
}

/// Returns the variance of a single reading, relative to the level of its place.
double FleetFit::variance_of(std::size_t reading) const {
    const auto& [place, car, trip, read_um] = (*readings_)[reading];
    if (const auto& sd = (*known_)[car]) {
        return square(*sd);
    }
    return square(scatter_[car]) *
           (square(rest_sd) + square(prior_.rest_sd_um / std::max(1.0, level_um_[place])));
}

/// Returns the expected ratio of reading to level, without the offset.
double FleetFit::expected(std::size_t reading) const {
    const auto& [place, car, trip, read_um] = (*readings_)[reading];
    return std::max(min_gain, cars[car].gain + trips_[trip].error);
}

void FleetFit::fit_levels() {
    std::vector<double> levels;
    for (std::size_t at = 0; at + 1 < first_of_place_.size(); ++at) {
        const auto place = at;
        double whole = 0, sum = 0;
        for (auto i = first_of_place_[at]; i < first_of_place_[at + 1]; ++i) {
            const auto& reading = (*readings_)[i];
            const double level = (reading.read_um - cars[reading.car].offset_um) / expected(i);
            leverage_[i] = trust_[i] / (level_um_[place] > 0 ? variance_of(i) : 1);
            whole += leverage_[i];
            sum += leverage_[i] * level;
        }
        for (auto i = first_of_place_[at]; i < first_of_place_[at + 1]; ++i) {
            leverage_[i] /= whole;
        }
        level_um_[place] = std::max(1.0, sum / whole);
        levels.push_back(level_um_[place]);
    }
    middle_um_ = std::max(1.0, median_of(std::move(levels)));
}

/// Rescales all levels, and with them the gains, to agree with the known cars. Alternating with the
/// other steps instead would take as many rounds as there are places without a known car.
void FleetFit::hold_against_known() {
    double whole = 0, sum = 0, square_sum = 0, min_variance = 0;
    for (std::size_t i = 0; i < readings_->size(); ++i) {
        const auto& reading = (*readings_)[i];
        const auto& sd = (*known_)[reading.car];
        if (sd && leverage_[i] < 1) {
            // The level from the other readings alone.
            const double level =
                (level_um_[reading.place] - leverage_[i] * reading.read_um) / (1 - leverage_[i]);
            const double off = reading.read_um / std::max(1.0, level) - 1;
            const double weight = trust_[i] / square(*sd);
            whole += weight;
            sum += weight * off;
            square_sum += weight * weight * square(off);
            min_variance = std::max(min_variance, square(*sd));
        }
    }
    if (whole <= 0) {
        return;
    }
    const double off = sum / whole;
    for (std::size_t car = 0; car < cars.size(); ++car) {
        if (!(*known_)[car]) {
            cars[car].gain /= 1 + off;
        }
    }
    for (auto& level_um : level_um_) {
        level_um *= 1 + off;
    }
    // The relative error of a survey is common to all its places: its own sd does not average out.
    known_sd = std::sqrt(min_variance + square_sum / square(whole));
}

void FleetFit::sum_trips() {
    for (auto& trip : trips_) {
        trip.w = trip.wz = trip.wzz = trip.wr = trip.wzr = 0;
    }
    for (std::size_t i = 0; i < readings_->size(); ++i) {
        const auto& reading = (*readings_)[i];
        auto& trip = trips_[reading.trip];
        const double z = 1 / level_um_[reading.place];
        const double r = reading.read_um * z - 1;
        const double w = trust_[i] / variance_of(i);
        trip.w += w;
        trip.wz += w * z;
        trip.wzz += w * z * z;
        trip.wr += w * r;
        trip.wzr += w * z * r;
    }
}

/// Solves the normal equations of gain error and offset, with the trip errors integrated out.
void FleetFit::fit_cars() {
    struct Normal {
        double gg, ga, aa, g, a;
    };
    std::vector<Normal> normals(
        cars.size(), {1 / square(prior_.gain_sd), 0, 1 / square(prior_.offset_sd_um), 0, 0});
    const double precision = 1 / square(trip_sd);
    for (const auto& trip : trips_) {
        auto& normal = normals[trip.car];
        const double k = 1 / (trip.w + precision);
        normal.gg += trip.w - trip.w * trip.w * k;
        normal.ga += trip.wz - trip.w * trip.wz * k;
        normal.aa += trip.wzz - trip.wz * trip.wz * k;
        normal.g += trip.wr - trip.w * trip.wr * k;
        normal.a += trip.wzr - trip.wz * trip.wr * k;
    }
    const double z = 1 / middle_um_;
    for (std::size_t i = 0; i < cars.size(); ++i) {
        if ((*known_)[i]) {
            continue;
        }
        const auto& [gg, ga, aa, g, a] = normals[i];
        const double determinant = gg * aa - ga * ga;
        auto& car = cars[i];
        car.gain = 1 + (g * aa - a * ga) / determinant;
        car.offset_um = (a * gg - g * ga) / determinant;
        car.variance_at_middle = (aa - 2 * ga * z + gg * z * z) / determinant;
    }
    for (auto& trip : trips_) {
        const auto& car = cars[trip.car];
        trip.error = (*known_)[trip.car]
                         ? 0
                         : (trip.wr - (car.gain - 1) * trip.w - car.offset_um * trip.wz) /
                               (trip.w + precision);
    }
}

/// Without a known car, the mean of all cars is taken as correct, with outliers down-weighted.
void FleetFit::centre_cars() {
    const double z = 1 / middle_um_;
    double whole = 0, gain = 0, offset_um = 0;
    for (std::size_t i = 0; i < cars.size(); ++i) {
        auto& car = cars[i];
        car.error_at_middle = car.gain - 1 + car.offset_um * z;
        const double variance =
            square(prior_.car_sd) / (*anchor_weights_)[i] + car.variance_at_middle;
        const double weight = (dof + 1) / (dof + square(car.error_at_middle) / variance) / variance;
        whole += weight;
        gain += weight * car.gain;
        offset_um += weight * car.offset_um;
    }
    if (known_sd || whole <= 0) {
        return;
    }
    for (auto& car : cars) {
        car.gain /= gain / whole;
        car.offset_um -= offset_um / whole;
        car.error_at_middle = car.gain - 1 + car.offset_um * z;
    }
}

/// Returns the deviation of a reading from what is expected, relative to the level of its place.
double FleetFit::residual(std::size_t reading) const {
    const auto& [place, car, trip, read_um] = (*readings_)[reading];
    return (read_um - cars[car].offset_um) / level_um_[place] - expected(reading);
}

void FleetFit::trust_readings() {
    for (std::size_t i = 0; i < readings_->size(); ++i) {
        trust_[i] = (dof + 1) / (dof + square(residual(i)) / variance_of(i));
    }
}

std::vector<double> FleetFit::scatter_of_cars() const {
    std::vector<std::vector<double>> off(cars.size());
    for (std::size_t i = 0; i < readings_->size(); ++i) {
        const auto car = (*readings_)[i].car;
        if (!(*known_)[car] && leverage_[i] < 0.5) {
            off[car].push_back(scatter_[car] * std::abs(residual(i)) /
                               std::sqrt((1 - leverage_[i]) * variance_of(i)));
        }
    }
    std::vector<double> scatter;
    for (auto& of_car : off) {
        scatter.push_back(of_car.size() < prior_.min_shared
                              ? 1
                              : sd_over_mad_of_normal * median_of(std::move(of_car)));
    }
    return scatter;
}

void FleetFit::take_spread() {
    mixing_.restart();
    std::vector<double> off;
    for (std::size_t i = 0; i < readings_->size(); ++i) {
        const auto& reading = (*readings_)[i];
        // A reading with half of its place's weight pulls the level along, so its residual is not
        // its error.
        if (!(*known_)[reading.car] && leverage_[i] < 0.5) {
            off.push_back(std::abs(residual(i)) / scatter_[reading.car] /
                          std::sqrt(1 - leverage_[i]));
        }
    }
    if (!off.empty()) {
        const double whole = square(sd_over_mad_of_normal * median_of(std::move(off)));
        const double beside = square(prior_.rest_sd_um / middle_um_);
        rest_sd = std::sqrt(std::max(whole - beside, whole / 100));
    }

    std::vector<std::size_t> trips_of_car(cars.size(), 0);
    for (const auto& trip : trips_) {
        trips_of_car[trip.car] += trip.readings >= trip_counts_from ? 1 : 0;
    }
    std::vector<double> errors;
    double sampling = 0, used = 0, cars_used = 0;
    for (const auto& trip : trips_) {
        if (trip.readings >= trip_counts_from && trips_of_car[trip.car] > 1 &&
            !(*known_)[trip.car]) {
            const auto& car = cars[trip.car];
            const double mean =
                (trip.wr - (car.gain - 1) * trip.w - car.offset_um * trip.wz) / trip.w;
            errors.push_back(std::abs(mean));
            sampling += 1 / trip.w;
            used += 1;
            cars_used += 1 / static_cast<double>(trips_of_car[trip.car]);
        }
    }
    if (used > cars_used) {
        const double seen = square(sd_over_mad_of_normal * median_of(std::move(errors))) * used /
                                (used - cars_used) -
                            sampling / used;
        trip_sd = std::sqrt(
            (trips_of_prior * square(prior_.trip_sd) + (used - cars_used) * std::max(0.0, seen)) /
            (trips_of_prior + used - cars_used));
    }
}

double median_of(std::vector<double> values) {
    if (values.empty()) {
        return 0;
    }
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

} // namespace macadam
