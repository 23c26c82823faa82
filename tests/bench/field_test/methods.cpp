#include "methods.hpp"
#include "estimator/roughness/roughness_mean.hpp"

#include "estimator/smoother/smoothed_iri.hpp"

#include <algorithm>

namespace macadam::field_test {
namespace {

constexpr double hri_over_mri = 0.91; // docs/method/estimation.md

struct Said {
    double iri, sd;
};

/// The headline over a piece, as a user reads it: MRI, or what HRI makes of it.
Said said_of(const IriTrace& trace, double from_m, const Vehicle& vehicle) {
    const auto mean = mean_over(trace, from_m, from_m + segment_m, vehicle);
    if (mean.mri_mm_per_m) {
        return {*mean.mri_mm_per_m, mean.sd_mm_per_m};
    }
    return {*mean.hri_mm_per_m / hri_over_mri, mean.sd_mm_per_m / hri_over_mri};
}

IriTrace trace_of(const MethodRow& row, const Stretch& stretch, const Vehicle& vehicle) {
    EstimatorConfig config;
    config.method = row.method;
    config.channels = row.channels;
    if (row.method == Method::kf) {
        config.lateral_regression = 1; // fitted here, as in the paper
        return {{estimate_iri(stretch, vehicle, config)}, {}};
    }
    config.sensors = row.sensors;
    return {{smoothed_iri(stretch, car_in(stretch, {.vehicle = vehicle}, config), config)}, {}};
}

} // namespace

std::vector<Reading> readings_on(const LanePlan& plan) {
    const auto lane = lane_of(plan);
    const auto stretch = stretch_over(lane.under_car, lane.drive);
    const auto vehicle = stated_car();
    std::vector<Reading> readings;
    for (const auto& piece : lane.pieces) {
        const double at_m = piece.from_m + piece.shift_m;
        readings.push_back(
            {.reference = piece.reference_mm_per_m,
             .driven = true_over(
                 lane.driven, testing::Index::mri, piece.from_m, piece.from_m + segment_m),
             .matched = true_over(lane.driven, testing::Index::mri, at_m, at_m + segment_m),
             .estimate = {},
             .sd = {},
             .at_true_place = {}});
    }
    for (std::size_t row = 0; row < methods.size(); ++row) {
        const auto trace = trace_of(methods[row], stretch, vehicle);
        for (std::size_t i = 0; i < readings.size(); ++i) {
            const auto& piece = lane.pieces[i];
            const auto said = said_of(trace, piece.from_m + piece.shift_m, vehicle);
            readings[i].estimate[row] = said.iri;
            readings[i].sd[row] = said.sd;
            readings[i].at_true_place[row] = said_of(trace, piece.from_m, vehicle).iri;
        }
    }
    return readings;
}

Fitted fitted(std::vector<Reading> readings) {
    Fitted result{.readings = std::move(readings), .factor = {}};
    for (std::size_t row = 0; row < methods.size(); ++row) {
        double product = 0;
        double square = 0;
        for (std::size_t i = 0; i < result.readings.size(); i += 10) {
            const auto& reading = result.readings[i];
            product += reading.estimate[row] * reading.reference;
            square += reading.estimate[row] * reading.estimate[row];
        }
        const double factor = methods[row].fitted ? product / square : 1;
        result.factor[row] = factor;
        for (auto& reading : result.readings) {
            reading.estimate[row] *= factor;
            reading.at_true_place[row] *= factor;
            reading.sd[row] *= factor;
        }
    }
    return result;
}

} // namespace macadam::field_test
