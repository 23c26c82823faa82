#include "store_world.hpp"
#include "mapping/network/build_network.hpp"

#include "road_art.hpp"
#include "storage/files/sha256.hpp"

#include <random>

namespace macadam::testing {

RoadNetwork small_country() {
    auto ways = road_art(R"(
        A---------B---------C
                  |
        D---------E
    )",
                         10,
                         {"ABC", "BE>", "ED"})
                    .ways;
    ways[0].name = "Rue de l'Épée 100%";
    ways[0].highway = "residential";
    ways[1].name = "=HYPERLINK(\"x\"), _Lane_";
    ways[1].highway = "service";
    ways[0].turns = {{ways[0].node_ids.back(), 1, 0}};
    ways[1].speed_limit_cmps = 833;
    ways[2].name = "";
    ways[2].highway = "";
    return build_network(std::move(ways), 20);
}

StoreSettings settings() {
    return {.segment_length_m = 20,
            .class_table = "fhwa",
            .network_source = "country.osm",
            .attribution = "© \"Mappers\""};
}

RoadStore new_store(const std::filesystem::path& file) {
    return RoadStore::create(file, small_country(), settings());
}

TripRecord trip_record(int number) {
    Sha256 hash;
    hash.add("trip " + std::to_string(number));
    TripRecord trip{.sha256 = hash.hex(),
                    .trip_id = "trip-" + std::to_string(number),
                    .vehicle_id = "car-" + std::to_string(number % 3),
                    .file_name = "trip" + std::to_string(number) + ".trip.csv",
                    .t0_utc_ms = std::nullopt,
                    .vehicle_model = "golden-car",
                    .method = "kf"};
    if (number % 4 != 3) {
        trip.t0_utc_ms = 1'760'000'000'123 + number * std::int64_t{100} * 86'400'000;
    }
    return trip;
}

std::vector<Pass> passes_of(int number) {
    std::mt19937 random{static_cast<unsigned>(number)};
    const auto in = [&](int low, int high) {
        return low + static_cast<int>(random() % static_cast<unsigned>(high - low));
    };
    std::vector<Pass> passes;
    for (const bool forward : {true, false}) {
        for (std::uint32_t index = 0; index < 10; ++index) {
            const int left = in(800, 5000), right = in(800, 5000);
            passes.push_back({.segment = {1, forward, index},
                              .occurrence = 0,
                              .iri_left_um = left,
                              .iri_right_um = right,
                              .iri_centre_um = std::nullopt,
                              .iri_um = (left + right) / 2,
                              .sd_um = in(50, 400),
                              .centre_only = false,
                              .validity = 0,
                              .speed_mmps = in(5000, 30000),
                              .covered_mm = 20000,
                              .confidence_ppm = 990000,
                              .t_ms = 1000 * index});
        }
    }
    return passes;
}

bool add_trip(RoadStore& store,
              const TripRecord& trip,
              std::span<const Pass> passes,
              std::span<const RoughnessTrace> traces,
              const std::optional<std::span<const PassEvent>>& events) {
    const NewTrip one{&trip, passes, traces, false, events};
    return store.importer.add_trips({&one, 1}).front();
}

bool stage_trip(RoadStore& store,
                const TripRecord& trip,
                std::span<const Pass> passes,
                std::span<const RoughnessTrace> traces,
                const std::optional<std::span<const PassEvent>>& events) {
    return store.maintenance.stage_trip({&trip, passes, traces, false, events});
}

void import_trips(RoadStore& store, int count) {
    for (int number = 0; number < count; ++number) {
        add_trip(store, trip_record(number), passes_of(number));
    }
    store.importer.refresh();
}

void import_trimmed_trips(RoadStore& store) {
    const std::vector<PassEvent> events{{.segment = {1, true, 2},
                                         .occurrence = 0,
                                         .kind = EventKind::pothole,
                                         .track = WheelTrack::unknown,
                                         .at_mm = 45'000,
                                         .place_sd_mm = 1000,
                                         .size_um = 30'000,
                                         .sd_um = 9'500,
                                         .length_mm = 750}};
    for (const int number : {4, 5, 6}) {
        auto trip = trip_record(number);
        trip.trimmed_mm = 1'000'000;
        add_trip(store, trip, passes_of(number), {}, events);
    }
    store.importer.refresh();
}

} // namespace macadam::testing
