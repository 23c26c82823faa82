#include "crowd_town.hpp"

#include "mapping/network/build_network.hpp"
#include "mapping/privacy/trip_trimming.hpp"
#include "storage/files/sha256.hpp"
#include "storage/store/privacy/crowd_trim.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <queue>
#include <utility>

namespace macadam::testing {
namespace {

constexpr GeoPoint corner{47.5, 19.0};
constexpr double lat_m = 111'180; // metres per degree there, about
constexpr double lon_m = 75'300;
constexpr double speed_mps = 12;
constexpr std::int64_t day_ms = 86'400'000;

bool is_arterial(int a, int b) {
    const bool along_row = a / town_side == b / town_side;
    const int line = along_row ? a / town_side : a % town_side;
    return line % arterial_every == 2;
}

std::vector<int> neighbours(int crossing) {
    std::vector<int> others;
    const int column = crossing % town_side;
    const int row = crossing / town_side;
    if (column > 0) {
        others.push_back(crossing - 1);
    }
    if (column + 1 < town_side) {
        others.push_back(crossing + 1);
    }
    if (row > 0) {
        others.push_back(crossing - town_side);
    }
    if (row + 1 < town_side) {
        others.push_back(crossing + town_side);
    }
    return others;
}

/// Ways are numbered so that their ends are known by them.
std::int64_t way_of(int a, int b) {
    return std::int64_t{1} + 2 * std::min(a, b) + (std::abs(a - b) == 1 ? 0 : 1);
}

} // namespace

std::int64_t begin_of_month_ms(int month) {
    static constexpr int days_before[] = {0, 31, 59, 90, 120, 151, 181, 212, 243, 273, 304, 334};
    return 1'767'225'600'000 + days_before[month] * day_ms;
}

CrowdTown::CrowdTown() {
    std::vector<Way> ways;
    std::uniform_real_distribution<double> shift{-20, 20};
    for (int i = 0; i < town_side * town_side; ++i) {
        const double east_m = town_block_m * (i % town_side) + shift(random_);
        const double north_m = town_block_m * (i / town_side) + shift(random_);
        crossings_.push_back({corner.lat_deg + north_m / lat_m, corner.lon_deg + east_m / lon_m});
    }
    for (int i = 0; i < town_side * town_side; ++i) {
        for (const int other : neighbours(i)) {
            if (other > i) {
                ways.push_back({.id = way_of(i, other),
                                .name = "",
                                .highway = is_arterial(i, other) ? "primary" : "residential",
                                .node_ids = {i + 1, other + 1},
                                .line = {crossings_[static_cast<std::size_t>(i)],
                                         crossings_[static_cast<std::size_t>(other)]}});
            }
        }
    }
    roads_ = build_network(std::move(ways));

    std::vector<int> works;
    for (int i = 0; i < 5; ++i) {
        works.push_back(static_cast<int>(random_() % crossings_.size()));
    }
    for (int car = 0; car < town_cars; ++car) {
        const auto home = static_cast<int>(random_() % crossings_.size());
        cars_.push_back({home,
                         works[static_cast<std::size_t>(car) % works.size()],
                         crossings_[static_cast<std::size_t>(home)]});
    }
}

std::vector<int> CrowdTown::way_between(int from, int to) const {
    using Entry = std::pair<double, int>;
    std::map<int, double> cost;
    std::map<int, int> before;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
    cost[from] = 0;
    open.emplace(0, from);
    while (!open.empty()) {
        const auto [so_far, here] = open.top();
        open.pop();
        if (here == to) {
            break;
        }
        if (so_far > cost[here]) {
            continue;
        }
        for (const int next : neighbours(here)) {
            const double there = so_far + (is_arterial(here, next) ? 1 : 2.5);
            if (const auto known = cost.find(next); known == cost.end() || there < known->second) {
                cost[next] = there;
                before[next] = here;
                open.emplace(there, next);
            }
        }
    }
    std::vector<int> way{to};
    while (way.back() != from) {
        way.push_back(before.at(way.back()));
    }
    std::ranges::reverse(way);
    return way;
}

CrowdTrip CrowdTown::drive(int car, int month, int from, int to, const PrivacyKey& key) {
    const auto number = trips_++;
    Sha256 hash;
    hash.add("crowd trip " + std::to_string(number));
    CrowdTrip trip{.car = car,
                   .month = month,
                   .begin = crossings_[static_cast<std::size_t>(from)],
                   .end = crossings_[static_cast<std::size_t>(to)],
                   .driven = {},
                   .kept = {},
                   .sha256 = hash.hex()};
    TripLog log;
    log.sha256 = trip.sha256;
    Odometer::Knots knots;
    std::vector<std::pair<double, double>> spans; // travel of the driven segments
    double travel_m = 0;
    const auto way = way_between(from, to);
    for (std::size_t i = 1; i < way.size(); ++i) {
        const bool forward = way[i] > way[i - 1];
        const auto id = way_of(way[i - 1], way[i]);
        const auto ways = roads_.ways.first(way_count(roads_));
        const auto found = std::ranges::lower_bound(ways, id, {}, &PackedWay::id);
        const auto view = way_at(roads_, static_cast<std::uint32_t>(found - ways.begin()));
        const auto edge = edge_of(LinkId{view.first_link}, forward);
        for (const auto& segment : segments_of(roads_, edge)) {
            const double length_m = segment.to_m - segment.from_m;
            trip.driven.push_back(segment.key);
            spans.emplace_back(travel_m, travel_m + length_m);
            knots.t_s.push_back(travel_m / speed_mps);
            knots.travel_m.push_back(travel_m);
            knots.speed_mps.push_back(speed_mps);
            knots.reversing.push_back(0);
            log.fixes.push_back({travel_m / speed_mps, segment.line.front(), 0, 0, 3});
            travel_m += length_m;
        }
    }
    if (spans.empty()) {
        return trip;
    }
    knots.t_s.push_back(travel_m / speed_mps);
    knots.travel_m.push_back(travel_m);
    knots.speed_mps.push_back(speed_mps);
    knots.reversing.push_back(0);
    log.fixes.push_back({travel_m / speed_mps, trip.end, 0, 0, 3});

    const auto parts = kept_parts(log, Odometer{std::move(knots)}, crowd_trim(key));
    std::normal_distribution<double> scatter{0, 60};
    for (std::size_t i = 0; i < spans.size(); ++i) {
        const auto& [from_m, to_m] = spans[i];
        const bool is_kept =
            std::ranges::any_of(parts, [&, a = from_m, b = to_m](const auto& part) {
                return part.from_m <= a && b <= part.to_m;
            });
        if (is_kept) {
            const auto& segment = trip.driven[i];
            const auto iri_um = 2000 + static_cast<IriUm>(segment.way_id % 17) * 100 +
                                static_cast<IriUm>(scatter(random_));
            trip.kept.push_back({.segment = segment,
                                 .occurrence = 0,
                                 .iri_left_um = std::nullopt,
                                 .iri_right_um = std::nullopt,
                                 .iri_centre_um = std::nullopt,
                                 .iri_um = iri_um,
                                 .sd_um = 200,
                                 .centre_only = false,
                                 .validity = 0,
                                 .speed_mmps = 12'000,
                                 .covered_mm = 20'000,
                                 .confidence_ppm = 990'000,
                                 .t_ms = std::llround(1000 * from_m / speed_mps)});
        }
    }
    return trip;
}

std::vector<CrowdTrip> CrowdTown::trips_of(int month, const PrivacyKey& key, int active) {
    std::vector<CrowdTrip> trips;
    for (int car = 0; car < active; ++car) {
        const auto& [home, work, at] = cars_[static_cast<std::size_t>(car)];
        trips.push_back(drive(car, month, home, work, key));
        trips.push_back(drive(car, month, work, home, key));
        if (random_() % 2 == 0) {
            const auto shop = static_cast<int>(random_() % crossings_.size());
            trips.push_back(drive(car, month, home, shop, key));
            trips.push_back(drive(car, month, shop, home, key));
        }
    }
    return trips;
}

GeoPoint CrowdTown::middle_of(const SegmentKey& segment) const {
    const auto ways = roads_.ways.first(way_count(roads_));
    const auto found = std::ranges::lower_bound(ways, segment.way_id, {}, &PackedWay::id);
    const auto view = way_at(roads_, static_cast<std::uint32_t>(found - ways.begin()));
    const auto edge = edge_of(LinkId{view.first_link}, true);
    const auto link = link_at(roads_, edge);
    return place_on(
        roads_, edge, (segment.index + 0.5) * (link.to_m - link.from_m) / link.segments);
}

void add_to(RoadStore& store, const std::vector<CrowdTrip>& trips) {
    std::vector<TripRecord> records;
    for (const auto& trip : trips) {
        TripRecord record;
        record.sha256 = trip.sha256;
        record.trip_id = trip.sha256.substr(0, 8);
        record.vehicle_id = "car " + std::to_string(trip.car);
        record.t0_utc_ms = begin_of_month_ms(trip.month) + (1 + trip.car % 25) * day_ms;
        record.vehicle_model = "generic";
        record.method = "smoother";
        records.push_back(record);
    }
    std::vector<NewTrip> together;
    for (std::size_t i = 0; i < trips.size(); ++i) {
        together.push_back({&records[i], trips[i].kept, {}});
    }
    store.importer.add_trips(together);
}

} // namespace macadam::testing
