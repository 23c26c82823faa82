#include "mapping/fusion/pass_observations.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace macadam {
namespace {

constexpr double um_per_mm = 1000;
constexpr double survey_share = 0.5; // of a reference's variance: common to all its rows on a road

using Eigen::Index;
using Eigen::VectorXd;

/// Groups consecutive passes for which `alike` holds.
template <typename Alike>
std::vector<FusionObservations::Block> runs_of(const std::vector<const FusionInput*>& passes,
                                               const Alike& alike) {
    std::vector<FusionObservations::Block> runs;
    for (std::size_t i = 0; i < passes.size(); ++i) {
        if (i == 0 || !alike(*passes[i - 1], *passes[i])) {
            runs.push_back({static_cast<Index>(i), 0});
        }
        ++runs.back().count;
    }
    return runs;
}

} // namespace

double true_um(const FusionInput& input, double read_um) {
    return input.calibration
               ? std::max(0.0, (read_um - input.calibration->offset_um) / input.calibration->gain)
               : read_um;
}

std::vector<const FusionInput*> by_car(std::span<const FusionInput> passes) {
    struct CarPass {
        std::size_t first; ///< first pass of the car
        std::int64_t vehicle;
        std::uint32_t period;
        std::size_t pass;
    };
    std::vector<CarPass> places;
    places.reserve(passes.size());
    for (std::size_t i = 0; i < passes.size(); ++i) {
        places.push_back({i, passes[i].vehicle, passes[i].period, i});
    }
    std::ranges::sort(places, {}, [](const CarPass& place) {
        return std::pair{place.vehicle, place.pass};
    });
    for (std::size_t i = 1; i < places.size(); ++i) {
        if (places[i].vehicle == places[i - 1].vehicle) {
            places[i].first = places[i - 1].first;
        }
    }
    std::ranges::sort(places, {}, [](const CarPass& place) {
        return std::tuple{place.first, place.period, place.pass};
    });
    std::vector<const FusionInput*> sorted;
    sorted.reserve(passes.size());
    for (const auto& place : places) {
        sorted.push_back(&passes[place.pass]);
    }
    return sorted;
}

VectorXd values_of(const std::vector<const FusionInput*>& passes) {
    VectorXd values(static_cast<Index>(passes.size()));
    std::ranges::transform(passes, values.begin(), [](const FusionInput* input) {
        return true_um(*input, input->pass.iri_um);
    });
    return values;
}

VectorXd stated_um(const std::vector<const FusionInput*>& passes, double level_um) {
    VectorXd stated(static_cast<Index>(passes.size()));
    std::ranges::transform(passes, stated.begin(), [&](const FusionInput* input) {
        return input->pass.sd_um * level_um / std::max<double>(1, input->pass.iri_um);
    });
    return stated;
}

VectorXd of_cars_alone(const std::vector<const FusionInput*>& passes, VectorXd values) {
    for (std::size_t i = 0; i < passes.size(); ++i) {
        if (passes[i]->reference) {
            values[static_cast<Index>(i)] = 0;
        }
    }
    return values;
}

StatedParts stated_parts(const std::vector<const FusionInput*>& passes,
                         const VectorXd& stated,
                         double level_um,
                         const FusionConfig& config) {
    StatedParts parts{VectorXd::Zero(stated.size()), VectorXd::Zero(stated.size())};
    for (Index i = 0; i < stated.size(); ++i) {
        const auto& input = *passes[static_cast<std::size_t>(i)];
        const double share = config.common_share * stated[i] * stated[i];
        const bool is_limited =
            !input.by_filter && (input.pass.validity & validity::lateral_alone) == 0;
        const double common =
            is_limited ? std::min(share, max_common_variance_um2(level_um, config)) : share;
        parts.common[i] = input.reference ? 0 : std::sqrt(common);
        parts.car[i] = std::sqrt(share - common + config.car_share * stated[i] * stated[i]);
    }
    return parts;
}

FusionObservations observations_of(const std::vector<const FusionInput*>& passes,
                                   const VectorXd& values,
                                   const VectorXd& stated,
                                   const VectorXd& of_car,
                                   const VectorXd& beside_car,
                                   double level_um,
                                   const FusionConfig& config) {
    const auto same_car = [](const FusionInput& a, const FusionInput& b) {
        return a.vehicle == b.vehicle && a.period == b.period;
    };
    const auto same_trip = [&](const FusionInput& a, const FusionInput& b) {
        return same_car(a, b) && a.trip_sha256 == b.trip_sha256;
    };
    const double rest =
        std::hypot(config.rest_relative_sd * level_um, config.rest_sd_mm_per_m * um_per_mm);
    FusionObservations readings{.values = values,
                                .car_sd = of_car,
                                .rest_sd = VectorXd::Constant(values.size(), rest),
                                .trip_sd = config.trip_relative_sd * level_um,
                                .cars = runs_of(passes, same_car),
                                .trips = runs_of(passes, same_trip)};
    const auto input = [&](Index i) { return passes[static_cast<std::size_t>(i)]; };
    for (Index i = 0; i < values.size(); ++i) {
        if (const auto& calibration = input(i)->calibration) {
            readings.car_sd[i] = calibration->relative_sd * level_um;
            readings.rest_sd[i] *= calibration->scatter;
        }
        readings.car_sd[i] = std::hypot(readings.car_sd[i], beside_car[i]);
        if (input(i)->reference) {
            readings.car_sd[i] = std::sqrt(survey_share) * stated[i];
            readings.rest_sd[i] = std::sqrt(1 - survey_share) * stated[i];
        }
    }
    std::erase_if(readings.trips, [&](const auto& trip) { return input(trip.first)->reference; });
    return readings;
}

} // namespace macadam
