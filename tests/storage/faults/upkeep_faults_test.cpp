// What is done to a store beside bringing trips in, on a disk that is full, breaks, cannot sync or
// loses power: the store is as it was, or as it is to be, and nothing between. `./run test --all`
// tries every access, the ordinary tests one in some.

#include "faulty_disk.hpp"
#include "mapping/conflation/network_conflation.hpp"
#include "mapping/network/build_network.hpp"
#include "storage/store/road_store.hpp"
#include "store_import.hpp"
#include "support/files/files.hpp"
#include "support/roads/edited_network.hpp"
#include "support/roads/fleet_passes.hpp"

#include <gmock/gmock.h>

#include <array>
#include <functional>
#include <ostream>
#include <random>

namespace macadam {
namespace {

namespace fs = std::filesystem;
using testing::add_trip;
using testing::Fault;
using testing::FaultPlan;
using testing::FaultyDisk;
using testing::Loss;
using testing::passes_of_fleet;
using testing::refusal_of;
using testing::stage_trip;
using testing::test_folder;
using testing::tries;
using testing::trip_record;

struct UpkeepCase {
    std::string name;
    std::function<void(RoadStore&)> work; ///< may be done again
    std::size_t commits = 1;
};

void PrintTo(const UpkeepCase& maintenance, std::ostream* out) {
    *out << maintenance.name;
}

void forget(RoadStore& store) {
    if (store.contains_trip(trip_record(4).sha256)) {
        store.maintenance.forget({.trips = {"trip-4"}, .vehicles = {}});
    }
}

void reprocess(RoadStore& store) {
    for (const int trip : {2, 5}) {
        stage_trip(store, trip_record(trip), passes_of_fleet(trip + 1), {});
    }
    store.maintenance.commit_staged("anew");
}

void set_valid_from(RoadStore& store) {
    const std::vector<SegmentKey> segments{{1, true, 3}, {1, false, 4}};
    store.maintenance.set_valid_from(segments, trip_record(5).t0_utc_ms, "resurfaced");
}

void import_reference(RoadStore& store) {
    auto survey = trip_record(50);
    survey.vehicle_id = "";
    survey.reference = ReferenceNote{.relative_sd_ppm = 20'000, .row_mm = 20'000};
    add_trip(store, survey, passes_of_fleet(1));
    store.importer.refresh();
}

void update_network(RoadStore& store) {
    const auto before = store.roads();
    auto network = testing::edited(copies_of_ways(testing::small_country()));
    if (before.ways[0].id == 1) {
        testing::renumber(network, 1, 100);
        testing::erase(network, 3);
        const auto after = build_network(testing::ways_of(network));
        store.maintenance.update_network(
            before, after, change_between(before, after), {"newer.osm.pbf", "© somebody"});
    }
}

std::vector<UpkeepCase> maintenances() {
    return {{"calibrate", [](RoadStore& store) { store.maintenance.calibrate(); }},
            {"forget", forget},
            {"reprocess", reprocess},
            {"valid_from", set_valid_from},
            {"reference", import_reference, 2}, // it comes in, then it is fused
            {"update_network", update_network}};
}

/// A store of a fleet before and after.
struct World {
    fs::path base;
    std::string before;
    std::string after;
};

World world_of(const fs::path& folder, const UpkeepCase& maintenance) {
    World made{folder / "base.gpkg", "", ""};
    made.before = testing::fleet_store(made.base, 9).digest();
    const auto whole = folder / "whole.gpkg";
    fs::copy_file(made.base, whole);
    auto store = RoadStore::open(whole);
    maintenance.work(store);
    made.after = store.digest();
    return made;
}

std::string digest_of(const fs::path& file) {
    return StoreReader::open(file).digest();
}

/// \returns whether it is as it is to be.
bool is_before_or_after(const fs::path& file, const World& world, const UpkeepCase& maintenance) {
    EXPECT_EQ(testing::damage_of(file), "ok");
    const auto digest = digest_of(file);
    if (maintenance.commits == 1) {
        EXPECT_TRUE(digest == world.before || digest == world.after);
    }
    return digest == world.after;
}

void expect_completed(const fs::path& file, const World& world, const UpkeepCase& maintenance) {
    {
        auto store = RoadStore::open(file);
        maintenance.work(store);
    }
    EXPECT_EQ(digest_of(file), world.after);
}

// -------------------------------------------------------------------------------- a failing disk

struct Failed {
    bool met_the_fault;
    bool ended_before; ///< the fault came only when the store was closed
    std::string refusal;
};

Failed work_with(const FaultPlan& plan, const UpkeepCase& maintenance, const fs::path& file) {
    Failed failed{};
    FaultyDisk disk;
    disk.plan(plan);
    failed.refusal = refusal_of([&] {
        auto store = RoadStore::open(file);
        maintenance.work(store);
        failed.ended_before = !disk.has_failed();
    });
    failed.met_the_fault = disk.has_failed();
    return failed;
}

struct FaultCase {
    std::string name;
    Fault fault;
    std::string cause;
    std::size_t step; ///< of the ordinary tests
};

void PrintTo(const FaultCase& fault, std::ostream* out) {
    *out << fault.name;
}

class UpkeepFault : public ::testing::TestWithParam<std::tuple<UpkeepCase, FaultCase>> {};

TEST_P(UpkeepFault, IsNamedAndLeavesTheStoreAsItWasOrAsItIsToBe) {
    const auto& [maintenance, fault] = GetParam();
    const auto folder = test_folder();
    const auto world = world_of(folder, maintenance);
    const auto file = folder / "a.gpkg";
    const auto step = tries(fault.step, 1);
    std::size_t refused = 0;
    for (std::size_t number = 1; number <= 500; number += step) {
        SCOPED_TRACE(::testing::Message() << fault.name << " at access " << number);
        fs::copy_file(world.base, file, fs::copy_options::overwrite_existing);
        const auto failed =
            work_with({fault.fault, number, number / step % 2 == 0}, maintenance, file);
        if (!failed.met_the_fault) {
            break; // it has fewer accesses
        }
        const FaultyDisk sound;
        const bool is_done = is_before_or_after(file, world, maintenance);
        if (failed.refusal.empty()) { // it was got over, or came while the store was closed
            EXPECT_TRUE(is_done);
        } else {
            ++refused;
            EXPECT_THAT(failed.refusal, ::testing::ContainsRegex("a\\.gpkg: .*" + fault.cause));
        }
        expect_completed(file, world, maintenance);
        fs::remove(file);
    }
    std::cout << refused << " refused\n";
    EXPECT_GT(refused, 0U);
}

INSTANTIATE_TEST_SUITE_P(
    Maintenance,
    UpkeepFault,
    ::testing::Combine(
        ::testing::ValuesIn(maintenances()),
        ::testing::Values(
            FaultCase{"full",
                      Fault::full,
                      "(no space left on the disk|No space left on device|cannot be opened)",
                      7},
            FaultCase{"broken",
                      Fault::broken,
                      "(Input/output error|cannot be opened|disk I/O error)",
                      19},
            FaultCase{"no_sync", Fault::no_sync, "(Input/output error|disk I/O error)", 1})),
    [](const auto& test) {
        return std::get<0>(test.param).name + "_" + std::get<1>(test.param).name;
    });

// ------------------------------------------------------------------------------------ power loss

class UpkeepPowerLoss : public ::testing::TestWithParam<UpkeepCase> {};

TEST_P(UpkeepPowerLoss, LeavesTheStoreAsItWasOrAsItIsToBe) {
    constexpr std::array losses{Loss::all, Loss::some, Loss::torn};
    const auto folder = test_folder();
    const auto world = world_of(folder, GetParam());
    const auto file = folder / "a.gpkg";
    fs::copy_file(world.base, file);
    testing::DiskLog log;
    std::size_t acknowledged = 0; // after so many operations
    {
        FaultyDisk disk;
        {
            auto store = RoadStore::open(file);
            GetParam().work(store);
            acknowledged = disk.log().operations.size();
        }
        log = disk.log();
    }
    std::mt19937 random{20261122};
    for (std::size_t image = 0; image < tries(9, 200); ++image) {
        const auto when = random() % (log.operations.size() + 1);
        SCOPED_TRACE(::testing::Message() << "image " << image << ", after operation " << when);
        const auto left = folder / "left";
        fs::remove_all(left);
        fs::create_directories(left);
        write_after_power_loss(
            log, when, losses[image % losses.size()], static_cast<std::uint32_t>(image), left);
        const FaultyDisk sound;
        const bool is_done = is_before_or_after(left / "a.gpkg", world, GetParam());
        EXPECT_TRUE(is_done || when < acknowledged);
        expect_completed(left / "a.gpkg", world, GetParam());
    }
}

INSTANTIATE_TEST_SUITE_P(Maintenance,
                         UpkeepPowerLoss,
                         ::testing::ValuesIn(maintenances()),
                         [](const auto& test) { return test.param.name; });

} // namespace
} // namespace macadam
