#include "mapping/fusion/fleet/fleet_fit.hpp"

#include "estimator/common/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace macadam {
namespace {

constexpr double dof = 4;        // of Student's t, as in TailModel
constexpr double min_gain = 0.1; // of car and trip together: far below any real car
constexpr double trips_of_prior = 5;
constexpr double contradiction_sds = 3; // of Tukey's biweight
constexpr std::size_t mixing_depth = 8;
constexpr double cars_of_prior = 4;
constexpr std::uint32_t places_of_block = 25; // 500 m
constexpr double block_sd = 0.065;            // of what cars misread in a block, relative: see
constexpr double blocks_of_prior = 4;         // docs/method/fusion.md
constexpr double places_alike = 5;            // neighbours that misread alike: 100 m
constexpr double trip_counts_from = 20;       // readings needed for a meaningful trip mean

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
      scatter_{scatter.empty() ? std::vector<double>(known.size(), 1) : scatter},
      known_variance_(known.size(), 0), car_sd_{prior.car_sd}, prior_{prior},
      trust_(readings.size(), 1), leverage_(readings.size(), 0), mixing_{mixing_depth} {
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
    fit_known();
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
    middle_um_ = std::max(1.0, median(std::move(levels)));
}

/// Level of a reading's place from the other readings there.
double FleetFit::level_of_others(std::size_t reading) const {
    const auto& [place, car, trip, read_um] = (*readings_)[reading];
    const double own_um = (read_um - cars[car].offset_um) / expected(reading);
    return (level_um_[place] - leverage_[reading] * own_um) / (1 - leverage_[reading]);
}

/// Fits the ratio of each known source to the levels. What the cars misread on a road is alike
/// along it, so the ratio is as sure as its blocks of places are many and agree, however many
/// places they have.
void FleetFit::fit_known() {
    struct Ratio {
        double read = 0, level = 0;
    };
    std::map<std::pair<std::uint32_t, std::uint32_t>, Ratio> of_blocks; // by source and block
    for (std::size_t i = 0; i < readings_->size(); ++i) {
        const auto& [place, car, trip, read_um] = (*readings_)[i];
        if ((*known_)[car] && leverage_[i] < 1) {
            auto& ratio = of_blocks[{car, place / places_of_block}];
            ratio.read += trust_[i] * read_um;
            ratio.level += trust_[i] * std::max(1.0, level_of_others(i));
        }
    }
    std::ranges::fill(known_variance_, 0);
    for (auto first = of_blocks.begin(), past = first; first != of_blocks.end(); first = past) {
        const auto source = first->first.first;
        Ratio all;
        for (; past != of_blocks.end() && past->first.first == source; ++past) {
            all.read += past->second.read;
            all.level += past->second.level;
        }
        const double gain = all.read / all.level;
        double squares = blocks_of_prior * square(block_sd), count = blocks_of_prior - 1;
        double shares = 0;
        for (auto block = first; block != past; ++block) {
            squares += square(block->second.read / block->second.level / gain - 1);
            count += 1;
            shares += square(block->second.level / all.level);
        }
        cars[source].gain = gain;
        known_variance_[source] = square(*(*known_)[source]) + squares / count * shares;
    }
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

/// Tests whether the error of a car is known better than cars differ.
bool FleetFit::is_certain(std::size_t car) const {
    return !(*known_)[car] && cars[car].variance_at_middle < square(prior_.car_sd);
}

double FleetFit::spread_of_cars(const std::vector<bool>& counts, double about) const {
    std::vector<double> off;
    double sampling = 0;
    for (std::size_t car = 0; car < counts.size(); ++car) {
        if (counts[car]) {
            off.push_back(std::abs(cars[car].error_at_middle - about));
            sampling += cars[car].variance_at_middle;
        }
    }
    if (off.size() < 2) {
        return prior_.car_sd;
    }
    const auto n = static_cast<double>(off.size());
    const double seen =
        square(normal_sd_per_mad * median(std::move(off))) * n / (n - 1) - sampling / n;
    return std::sqrt((cars_of_prior * square(prior_.car_sd) + n * std::max(0.0, seen)) /
                     (cars_of_prior + n));
}

/// Variance of the mean error of the cars: their spread, and what is common to all.
double FleetFit::mean_variance() const {
    double weight = 0;
    for (std::size_t i = 0; i < cars.size(); ++i) {
        weight += is_certain(i) ? (*anchor_weights_)[i] : 0;
    }
    return square(car_sd_) / std::max(1.0, weight) + square(prior_.common_sd);
}

/// Returns the relative error of the levels by the known sources and the mean of the cars, each by
/// its variance. A mean that contradicts the sources counts less, by 3 sds not at all.
/// \param mean_error  of the cars, relative to the levels
double FleetFit::known_and_cars(double mean_error) {
    double weight = 0, error = 0;
    for (std::size_t i = 0; i < cars.size(); ++i) {
        if (known_variance_[i] > 0) {
            weight += 1 / known_variance_[i];
            error += (cars[i].gain - 1) / known_variance_[i];
        }
    }
    const double of_mean = mean_variance();
    const double apart = square(mean_error - error / weight) / (of_mean + 1 / weight);
    const double trust = square(std::max(0.0, 1 - apart / square(contradiction_sds)));
    weight += trust / of_mean;
    error += trust * mean_error / of_mean;
    anchor_sd = 1 / std::sqrt(weight);
    return error / weight;
}

/// Moves gains and offsets so that the robust mean of the cars is correct; with known sources, so
/// that the gains of these and that mean are, as far as each is certain.
void FleetFit::centre_cars() {
    const double z = 1 / middle_um_;
    double whole = 0, gain = 0, offset_um = 0;
    for (std::size_t i = 0; i < cars.size(); ++i) {
        auto& car = cars[i];
        if ((*known_)[i]) {
            continue;
        }
        car.error_at_middle = car.gain - 1 + car.offset_um * z;
        const double variance =
            square(prior_.car_sd) / (*anchor_weights_)[i] + car.variance_at_middle;
        const double weight = (dof + 1) / (dof + square(car.error_at_middle) / variance) / variance;
        whole += weight;
        gain += weight * car.gain;
        offset_um += weight * car.offset_um;
    }
    if (whole <= 0) {
        return;
    }
    gain /= whole;
    offset_um /= whole;
    if (std::ranges::any_of(known_variance_, [](double variance) { return variance > 0; })) {
        const double mean = gain - 1 + offset_um * z;
        gain = 1 + known_and_cars(mean);
        mean_error_ = (mean + 1) / gain - 1;
        offset_um = 0;
    }
    for (auto& car : cars) {
        car.gain /= gain;
        car.offset_um -= offset_um;
        car.error_at_middle = car.gain - 1 + car.offset_um * z;
    }
}

FleetFit::LocalError FleetFit::local_error() const {
    std::vector<double> off;
    double expected_variance = 0;
    for (std::size_t i = 0; i < readings_->size(); ++i) {
        const auto& [place, car, trip, read_um] = (*readings_)[i];
        if ((*known_)[car] && leverage_[i] < 1) {
            const double level_um = std::max(1.0, level_of_others(i));
            off.push_back(std::abs(read_um / cars[car].gain / level_um - 1));
            const double own_weight = trust_[i] / variance_of(i);
            expected_variance += variance_of(i) + leverage_[i] / (1 - leverage_[i]) / own_weight;
        }
    }
    if (off.empty()) {
        return {};
    }
    const auto count = static_cast<double>(off.size());
    const double seen = square(normal_sd_per_mad * median(std::move(off)));
    return {std::max(0.0, seen - expected_variance / count), count / places_alike};
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
        scatter.push_back(
            of_car.size() < prior_.min_shared ? 1 : normal_sd_per_mad * median(std::move(of_car)));
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
    std::vector<bool> counts;
    for (std::size_t i = 0; i < cars.size(); ++i) {
        counts.push_back(is_certain(i));
    }
    car_sd_ = spread_of_cars(counts, mean_error_);
    if (!off.empty()) {
        const double whole = square(normal_sd_per_mad * median(std::move(off)));
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
        const double seen =
            square(normal_sd_per_mad * median(std::move(errors))) * used / (used - cars_used) -
            sampling / used;
        trip_sd = std::sqrt(
            (trips_of_prior * square(prior_.trip_sd) + (used - cars_used) * std::max(0.0, seen)) /
            (trips_of_prior + used - cars_used));
    }
}

} // namespace macadam
