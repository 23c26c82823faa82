#pragma once

#include "support/roads/store_world.hpp"

#include <cmath>
#include <cstddef>
#include <vector>

namespace macadam::testing {

/// What a trip says where car `number` % 3 reads all 1.25 times too high if it is car 0.
inline std::vector<Pass> passes_of_fleet(int number) {
    auto passes = passes_of(1000); // all cars over the same road
    const double gain = number % 3 == 0 ? 1.25 : 1;
    for (std::size_t i = 0; i < passes.size(); ++i) {
        const double rest =
            1 + 0.02 * static_cast<double>((i * 7 + unsigned(number) * 13) % 5) - 0.04;
        passes[i].iri_um =
            static_cast<IriUm>(std::lround((1000 + 300 * double(i % 10)) * gain * rest));
        passes[i].sd_um = passes[i].iri_um / 10;
    }
    return passes;
}

inline void add_of_fleet(RoadStore& store, int number) {
    add_trip(store, trip_record(number), passes_of_fleet(number));
}

/// A store of trips 0 to `count` - 1 of that fleet, fused.
inline RoadStore fleet_store(const std::filesystem::path& file, int count) {
    auto store = new_store(file);
    for (int number = 0; number < count; ++number) {
        add_of_fleet(store, number);
    }
    store.importer.refresh();
    return store;
}

} // namespace macadam::testing
