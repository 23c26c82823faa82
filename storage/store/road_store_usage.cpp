#include "storage/store/road_store_impl.hpp"
#include "storage/store/rows/segment_row.hpp"
#include "storage/text/utc.hpp"

#include <map>
#include <string>
#include <utility>

namespace macadam {

std::vector<RoadClassLength> RoadStore::road_class_lengths() const {
    Transaction one_moment{impl_->database, Transaction::Kind::read};
    auto select = impl_->database.prepare(
        "SELECT way.highway, state.class, sum(segment.to_m - segment.from_m) / 1000"
        " FROM segment_state AS state CROSS JOIN segment ON segment.fid = state.fid"
        " CROSS JOIN way ON way.way_id = segment.way_id GROUP BY 1, 2");
    std::map<std::pair<std::string, std::string>, double> km;
    while (select.step()) {
        km[{select.text(0), select.text(1)}] += select.real(2);
    }
    std::vector<RoadClassLength> lengths;
    std::map<std::string, bool> highways;
    for (const auto& [key, length_km] : km) {
        highways[key.first] = true;
    }
    for (const auto& [highway, known] : highways) {
        for (const auto& roughness : impl_->classes().classes) {
            const auto found = km.find({highway, std::string{roughness.name}});
            lengths.push_back(
                {highway, std::string{roughness.name}, found == km.end() ? 0 : found->second});
        }
    }
    return lengths;
}

std::map<SegmentKey, double> RoadStore::mean_speeds_kmh() const {
    constexpr double kmh_of_mmps = 3.6e-3;
    auto select = impl_->database.prepare(
        "SELECT way_id, direction, seq, mean FROM (SELECT pass.segment, avg(speed_mmps) AS mean"
        " FROM pass CROSS JOIN trip ON trip.id = pass.trip"
        " WHERE trip.reference_ppm IS NULL AND speed_mmps > 0 GROUP BY pass.segment) AS driven"
        " CROSS JOIN segment ON segment.fid = driven.segment");
    std::map<SegmentKey, double> speeds_kmh;
    while (select.step()) {
        const SegmentKey key{select.integer(0),
                             select.text(1) == "forward",
                             static_cast<std::uint32_t>(select.integer(2))};
        speeds_kmh[key] = kmh_of_mmps * select.real(3);
    }
    return speeds_kmh;
}

std::vector<DailyUsage> RoadStore::day_uses() const {
    auto select = impl_->database.prepare(
        "SELECT t0_utc_ms, (SELECT count(*) FROM pass WHERE pass.trip = trip.id) FROM trip"
        " WHERE t0_utc_ms IS NOT NULL AND reference_ppm IS NULL");
    std::map<std::string, DailyUsage> days;
    while (select.step()) {
        if (const auto utc_ms = known_utc_ms(select, 0)) {
            auto& day = days[utc_day(*utc_ms)];
            ++day.trips;
            day.passes += static_cast<std::size_t>(select.integer(1));
        }
    }
    std::vector<DailyUsage> uses;
    for (auto& [day, use] : days) {
        uses.push_back({day, use.trips, use.passes});
    }
    return uses;
}

} // namespace macadam
