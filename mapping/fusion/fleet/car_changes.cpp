#include "mapping/fusion/fleet/car_changes.hpp"

#include "estimator/common/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <tuple>
#include <utility>

namespace macadam {
namespace {

constexpr double ms_per_day = 86'400'000;
constexpr double days_alike = 60;      // over which the comparison with others fades
constexpr std::size_t min_cars = 3;    // at a place
constexpr double min_weight = 1e-3;    // of others, after 400 days; below, sums are rounding errors
constexpr std::size_t block = 25;      // readings: 500 m
constexpr std::size_t min_of_day = 10; // readings
constexpr double blocks_of_prior = 4;  // certainty of the prior variance of block means
constexpr double block_share = 0.25;   // of a reading's variance that is left in a block's mean
constexpr double scatter_day_sd = 0.15; // of the logarithm of scatter, from day to day
constexpr double mad_variance = 1.36;   // of its logarithm, normal distribution, times readings
constexpr double min_share_of_largest = 0.7; // of three cars, one that changes moves two by half

double square(double x) {
    return x * x;
}

/// Dated, calibrated reading at a place.
struct DatedReading {
    double days;
    std::uint32_t car; ///< whatever period of it
    std::uint32_t period;
    std::uint32_t trip;
    double log_level;
};

/// Logarithm of a calibrated reading; offsets are much smaller than readings.
double log_level(const FleetReading& reading, const std::optional<CarCalibration>& calibration) {
    const auto& [gain, offset_um, sd, scatter] = calibration.value_or(CarCalibration{});
    return std::log(std::max(0.1 * reading.read_um, reading.read_um - offset_um) / gain);
}

std::vector<DatedReading> placed(std::span<const FleetReading> readings,
                                 const FleetTrips& trips,
                                 const FleetCalibration& calibration) {
    std::vector<DatedReading> dated;
    for (const auto& reading : readings) {
        const auto& utc_ms = trips.utc_ms[reading.trip];
        const bool is_known = calibration.cars[reading.car] || calibration.is_known[reading.car];
        if (utc_ms && is_known) {
            dated.push_back({static_cast<double>(*utc_ms) / ms_per_day,
                             trips.car[reading.trip],
                             reading.car,
                             reading.trip,
                             log_level(reading, calibration.cars[reading.car])});
        }
    }
    std::ranges::sort(dated, {}, [](const DatedReading& reading) {
        return std::tuple{reading.days, reading.trip, reading.log_level};
    });
    return dated;
}

/// Weighted sum that fades with time.
struct FadingSum {
    double weight = 0, sum = 0, days = 0;

