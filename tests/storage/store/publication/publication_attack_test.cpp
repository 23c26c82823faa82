#include "crowd_town.hpp"
#include "support/files/files.hpp"

#include "mapping/privacy/drive_ends.hpp"
#include "mapping/privacy/network_blocks.hpp"
#include "storage/sqlite/sqlite.hpp"
#include "storage/store/privacy/privacy_key.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <map>
#include <optional>
#include <ranges>
#include <set>
#include <tuple>

namespace macadam {
namespace {

using testing::CrowdTrip;

constexpr int months = 4;
constexpr std::size_t min_cars = 5;
constexpr int forgotten_car = 9;
constexpr int forgotten_after = 2; // month, before its publication

struct Figure {
    std::int64_t number;
    std::int64_t publication;
    std::int64_t from_ms;
    std::int64_t until_ms;
};

/// What an outsider has after each publication.
struct Snapshot {
    std::map<SegmentKey, SegmentState> states;
    std::map<SegmentKey, std::vector<Figure>> figures;
};

Snapshot snapshot_of(const std::filesystem::path& file) {
    Snapshot snapshot;
    const auto store = StoreReader::open(file);
    store.visit({}, [&](const SegmentRecord& record) {
        snapshot.states[record.segment.key] = *record.state;
    });
    Database database{file, Database::Access::read};
    auto select = database.prepare(
        "SELECT way_id, direction, seq, number, publication, from_ms, until_ms"
        " FROM published_figure JOIN segment ON segment.fid = published_figure.segment"
        " ORDER BY published_figure.segment, number");
    while (select.step()) {
        const SegmentKey key{select.integer(0),
                             select.text(1) == "forward",
                             static_cast<std::uint32_t>(select.integer(2))};
        snapshot.figures[key].push_back(
            {select.integer(3), select.integer(4), select.integer(5), select.integer(6)});
    }
    return snapshot;
}

/// The town, its publications, and what is really behind them.
struct World {
    testing::CrowdTown town;
    std::vector<CrowdTrip> trips;
    std::vector<Snapshot> published;
};

const World& world() {
    static const World made = [] {
        World it;
        const auto file = testing::test_folder() / "crowd.gpkg";
        PrivacyKey::Bytes bytes{};
        std::ranges::iota_view numbers{0, int{bytes.size()}};
        std::ranges::transform(numbers, bytes.begin(), [](int number) {
            return static_cast<unsigned char>(7 * number);
        });
        write_key(key_file_of(file), PrivacyKey{bytes}); // the same holds in each run
        auto store = RoadStore::create(
            file,
            it.town.roads(),
            {.network_source = "town", .attribution = "", .privacy = PrivacyProfile::crowd});
        for (int month = 0; month < months; ++month) {
            // Some cars join only later, one after the other.
            const int active = testing::town_cars - 3 * (months - 1 - month);
            const auto trips = it.town.trips_of(month, *store.key(), active);
            it.trips.insert(it.trips.end(), trips.begin(), trips.end());
            testing::add_to(store, trips);
            if (month == forgotten_after) {
                ForgetRequest request;
                request.vehicles = {"car " + std::to_string(forgotten_car)};
                store.maintenance.forget(request);
            }
            store.maintenance.publish(it.town.roads(), testing::begin_of_month_ms(month + 1));
            it.published.push_back(snapshot_of(file));
        }
        return it;
    }();
    return made;
}

/// Trips over each segment whose passes there may be published.
std::map<SegmentKey, std::vector<const CrowdTrip*>> trips_on_segments() {
    const NetworkBlocks blocks{world().town.roads()};
    std::map<SegmentKey, std::vector<const CrowdTrip*>> on;
    for (const auto& trip : world().trips) {
        std::vector<BlockVisit> visits;
        for (const auto& pass : trip.kept) {
            visits.push_back({pass.t_ms, blocks.block_of(pass.segment)});
        }
        const auto at_end = in_end_blocks(visits);
        for (std::size_t i = 0; i < trip.kept.size(); ++i) {
            if (!at_end[i]) {
                on[trip.kept[i].segment].push_back(&trip);
            }
        }
    }
    return on;
}

bool was_in_store(const CrowdTrip& trip, std::int64_t publication) {
    const bool was_forgotten =
        trip.car == forgotten_car && trip.month <= forgotten_after && publication > forgotten_after;
    return trip.month < publication && !was_forgotten;
}

void expect_five_cars_behind_each_figure_of_each_time() {
    const auto on = trips_on_segments();
    for (const auto& [segment, figures] : world().published.back().figures) {
        std::set<const CrowdTrip*> told;
        for (const auto& figure : figures) {
            std::set<int> cars;
            for (const auto* trip : on.at(segment)) {
                const auto t_ms = testing::begin_of_month_ms(trip->month);
                if (was_in_store(*trip, figure.publication) && t_ms >= figure.from_ms &&
                    t_ms < figure.until_ms && told.insert(trip).second) {
                    cars.insert(trip->car);
                }
            }
            ASSERT_GE(cars.size(), min_cars) << name_of(segment) << " figure " << figure.number;
        }
    }
}

void expect_no_difference_of_two_publications_that_is_of_fewer_cars() {
    const auto& published = world().published;
    std::size_t changed = 0;
    for (std::size_t i = 1; i < published.size(); ++i) {
        for (const auto& [segment, state] : published[i].states) {
            const auto before = published[i - 1].states.find(segment);
            if (before == published[i - 1].states.end() || before->second == state) {
                continue;
            }
            ++changed;
            const auto& figures = published[i].figures.at(segment);
            EXPECT_EQ(figures.back().publication, static_cast<std::int64_t>(i + 1))
                << name_of(segment) << " changed without five cars' passes";
        }
        for (const auto& [segment, state] : published[i - 1].states) {
            EXPECT_TRUE(published[i].states.contains(segment)) << name_of(segment) << " went";
        }
    }
    EXPECT_GT(changed, 1000U) << "nothing to compare";
}

void expect_figures_once_told_as_they_were() {
    const auto& published = world().published;
    for (std::size_t i = 1; i < published.size(); ++i) {
        for (const auto& [segment, before] : published[i - 1].figures) {
            const auto& now = published[i].figures.at(segment);
            ASSERT_GE(now.size(), before.size());
            for (std::size_t k = 0; k < before.size(); ++k) {
                EXPECT_EQ(now[k].from_ms, before[k].from_ms);
                EXPECT_EQ(now[k].publication, before[k].publication);
            }
        }
    }
}

/// What appears at once is what some cars did that month: an attacker takes a connected path of it
/// for one car's trip.
void expect_no_trip_in_what_appears_at_once() {
    const auto& published = world().published;
    const auto on = trips_on_segments();
    for (std::size_t i = 1; i < published.size(); ++i) {
        const auto month = static_cast<int>(i);
        std::set<SegmentKey> appeared;
        for (const auto& [segment, state] : published[i].states) {
            if (!published[i - 1].states.contains(segment)) {
                appeared.insert(segment);
            }
        }
        for (const auto& trip : world().trips) {
            if (trip.month != month) {
                continue;
            }
            std::size_t of_it_alone = 0; // segments in a row that nobody else drove that month
            std::size_t longest = 0;
            for (const auto& segment : trip.driven) {
                const bool alone = appeared.contains(segment) &&
                                   std::ranges::all_of(on.at(segment), [&](const CrowdTrip* other) {
                                       return other->month != month || other->car == trip.car;
                                   });
                of_it_alone = alone ? of_it_alone + 1 : 0;
                longest = std::max(longest, of_it_alone);
            }
            EXPECT_LE(longest * 20, 500U) << "car " << trip.car << " month " << month;
        }
    }
}

void expect_no_end_of_a_run_within_a_block() {
    const NetworkBlocks blocks{world().town.roads()};
    for (const auto& snapshot : world().published) {
        std::map<std::uint64_t, int> shown;
        for (const auto& [segment, state] : snapshot.states) {
            ++shown[blocks.block_of(segment)];
        }
        std::map<std::uint64_t, int> whole;
        for (const auto& trip : world().trips) {
            for (const auto& segment : std::set(trip.driven.begin(), trip.driven.end())) {
                whole[blocks.block_of(segment)] =
                    std::max(whole[blocks.block_of(segment)], static_cast<int>(segment.index) + 1);
            }
        }
        for (const auto& [block, count] : shown) {
            EXPECT_EQ(count, whole.at(block)) << "block " << block;
        }
    }
}

void expect_no_end_of_a_car_within_three_hundred_metres_of_its_home() {
    for (const auto& trip : world().trips) {
        if (trip.kept.empty()) {
            continue;
        }
        const auto& town = world().town;
        EXPECT_GE(distance_m(town.middle_of(trip.kept.front().segment), trip.begin), 300);
        EXPECT_GE(distance_m(town.middle_of(trip.kept.back().segment), trip.end), 300);
    }
}

void expect_no_exact_counts_and_no_days() {
    for (const auto& [segment, state] : world().published.back().states) {
        EXPECT_THAT(state.vehicles, ::testing::AnyOf(5, 10, 20, 50)) << name_of(segment);
        ASSERT_TRUE(state.first_seen_ms && state.last_seen_ms);
        for (const auto t_ms : {*state.first_seen_ms, *state.last_seen_ms}) {
            EXPECT_TRUE(
                t_ms == testing::begin_of_month_ms(0) || t_ms == testing::begin_of_month_ms(1) ||
                t_ms == testing::begin_of_month_ms(2) || t_ms == testing::begin_of_month_ms(3));
        }
    }
}

void expect_four_fifths_shown() {
    std::map<SegmentKey, std::set<int>> cars;
    std::map<SegmentKey, std::set<int>> cars_untrimmed;
    for (const auto& trip : world().trips) {
        for (const auto& segment : trip.driven) {
            cars_untrimmed[segment].insert(trip.car);
        }
        for (const auto& pass : trip.kept) {
            cars[pass.segment].insert(trip.car);
        }
    }
    const auto& shown = world().published.back().states;
    const auto share_of = [&](const auto& driven) {
        double many = 0;
        double seen = 0;
        for (const auto& [segment, by] : driven) {
            if (by.size() >= min_cars) {
                ++many;
                seen += shown.contains(segment) ? 1 : 0;
            }
        }
        return seen / many;
    };
    ::testing::Test::RecordProperty("share_of_driven", std::to_string(share_of(cars_untrimmed)));
    ::testing::Test::RecordProperty("share_of_kept", std::to_string(share_of(cars)));
    EXPECT_GE(share_of(cars), 0.8);
    EXPECT_GE(share_of(cars_untrimmed), 0.6); // ends that are trimmed are driven by few
}

// One test: the town takes longer to make than to attack.
TEST(PublicationAttack, FindsNeitherATripNorAHome) {
    expect_five_cars_behind_each_figure_of_each_time();
    expect_no_difference_of_two_publications_that_is_of_fewer_cars();
    expect_figures_once_told_as_they_were();
    expect_no_trip_in_what_appears_at_once();
    expect_no_end_of_a_run_within_a_block();
    expect_no_end_of_a_car_within_three_hundred_metres_of_its_home();
    expect_no_exact_counts_and_no_days();
    expect_four_fifths_shown();
}

} // namespace
} // namespace macadam
