#pragma once

#include "mapping/network/road_network.hpp"
#include "mapping/network/segment.hpp"
#include "storage/store/road_store.hpp"

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <unistd.h>

namespace macadam::bench {

/// Goes with the program.
class ScratchFolder {
public:
    explicit ScratchFolder(std::string_view name)
        : path_{std::filesystem::temp_directory_path() /
                (std::string{name} + "_" + std::to_string(getpid()))} {
        std::filesystem::create_directories(path_);
    }
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;
    ~ScratchFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }

    std::filesystem::path operator/(std::string_view name) const { return path_ / name; }

private:
    std::filesystem::path path_;
};

/// Of all segments that can be driven, link by link, forward before backward.
inline std::vector<SegmentKey> keys_of(const RoadNetwork& roads) {
    std::vector<SegmentKey> keys;
    for (std::uint32_t i = 0; i < link_count(roads); ++i) {
        for (const bool forward : {true, false}) {
            if (const auto edge = edge_of(LinkId{i}, forward); is_drivable(roads, edge)) {
                for (const auto& segment : segments_of(roads, edge)) {
                    keys.push_back(segment.key);
                }
            }
        }
    }
    return keys;
}

/// A good reading of one sensor. \param number  of the pass in its trip.
inline Pass pass_over(const SegmentKey& key, std::int64_t number, IriUm um) {
    return {.segment = key,
            .occurrence = 0,
            .iri_left_um = {},
            .iri_right_um = {},
            .iri_centre_um = um,
            .iri_um = um,
            .sd_um = um / 5,
            .centre_only = true,
            .validity = 0,
            .speed_mmps = 14000,
            .covered_mm = 20000,
            .confidence_ppm = 990000,
            .t_ms = number * 1400};
}

/// One over each. \param um_of  of each number, what it reads.
template <typename UmOf>
std::vector<Pass> passes_over(std::span<const SegmentKey> keys, const UmOf& um_of) {
    std::vector<Pass> passes;
    for (const auto& key : keys) {
        const auto number = static_cast<std::int64_t>(passes.size());
        passes.push_back(pass_over(key, number, static_cast<IriUm>(um_of(number))));
    }
    return passes;
}

/// Of one of twenty cars, an hour after the one before.
inline TripRecord trip_number(int number) {
    const auto digits = std::to_string(number);
    TripRecord trip;
    trip.trip_id = "trip-" + digits;
    trip.sha256 = std::string(64 - digits.size(), '0') + digits;
    trip.vehicle_id = "car-" + std::to_string(number % 20);
    trip.t0_utc_ms = 1'767'225'600'000 + 3'600'000LL * number;
    return trip;
}

inline void add_trip(RoadStore& store,
                     const TripRecord& trip,
                     std::span<const Pass> passes,
                     std::span<const RoughnessTrace> traces = {}) {
    const NewTrip one{&trip, passes, traces};
    store.importer.add_trips({&one, 1});
}

} // namespace macadam::bench
