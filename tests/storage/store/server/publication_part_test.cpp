// Publications of a crowd on a server, made from the part of the database that they may change:
// month after month the same as those of a file of the same key, which sees all.

#include "mapping/conflation/network_conflation.hpp"
#include "mapping/network/build_network.hpp"
#include "support/files/files.hpp"
#include "support/roads/crowd_drives.hpp"
#include "support/roads/engine_world.hpp"

#include <gmock/gmock.h>

#include <functional>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::Each;
using ::testing::IsEmpty;
using ::testing::Lt;
using ::testing::SizeIs;

constexpr std::int64_t month_ms = 31 * day_ms;

StoreSettings crowd() {
    StoreSettings settings;
    settings.network_source = "map";
    settings.privacy = PrivacyProfile::crowd;
    return settings;
}

void add(ImportTarget& trips, const std::vector<CrowdDrive>& drives) {
    for (const auto& drive : drives) {
        const auto record = drive.record();
        const auto passes = drive.passes();
        const auto events = drive.events();
        const NewTrip trip{&record, passes, {}, false, events};
        trips.add_trips({&trip, 1});
    }
}

class CrowdServer {
public:
    explicit CrowdServer(int roads)
        : road_count_{roads}, roads_{roads_in_a_row(roads)}, database_{Engine::postgresql,
                                                                       folder_,
                                                                       roads_,
                                                                       crowd()} {
        fs::copy_file(key_file_of(folder_ / "roads.gpkg"), key_file_of(oracle_));
        fs::rename(folder_ / "roads.gpkg", oracle_);
    }

    /// A car drives some roads in this month.
    void drive(int car, int first_road, int roads, IriUm iri_um = 2000) {
        drives_.push_back(
            {trips_++, car, now_ms() + day_ms, iri_um, first_road == 1, roads, first_road});
    }

    /// Both import what was driven.
    void import(bool fuses = true) {
        const auto file = RoadStore::open(oracle_);
        for (const auto& trips : {database_.import().trips, import_store_of(file).trips}) {
            add(*trips, drives_);
            if (fuses) {
                fuse_all(*trips);
            }
        }
        drives_.clear();
    }

    void forget(int car) {
        const ForgetRequest request{.trips = {}, .vehicles = {"car " + std::to_string(car)}};
        EXPECT_EQ(database_.forget(request).passes,
                  RoadStore::open(oracle_).maintenance.forget(request).passes);
    }

    /// All passes so far, or none, are of former surfaces of a road.
    void resurface(int road, bool is_new) {
        std::vector<SegmentKey> keys;
        for (std::uint32_t index = 0; index < 10; ++index) {
            keys.push_back({road, true, index});
        }
        const auto from_ms = is_new ? std::optional{now_ms() + 2 * day_ms} : std::nullopt;
        on_both(
            [&](StoreMaintenance& store) { store.set_valid_from(keys, from_ms, "new surface"); });
    }

    /// The last road leaves the map, or comes again.
    void update_map(bool has_last) { update_map(roads_in_a_row(road_count_ - (has_last ? 0 : 1))); }

    void update_map(const RoadNetwork& newer) {
        const auto change = change_between(roads_, newer);
        on_both([&](StoreMaintenance& store) {
            store.update_network(roads_, newer, change, {"newer map", ""});
        });
        roads_ = newer;
    }

    /// Published values of a road.
    std::vector<IriUm> seen_on(std::int64_t way) const {
        SegmentFilter filter;
        filter.way_id = way;
        std::vector<IriUm> values;
        database_.read(Audience::anyone).visit(filter, [&](const SegmentRecord& record) {
            values.push_back(record.state->iri_um);
        });
        return values;
    }

    RoadStore to_publish() const { return database_.to_publish(); }
    StoreReader read() const { return database_.read(); }
    /// As the program reads all roads while it publishes a part.
    RoadNetwork all_roads() const { return database_.import().map.roads(); }

    /// Ends the month with a publication. \returns the number of segments with new values.
    std::size_t publish() {
        ++month_;
        auto in_file = RoadStore::open(oracle_).maintenance.publish(roads_, now_ms());
        auto done = to_publish().maintenance.publish(roads_, now_ms());
        EXPECT_EQ(done.changed, in_file.changed) << "month " << month_;
        EXPECT_EQ(done.publication, in_file.publication) << "month " << month_;
        EXPECT_EQ(database_.read(Audience::anyone).digest(), StoreReader::open(oracle_).digest())
            << "month " << month_;
        return done.changed;
    }

private:
    void on_both(const std::function<void(StoreMaintenance&)>& work) const {
        auto server = database_.maintain();
        work(server.maintenance);
        auto file = RoadStore::open(oracle_);
        work(file.maintenance);
    }

    std::int64_t now_ms() const { return january_ms + month_ * month_ms; }

    fs::path folder_ = test_folder();
    fs::path oracle_ = folder_ / "oracle.gpkg";
    int road_count_;
    RoadNetwork roads_;
    EngineDatabase database_;
    std::vector<CrowdDrive> drives_; ///< not yet imported
    int trips_ = 0;
    int month_ = 0;
};

