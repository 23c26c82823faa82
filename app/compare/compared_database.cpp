#include "app/compare/compared_database.hpp"

#include "estimator/common/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace macadam {
namespace {

/// Mean of passes, weighted by the inverse of their variances.
struct WeightedPasses {
    double sum = 0;
    double weight = 0;

    void add(const Pass& pass) {
        if (pass.sd_um <= 0) {
            return; // of a damaged database: its weight would be infinite
        }
        const double sd = static_cast<double>(pass.sd_um) / 1000;
        weight += 1 / (sd * sd);
        sum += static_cast<double>(pass.iri_um) / 1000 / (sd * sd);
    }
    double mean() const { return sum / weight; }
};

/// Tests whether a pass is chosen, by the borders that the store has for states of a period.
bool is_chosen(const PassesOfInterest& of, const HistoricPass& historic) {
    const auto& [period, car] = of;
    const auto& utc_ms = historic.utc_ms;
    const bool in_period = !period || (utc_ms && !(period->from_ms && *utc_ms < *period->from_ms) &&
                                       !(period->until_ms && *utc_ms >= *period->until_ms));
    return in_period && (car.empty() || historic.vehicle == car);
}

std::map<std::string, double> iri_by_car(const std::vector<HistoricPass>& passes) {
    std::map<std::string, WeightedPasses> cars;
    for (const auto& historic : passes) {
        if (!historic.reference) {
            cars[historic.vehicle].add(historic.pass);
        }
    }
    std::map<std::string, double> means;
    for (const auto& [car, sums] : cars) {
        if (sums.weight > 0) {
            means.emplace(car, sums.mean());
        }
    }
    return means;
}

std::optional<double> mean_speed_kmh(const std::vector<HistoricPass>& passes) {
    constexpr double kmh_of_mmps = 3.6e-3;
    double sum = 0, count = 0;
    for (const auto& historic : passes) {
        if (!historic.reference && historic.pass.speed_mmps > 0) {
            sum += kmh_of_mmps * historic.pass.speed_mmps;
            ++count;
        }
    }
    return count > 0 ? std::optional{sum / count} : std::nullopt;
}

} // namespace

SourceSegments segments_by_cars(const StoreReader& store, SegmentFilter filter) {
    filter.cars_alone = !store.surveys().empty();
    SourceSegments segments;
    store.visit(filter, [&](const SegmentRecord& record) {
        const auto& [key, from_m, to_m, line] = record.segment;
        if (record.state) {
            segments.emplace(key,
                             SourceSegment{static_cast<double>(record.state->iri_um) / 1000,
                                           from_m,
                                           to_m,
                                           record.highway});
        }
    });
    return segments;
}

SourceSegments
segments_by_car(const StoreReader& store, const SegmentFilter& filter, const std::string& car) {
    if (filter.period) {
        throw InputError{"--since and --until select passes of all cars; they cannot be combined "
                         "with --car-a and --car-b"};
    }
    SourceSegments segments;
    for (auto& [key, segment] : segments_by_cars(store, filter)) {
        const auto cars = iri_by_car(store.history(key));
        if (const auto found = cars.find(car); found != cars.end()) {
            segment.iri = found->second;
            segments.emplace(key, std::move(segment));
        }
    }
    return segments;
}

std::optional<PassesOfCars> passes_of_cars(const StoreReader& store,
                                           const std::vector<AgreementPair>& pairs,
                                           const PassesOfInterest& of) {
    if (store.settings().privacy == PrivacyProfile::crowd) {
        return std::nullopt;
    }
    PassesOfCars passes;
    for (const auto& pair : pairs) {
        auto history = store.history(pair.segment);
        std::erase_if(history, [&](const HistoricPass& pass) { return !is_chosen(of, pass); });
        passes.speed_kmh.push_back(mean_speed_kmh(history));
        passes.iri_by_car.push_back(iri_by_car(history));
    }
    return passes;
}

} // namespace macadam
