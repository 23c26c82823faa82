#include "support/roads/crowd_drives.hpp"

#include "mapping/network/build_network.hpp"
#include "support/roads/store_world.hpp"

#include <string>
#include <utility>

namespace macadam::testing {

RoadNetwork roads_in_a_row(int roads) {
    constexpr double length_deg = 0.00254; // 200 m at this latitude
    std::vector<Way> ways;
    for (int way = 1; way <= roads; ++way) {
        ways.push_back(
            {.id = way,
             .name = "",
             .highway = "primary",
             .node_ids = {way, way + 1},
             .line = {{45.0, 5.0 + length_deg * (way - 1)}, {45.0, 5.0 + length_deg * way}}});
    }
    return build_network(std::move(ways));
}

TripRecord CrowdDrive::record() const {
    auto record = trip_record(1000 + number);
    record.vehicle_id = "car " + std::to_string(car);
    record.t0_utc_ms = utc_ms;
    return record;
}

std::vector<Pass> CrowdDrive::passes() const {
    std::vector<Pass> passes;
    for (std::int64_t way = first_road; way < first_road + roads; ++way) {
        for (std::uint32_t index = 0; index < 10; ++index) {
            auto pass = passes_of(1).front();
            pass.segment = {way, true, index};
            pass.iri_left_um = pass.iri_right_um = std::nullopt;
            pass.iri_um = iri_um;
            pass.sd_um = 100;
            pass.t_ms = 1000 * (10 * way + index);
            passes.push_back(pass);
        }
    }
    return passes;
}

std::vector<PassEvent> CrowdDrive::events() const {
    std::vector<PassEvent> events;
    for (std::int64_t way = 1; reports_holes && way <= 2; ++way) {
        events.push_back({.segment = {way, true, 2},
                          .occurrence = 0,
                          .kind = EventKind::pothole,
                          .track = WheelTrack::unknown,
                          .at_mm = 55'300,
                          .place_sd_mm = 800,
                          .size_um = 31'000,
                          .sd_um = 9'000});
    }
    return events;
}

} // namespace macadam::testing