TEST(PartToPublish, GivesWhatAFileGivesWhateverHappensBetweenPublications) {
    constexpr int roads = 9, cars = 9, months = 9;
    CrowdServer crowd{roads};
    std::mt19937 random{7};
    const auto draw = [&](int below) { return static_cast<int>(random() % below); };
    std::size_t changed = 0;
    std::set<int> drove;
    for (int month = 0; month < months; ++month) {
        const int drives = month % 3 == 0 ? 12 : 3; // months in which little is driven
        for (int i = 0; i < drives; ++i) {
            const int first = 1 + draw(roads - 3);
            const int car = draw(cars);
            drove.insert(car);
            crowd.drive(car, first, 2 + draw(roads - first - 1), 1000 * (1 + draw(5)));
        }
        crowd.import(month != 4); // then it is published unfused
        if (month == 3 || month == 7) {
            crowd.forget(*drove.begin());
            drove.erase(drove.begin());
        } else if (month == 5 || month == 6) {
            crowd.resurface(4, month == 5);
        }
        changed += crowd.publish();
    }
    EXPECT_GT(changed, 50U); // or nothing would have been compared
}

TEST(PartToPublish, WaitsForCarsThatCameOneByOne) {
    CrowdServer crowd{4};
    crowd.publish();
    std::size_t changed = 0;
    for (int month = 0; month < 9; ++month) { // one new car a month waits until enough have aged
        if (month < 6) {
            crowd.drive(month, 1, 4);
            crowd.import();
        } // then nobody drives
        changed += crowd.publish();
    }
    EXPECT_EQ(changed, 20U); // once
}

TEST(PartToPublish, FollowsNewMaps) {
    CrowdServer crowd{6};
    for (int month = 0; month < 7; ++month) {
        for (int car = 0; car < 6; ++car) {
            crowd.drive(car, 1, 4 + month % 2, 1000 * (1 + month));
        }
        crowd.import();
        if (month == 1 || month == 3) {
            crowd.update_map(month == 3);
        }
        crowd.publish();
    }
}

/// Six roads in a row, the second of which ends 4 m later, and the third begins there.
std::vector<Way> recut_ways() {
    auto ways = copies_of_ways(roads_in_a_row(6));
    auto& end = ways.at(1).line.back();
    end.lon_deg += 0.00005;
    ways.at(2).line.front() = end;
    return ways;
}

TEST(PartToPublish, ShowsNoPassFromBeforeARoadWasCutAnewThoughItIsRenumberedLater) {
    CrowdServer crowd{6};
    const auto drive_all = [&](int first_road, IriUm iri_um) {
        for (int car = 0; car < 5; ++car) {
            crowd.drive(car, first_road, 6, iri_um);
        }
        crowd.import();
        crowd.publish();
    };
    drive_all(1, 2000);
    crowd.drive(5, 1, 6, 9000); // waits, alone
    crowd.import();
    crowd.publish();
    auto ways = recut_ways();
    crowd.update_map(build_network(recut_ways()));
    EXPECT_THAT(crowd.seen_on(2), IsEmpty());
    drive_all(1, 2100);
    ASSERT_THAT(crowd.seen_on(2), AllOf(SizeIs(10), Each(2100)));
    for (auto& way : ways) {
        way.id += 10;
    }
    crowd.update_map(build_network(std::move(ways)));
    EXPECT_THAT(crowd.seen_on(12), IsEmpty());
    EXPECT_THAT(crowd.seen_on(14), SizeIs(10)); // was not cut
    drive_all(11, 2200);
    EXPECT_THAT(crowd.seen_on(12), AllOf(SizeIs(10), Each(2200)));
    EXPECT_THAT(crowd.seen_on(14), AllOf(SizeIs(10), Each(Lt(2200))));
}

/// Country of so many towns, of which one was driven since the first publication.
class TownsToPublish : public ::testing::TestWithParam<unsigned> {};

INSTANTIATE_TEST_SUITE_P(Doubling, TownsToPublish, ::testing::Values(2, 4, 8));

TEST_P(TownsToPublish, FetchNotMoreWhereMoreTownsAreThatNobodyDrove) {
    constexpr int roads_of_town = 4, cars = 5;
    const auto towns = GetParam();
    CrowdServer crowd{static_cast<int>(towns) * roads_of_town};
    const auto drive_in = [&](int town) {
        for (int car = 0; car < cars; ++car) {
            crowd.drive(car, 1 + town * roads_of_town, roads_of_town);
        }
    };
    for (unsigned town = 0; town < towns; ++town) {
        drive_in(static_cast<int>(town));
    }
    crowd.import();
    crowd.publish();
    drive_in(0);
    crowd.import();
    {
        const auto part = crowd.to_publish();
        EXPECT_EQ(part.info().passes, 400U); // of five cars, twice
        EXPECT_EQ(part.info().segments_with_passes, 40U);
        EXPECT_EQ(way_count(crowd.all_roads()), roads_of_town * towns);
    }
    const auto whole = crowd.read().info();
    EXPECT_EQ(whole.passes, 200U * (towns + 1));
    EXPECT_EQ(whole.segments_with_passes, 40U * towns);
    EXPECT_EQ(crowd.publish(), 20U); // but for the ends of drives
}

} // namespace
} // namespace macadam::testing
