
#include "estimator/roughness/roughness_mean.hpp"

#include <algorithm>
#include <cmath>

namespace macadam {
namespace {

// Error of the smoother that does not become smaller with the road: sensor noise beyond the stated,
// tyres, what is wrong about friction. Simulated cars on roads below 1 mm/m are that far off
// (docs/method/accuracy.md).
constexpr double absolute_sd_mm_per_m = 0.06;

/// Sums over the covered parts of cells, weighted by their length.
struct Sums {
    double covered_m = 0;
    double left = 0;
    double right = 0;
    double centre = 0;
    double speed = 0;
    double tracks_m = 0; ///< part of covered_m with known left and right
    double lead_in_m = 0;
    double indicative_m = 0;
    std::vector<double> scatter; ///< of each sampled road
    double common_sd = 0;
    double random_sd = 0;
};

double end_m(const IriRun& run) {
    return run.start_travel_m + run.cell_m * static_cast<double>(run.centre_mm_per_m.size());
}

double value_at(const std::vector<float>& values, std::size_t i) {
    return values.empty() ? 0 : static_cast<double>(values[i]);
}

void add(const IriRun& run, double from_m, double to_m, Sums& sums) {
    const auto cells = run.centre_mm_per_m.size();
    const double valid_from_m = run.start_travel_m + run.lead_in_m;
    const double begin_m = std::max(from_m, run.start_travel_m);
    const double finish_m = std::min(to_m, end_m(run));
    if (finish_m <= begin_m) {
        return;
    }
    sums.lead_in_m += std::max(0.0, std::min(finish_m, valid_from_m) - begin_m);
    const double use_from_m = std::max(begin_m, valid_from_m);
    if (finish_m <= use_from_m) {
        return;
    }
    const auto cell_at = [&](double at_m) {
        const double cell = std::floor((at_m - run.start_travel_m) / run.cell_m);
        return std::min(cells - 1, static_cast<std::size_t>(std::max(0.0, cell)));
    };
    for (auto i = cell_at(use_from_m); i <= cell_at(finish_m); ++i) {
        const double cell_from_m = run.start_travel_m + run.cell_m * static_cast<double>(i);
        const double length_m =
            std::min(finish_m, cell_from_m + run.cell_m) - std::max(use_from_m, cell_from_m);
        if (length_m <= 0) {
            continue;
        }
        sums.covered_m += length_m;
        sums.left += length_m * value_at(run.left_mm_per_m, i);
        sums.right += length_m * value_at(run.right_mm_per_m, i);
        sums.centre += length_m * value_at(run.centre_mm_per_m, i);
        sums.speed += length_m * value_at(run.speed_mps, i);
        sums.tracks_m += run.left_mm_per_m.empty() ? 0 : length_m;
        sums.indicative_m += run.indicative ? length_m : 0;
        sums.common_sd = run.common_sd;
        sums.random_sd = run.random_sd;
        sums.scatter.resize(run.scatter_mm_per_m.size());
        for (std::size_t road = 0; road < sums.scatter.size(); ++road) {
            const auto& metres = run.scatter_mm_per_m[road];
            const auto metre = static_cast<std::size_t>(cell_from_m - run.start_travel_m);
            sums.scatter[road] += length_m * value_at(metres, std::min(metre, metres.size() - 1));
        }
    }
}

double slow_m(const IriTrace& trace, double from_m, double to_m) {
    double sum_m = 0;
    auto part = std::ranges::upper_bound(trace.slow, from_m, {}, &TravelSpan::to_m);
    for (; part != trace.slow.end() && part->from_m < to_m; ++part) {
        sum_m += std::min(part->to_m, to_m) - std::max(part->from_m, from_m);
    }
    return sum_m;
}

std::uint8_t validity_of(const Sums& sums, const IriTrace& trace, double from_m, double to_m) {
    // Rounding of borders to cells, and the tyre's contact at the end of a run, do not count as
    // reasons.
    constexpr double notable_m = 1;
    const double slow = slow_m(trace, from_m, to_m);
    const double unknown_m = to_m - from_m - sums.covered_m - sums.lead_in_m - slow;
    unsigned flags = validity::ok;
    flags |= slow > notable_m ? validity::too_slow : 0U;
    flags |= sums.lead_in_m > notable_m ? validity::start_up : 0U;
    flags |= unknown_m > notable_m || (sums.covered_m <= 0 && flags == 0) ? validity::gap : 0U;
    flags |= sums.indicative_m > 0 ? validity::indicative : 0U;
    return static_cast<std::uint8_t>(flags);
}

// Relative error that varies from one 20 m to the next: a one-axle model does not represent the
// wavelengths that cancel between the two axles of a car (simulated two-axle cars,
// docs/method/estimation.md).
constexpr double random_part = 0.20;
constexpr double random_length_m = 20;
// Dry friction, tyre non-uniformity and sensor noise add the same mm/m to every road: the residual
// on smooth roads in the paper's table of field results.
constexpr double floor_mm_per_m = 0.20;

// Values for lateral acceleration alone, which does not observe the mean of the tracks: twice the
// floor of the vertical method, and a ratio of the two that varies from road to road.
constexpr double lateral_random_part = 0.25;
constexpr double lateral_common_part = 0.24;
constexpr double lateral_floor_mm_per_m = 0.40;

// The published 13 Hz low-pass attenuates more at higher speed: -11 % at 80 and -25 % at 105 km/h
// for simulated one-axle cars, 0 at 50 (docs/method/estimation.md). This is not corrected and
// counts as error.
constexpr double filter_free_mps = 50 / 3.6;
constexpr double filter_part_per_mps = 0.0163;

/// Relative change of the IRI for a relative change of one of the vehicle's parameters.
struct Sensitivity {
    const char* parameter;
    double iri_per_unit;
};

// Simulated: mass +20 % gives -15 %, damping +-20 % gives +-9 %, tyre +20 % gives +3 to +19 %; the
// gain divides. The others were varied in the same way in the quarter car's own response.
constexpr Sensitivity sensitivities[] = {{"gain", -1.0},
                                         {"ms_kg", -0.75},
                                         {"cs_ns_per_m", 0.45},
                                         {"kt_n_per_m", 0.55},
                                         {"ks_n_per_m", 0.15},
                                         {"mu_kg", 0.15}};

double vehicle_part(const Vehicle& vehicle) {
    double sum = 0;
    for (const auto& [parameter, iri_per_unit] : sensitivities) {
        const auto found = vehicle.uncertainty.find(parameter);
        if (found != vehicle.uncertainty.end()) {
            sum += std::pow(iri_per_unit * found->second, 2);
        }
    }
    return std::sqrt(sum);
}

/// Combines the scatter of the sampled roads with the errors that they do not contain.
double sd_of_smoother_mm_per_m(double iri_mm_per_m, const Sums& sums) {
    double square = 0;
    for (const double sum : sums.scatter) {
        square += sum * sum;
    }
    const double roads = static_cast<double>(sums.scatter.size());
    const double scatter = std::sqrt(square / (roads - 1)) / sums.covered_m;
    const double random = sums.random_sd / std::sqrt(std::max(sums.covered_m, 1.0));
    const double relative = std::hypot(random, sums.common_sd);
    return std::hypot(std::hypot(scatter, iri_mm_per_m * relative), absolute_sd_mm_per_m);
}

} // namespace

double sd_of_kf_mm_per_m(double iri_mm_per_m,
                         double length_m,
                         double speed_mps,
                         bool lateral_only,
                         const Vehicle& vehicle) {
    const double min_m = 1; // shorter intervals are not more uncertain than one bump
    const double part = lateral_only ? lateral_random_part : random_part;
    const double random = part * std::sqrt(random_length_m / std::max(length_m, min_m));
    const double filter = filter_part_per_mps * std::max(0.0, speed_mps - filter_free_mps);
    const double common =
        std::hypot(vehicle_part(vehicle), filter, lateral_only ? lateral_common_part : 0.0);
    const double floor = lateral_only ? lateral_floor_mm_per_m : floor_mm_per_m;
    return std::hypot(floor, iri_mm_per_m * std::hypot(random, common));
}

IriMean mean_over(const IriTrace& trace, double from_m, double to_m, const Vehicle& vehicle) {
    Sums sums;
    auto run = std::ranges::upper_bound(trace.runs, from_m, {}, end_m);
    for (; run != trace.runs.end() && run->start_travel_m < to_m; ++run) {
        add(*run, from_m, to_m, sums);
    }

    IriMean mean;
    mean.covered_m = sums.covered_m;
    mean.validity = validity_of(sums, trace, from_m, to_m);
    if (sums.covered_m <= 0) {
        return mean;
    }
    mean.speed_mps = sums.speed / sums.covered_m;
    mean.hri_mm_per_m = sums.centre / sums.covered_m;
    // The channels are constant throughout a trip: an interval has both tracks everywhere or
    // nowhere.
    if (sums.tracks_m >= sums.covered_m / 2) {
        mean.left_mm_per_m = sums.left / sums.tracks_m;
        mean.right_mm_per_m = sums.right / sums.tracks_m;
        mean.mri_mm_per_m = (*mean.left_mm_per_m + *mean.right_mm_per_m) / 2;
    }
    const double headline = mean.mri_mm_per_m.value_or(*mean.hri_mm_per_m);
    mean.sd_mm_per_m =
        sums.scatter.empty()
            ? sd_of_kf_mm_per_m(
                  headline, sums.covered_m, mean.speed_mps, sums.indicative_m > 0, vehicle)
            : sd_of_smoother_mm_per_m(headline, sums);
    return mean;
}

} // namespace macadam
