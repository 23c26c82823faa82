// What others see of an import while it runs.

#include "app/import/import_trips.hpp"
#include "app/import/trip_progress.hpp"
#include "storage/store/connection/import_lock.hpp"
#include "support/program/program.hpp"
#include "support/roads/drive.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <vector>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;
using namespace std::chrono_literals;

constexpr std::size_t trip_count = 4;

fs::path world() {
    auto folder = fresh_folder();
    fs::create_directories(folder / "trips");
    Drive drive{.length_m = 600};
    const auto trip = drive_over(
        patched_road([](double) { return false; }, 1), drive, *built_in_vehicle("golden-car"));
    for (std::size_t i = 0; i < trip_count; ++i) {
        drive.trip_id = fmt::format("trip-{}", i);
        write_file(folder / "trips" / (drive.trip_id + ".trip.csv"), text_of(trip, drive));
    }
    const auto first = (folder / "trips/trip-0.trip.csv").string();
    for (const auto* const name : {"meanwhile.gpkg", "at-end.gpkg"}) {
        EXPECT_EQ(run_macadam({"init", (folder / name).string(), "--trace", first}).exit_status, 0);
    }
    return folder;
}

/// Imports all trips. `tell` is called after each.
ImportTotals import_all(RoadStore& store,
                        const fs::path& folder,
                        std::chrono::milliseconds fuse_every,
                        const Progress& progress,
                        const std::function<void(const TripReport&)>& tell) {
    constexpr std::array options{vehicle_option, vehicles_option, vehicle_id_option};
    VehicleChoice vehicles{Arguments{options, {}, {}}};
    AskedTrips trips{{folder / "trips"}, {}, Console{Verbosity::quiet}};
    PipelineConfig pipeline;
    pipeline.estimator.method = Method::kf;
    auto target = import_store_of(store);
    return import_trips(target,
                        trips,
                        vehicles,
                        {.pipeline = pipeline, .jobs = 2, .fuse_every = fuse_every},
                        progress,
                        tell);
}

TEST(ImportThatFusesMeanwhile, EndsWithTheDigestOfOneThatFusesAtItsEnd) {
    const auto folder = world();
    auto meanwhile = RoadStore::open(folder / "meanwhile.gpkg");
    const auto totals =
        import_all(meanwhile, folder, std::chrono::milliseconds{0}, {}, [](auto&) {});
    EXPECT_EQ(totals.imported, trip_count);
    EXPECT_GT(totals.fusion.segments.size(), 0U);
    auto record = totals.fusion;
    meanwhile.importer.refresh({}, record);

    auto at_end = RoadStore::open(folder / "at-end.gpkg");
    EXPECT_THAT(import_all(at_end, folder, std::chrono::hours{1}, {}, [](auto&) {}).fusion.segments,
                IsEmpty());
    EXPECT_GT(at_end.waiting(), 0U);
    const auto fused = at_end.importer.refresh();
    EXPECT_EQ(meanwhile.digest(), at_end.digest());
    EXPECT_EQ(record.segments.size(), fused); // each segment once
}

TEST(ImportThatFusesMeanwhile, IsOneEntryInTheAudit) {
    const auto folder = world();
    auto store = RoadStore::open(folder / "meanwhile.gpkg");
    std::size_t changed = 0;
    auto totals = import_all(store, folder, 0ms, {}, [&](const TripReport&) {
        changed += store.audit().empty() ? 0 : 1;
    });
    EXPECT_GT(changed, 0U); // readers are shown something meanwhile
    store.importer.refresh({}, totals.fusion);
    ASSERT_THAT(store.audit(), SizeIs(1));
    EXPECT_EQ(store.audit().front().segments, totals.fusion.segments.size());
}

TEST(ImportThatFusesMeanwhile, ShowsReadersTheFirstTripsBeforeTheLastOnes) {
    const auto folder = world();
    const auto file = folder / "meanwhile.gpkg";
    auto store = RoadStore::open(file);
    std::size_t told = 0;
    bool seen = false;
    import_all(store, folder, std::chrono::milliseconds{0}, {}, [&](const TripReport&) {
        if (++told == trip_count) {
            const auto reader = StoreReader::open(file);
            seen = reader.seen().first_ms.has_value();
        }
    });
    EXPECT_EQ(told, trip_count);
    EXPECT_TRUE(seen);
}

TEST(ProgressOfAnImport, CountsPartsOfTripsUpToAll) {
    const auto folder = world();
    auto store = RoadStore::open(folder / "meanwhile.gpkg");
    std::vector<std::size_t> done;
    const Progress progress{.report =
                                [&](std::size_t parts, std::size_t whole) {
                                    EXPECT_EQ(whole, trip_count * TripProgress::whole_trip);
                                    done.push_back(parts);
                                },
                            .stop = {}};
    import_all(store, folder, std::chrono::hours{1}, progress, [](auto&) {});
    ASSERT_FALSE(done.empty());
    EXPECT_TRUE(std::ranges::is_sorted(done));
    EXPECT_EQ(done.back(), trip_count * TripProgress::whole_trip);
}

TEST(RunningImport, IsToldToOtherCommands) {
    const auto folder = world();
    const auto file = (folder / "meanwhile.gpkg").string();
    auto store = RoadStore::open(file);
    import_all(store, folder, std::chrono::hours{1}, {}, [](auto&) {});
    const auto running = [&] {
        const ImportLock import{file, "some import"};
        EXPECT_TRUE(is_import_running(file));
        return run_macadam({"info", file}).err;
    }();
    EXPECT_THAT(running,
                AllOf(HasSubstr("an import is running; values hold what it has fused so far, "),
                      Not(HasSubstr("was interrupted"))));
    EXPECT_FALSE(fs::exists(file + "-import"));
    EXPECT_THAT(run_macadam({"info", file}).err, HasSubstr("because an import was interrupted"));
}

TEST(RunningImport, OfTheSamePathsIsNotTakenForAnInterruptedOne) {
    const auto folder = world();
    const auto file = (folder / "meanwhile.gpkg").string();
    const ImportLock other{file, "some import"};
    const auto run = run_macadam({"import", file, (folder / "trips").string(), "--method", "kf"});
    EXPECT_EQ(run.exit_status, 0);
    EXPECT_THAT(run.err, HasSubstr("another import into this database is running"));
}

} // namespace
} // namespace macadam::testing