    void fade(double to_days) {
        const double left = std::exp(-std::abs(to_days - days) / days_alike);
        weight *= left;
        sum *= left;
        days = to_days;
    }
    void add(double value) {
        weight += 1;
        sum += value;
    }
};

/// Adds to each reading the sums over the readings of other cars up to it.
template <typename Order>
void add_sums_of_others(std::span<const DatedReading> readings,
                        const std::vector<std::uint32_t>& cars,
                        const Order& order,
                        std::vector<FadingSum>& of_others) {
    FadingSum all;
    std::vector<FadingSum> own(cars.size());
    for (const auto i : order) {
        const auto& reading = readings[i];
        auto& car = own[static_cast<std::size_t>(std::ranges::lower_bound(cars, reading.car) -
                                                 cars.begin())];
        all.fade(reading.days);
        car.fade(reading.days);
        of_others[i].weight += all.weight - car.weight;
        of_others[i].sum += all.sum - car.sum;
        all.add(reading.log_level);
        car.add(reading.log_level);
    }
}

std::vector<FadingSum> sums_of_others(std::span<const DatedReading> readings,
                                      const std::vector<std::uint32_t>& cars) {
    std::vector<FadingSum> sums(readings.size());
    std::vector<std::size_t> order(readings.size());
    std::iota(order.begin(), order.end(), 0);
    add_sums_of_others(readings, cars, order, sums);
    std::ranges::reverse(order);
    add_sums_of_others(readings, cars, order, sums);
    return sums;
}

struct Residual {
    std::int64_t day;
    std::uint32_t trip;
    double off; ///< of the logarithm from that of the other cars
};

/// Adds the residuals of a place to those of its cars.
void add_place(std::span<const FleetReading> readings,
               const FleetTrips& trips,
               const FleetCalibration& calibration,
               std::vector<std::vector<Residual>>& of_cars) {
    const auto dated = placed(readings, trips, calibration);
    std::vector<std::uint32_t> cars;
    for (const auto& reading : dated) {
        cars.push_back(reading.car);
    }
    std::ranges::sort(cars);
    const auto repeated = std::ranges::unique(cars);
    cars.erase(repeated.begin(), repeated.end());
    if (cars.size() < min_cars) {
        return;
    }
    const auto others = sums_of_others(dated, cars);
    for (std::size_t i = 0; i < dated.size(); ++i) {
        if (others[i].weight >= min_weight) {
            of_cars[dated[i].period].push_back(
                {static_cast<std::int64_t>(std::floor(dated[i].days)),
                 dated[i].trip,
                 dated[i].log_level - others[i].sum / others[i].weight});
        }
    }
}

/// Day of a car before its variance is known.
struct RoughDay {
    CarDay day;
    std::vector<double> means; ///< of blocks
};

RoughDay rough_day(std::span<const Residual> residuals, const FleetTrips& trips) {
    RoughDay rough{};
    rough.day.readings = residuals.size();
    rough.day.utc_ms = *trips.utc_ms[residuals.front().trip];
    std::vector<double> off;
    const auto blocks = std::max<std::size_t>(1, residuals.size() / block);
    for (std::size_t i = 0; i < blocks; ++i) {
        const auto first = i * residuals.size() / blocks,
                   past = (i + 1) * residuals.size() / blocks;
        double sum = 0;
        for (auto j = first; j < past; ++j) {
            rough.day.utc_ms = std::min(rough.day.utc_ms, *trips.utc_ms[residuals[j].trip]);
            off.push_back(residuals[j].off);
            sum += residuals[j].off;
        }
        rough.means.push_back(sum / static_cast<double>(past - first));
    }
    rough.day.level.value = median(rough.means);
    const double middle = median(off);
    for (auto& value : off) {
        value = std::abs(value - middle);
    }
    const double scatter = std::max(1e-6, normal_sd_per_mad * median(std::move(off)));
    rough.day.log_scatter = {std::log(scatter),
                             square(scatter_day_sd) +
                                 mad_variance / static_cast<double>(residuals.size())};
    return rough;
}

/// Variance of the means of blocks about their days, with a prior.
double block_variance(const std::vector<RoughDay>& days, double rest_sd) {
    double squares = blocks_of_prior * block_share * square(rest_sd);
    double count = blocks_of_prior;
    for (const auto& [day, means] : days) {
        for (const double mean : means) {
            squares += square(mean - day.level.value);
        }
        count += static_cast<double>(means.size() - 1);
    }
    return squares / count;
}

/// \param residuals  in the order of places.
std::vector<CarDay> days_of(std::vector<Residual> residuals,
                            const FleetTrips& trips,
                            const FleetCalibration& calibration) {
    std::ranges::stable_sort(residuals, {}, &Residual::day);
    std::vector<RoughDay> rough;
    for (std::size_t first = 0, past = 0; first < residuals.size(); first = past) {
        while (past < residuals.size() && residuals[past].day == residuals[first].day) {
            ++past;
        }
        if (past - first >= min_of_day) {
            rough.push_back(rough_day(std::span{residuals}.subspan(first, past - first), trips));
        }
    }
    const double of_block = block_variance(rough, calibration.rest_sd);
    std::vector<CarDay> days;
    for (auto& [day, means] : rough) {
        day.level.variance =
            square(calibration.trip_sd) + of_block / static_cast<double>(means.size());
        days.push_back(day);
    }
    return days;
}

/// Shift that is large enough, and has enough readings on either side.
std::optional<LevelShift> shift_of(const std::vector<CarDay>& days,
                                   SeriesPoint CarDay::*quantity,
                                   double min_size,
                                   std::size_t min_readings) {
    std::vector<SeriesPoint> series;
    for (const auto& day : days) {
        series.push_back(day.*quantity);
    }
    auto shift = find_level_shift(series);
    if (!shift) {
        return std::nullopt;
    }
    std::size_t before = 0, after = 0;
    for (std::size_t i = 0; i < days.size(); ++i) {
        (i < shift->first ? before : after) += days[i].readings;
    }
    const bool is_large = std::abs(shift->size) >= min_size;
    return is_large && std::min(before, after) >= min_readings ? shift : std::nullopt;
}

/// Returns the largest p-value that the procedure of Benjamini and Hochberg accepts.
double largest_accepted(std::vector<double> p_values, std::size_t tests, double false_share) {
    std::ranges::sort(p_values);
    double accepted = -1;
    for (std::size_t i = 0; i < p_values.size(); ++i) {
        if (p_values[i] * static_cast<double>(tests) <= false_share * static_cast<double>(i + 1)) {
            accepted = p_values[i];
        }
    }
    return accepted;
}

/// Clears the shifts that are insignificant, or small beside the largest.
void keep_largest(std::vector<FoundChange>& changes,
                  std::optional<LevelShift> FoundChange::*quantity,
                  double largest_p) {
    double largest = 0;
    for (auto& change : changes) {
        auto& shift = change.*quantity;
        if (shift && shift->p_value > largest_p) {
            shift.reset();
        }
        largest = std::max(largest, shift ? std::abs(shift->size) : 0);
    }
    for (auto& change : changes) {
        auto& shift = change.*quantity;
        if (shift && std::abs(shift->size) < min_share_of_largest * largest) {
            shift.reset();
        }
    }
}

/// Drops a change of scatter on other days than that of the level; a later search finds it.
void leave_scatter_of_other_days(FoundChange& change) {
    constexpr std::size_t same_days = 2;
    if (change.level && change.log_scatter) {
        const auto& [a, b] = std::minmax(change.level->first, change.log_scatter->first);
        if (b - a > same_days) {
            change.log_scatter.reset();
        }
    }
}

} // namespace

std::vector<std::vector<CarDay>> car_days(const std::vector<FleetReading>& readings,
                                          const FleetTrips& trips,
                                          const FleetCalibration& calibration) {
    std::vector<std::vector<Residual>> residuals(calibration.cars.size());
    for (std::size_t first = 0, past = 0; first < readings.size(); first = past) {
        while (past < readings.size() && readings[past].place == readings[first].place) {
            ++past;
        }
        add_place(std::span{readings}.subspan(first, past - first), trips, calibration, residuals);
    }
    std::vector<std::vector<CarDay>> days(residuals.size());
    for (std::size_t car = 0; car < residuals.size(); ++car) {
        if (calibration.cars[car]) {
            days[car] = days_of(std::move(residuals[car]), trips, calibration);
        }
    }
    return days;
}

std::vector<FoundChange> find_car_changes(const std::vector<std::vector<CarDay>>& days,
                                          const ChangeSearch& search,
                                          std::size_t min_readings) {
    std::vector<FoundChange> changes;
    std::vector<double> p_values;
    std::size_t tests = 0;
    for (std::size_t car = 0; car < days.size(); ++car) {
        tests += days[car].size() >= 2 * min_beside_shift ? 2 : 0;
        FoundChange change{
            .car = static_cast<std::uint32_t>(car),
            .utc_ms = 0,
            .level =
                shift_of(days[car], &CarDay::level, std::log1p(search.min_level), min_readings),
            .log_scatter = shift_of(
                days[car], &CarDay::log_scatter, std::log(search.min_scatter), min_readings)};
        for (const auto& shift : {change.level, change.log_scatter}) {
            if (shift) {
                p_values.push_back(shift->p_value);
            }
        }
        changes.push_back(change);
    }
    const double largest_p = largest_accepted(std::move(p_values), tests, search.false_share);
    keep_largest(changes, &FoundChange::level, largest_p);
    keep_largest(changes, &FoundChange::log_scatter, largest_p);
    std::erase_if(changes,
                  [](const FoundChange& change) { return !change.level && !change.log_scatter; });
    for (auto& change : changes) {
        leave_scatter_of_other_days(change);
        const auto& first = change.level ? change.level : change.log_scatter;
        change.utc_ms = days[change.car][first->first].utc_ms;
    }
    return changes;
}

} // namespace macadam
