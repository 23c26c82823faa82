// An import into a store on a disk that is full, breaks or cannot sync, from any access on. `./run
// test --all` tries the first 500 accesses of each kind, the ordinary tests one in some.

#include "faulty_disk.hpp"
#include "storage/store/privacy/privacy_key.hpp"
#include "storage/store/road_store.hpp"
#include "store_import.hpp"
#include "support/files/files.hpp"
#include "support/roads/store_world.hpp"

#include <gmock/gmock.h>

#include <optional>

namespace macadam {
namespace {

namespace fs = std::filesystem;
using testing::Fault;
using testing::FaultPlan;
using testing::FaultyDisk;
using testing::import_into;
using testing::refusal_of;
using testing::test_folder;

/// Enough for 500 accesses; of syncs there are few.
int trips_for(Fault fault) {
    return static_cast<int>(testing::tries(4, fault == Fault::broken ? 14 : 24));
}

struct FailedImport {
    bool met_the_fault;
    bool ended_before; ///< the fault came only when the store was closed
    std::string refusal;
    std::vector<int> acknowledged;
};

FailedImport import_with(const FaultPlan& plan, const fs::path& file) {
    FailedImport failed{};
    FaultyDisk disk;
    disk.plan(plan);
    failed.refusal = refusal_of([&] {
        auto store = RoadStore::open(file);
        import_into(
            store, trips_for(plan.fault), [&](int trip) { failed.acknowledged.push_back(trip); });
        failed.ended_before = !disk.has_failed();
    });
    failed.met_the_fault = disk.has_failed();
    return failed;
}

std::string cause_of(Fault fault) {
    return fault == Fault::full ? "(no space left on the disk|No space left on device|cannot be "
                                  "opened)"
                                : "(Input/output error|cannot be opened|disk I/O error)";
}

struct Sweep {
    std::size_t met = 0;     ///< imports that met the fault
    std::size_t closing = 0; ///< of them, while the store was closed
    std::size_t refused = 0; ///< of them
};

/// Plans with one failure, and with nothing but failures from there on, take turns.
Sweep sweep(Fault fault, std::size_t step) {
    constexpr std::size_t most = 500;
    const auto folder = test_folder();
    const auto empty = folder / "empty.gpkg";
    testing::new_store(empty);
    const auto trips = trips_for(fault);
    const auto whole = testing::undisturbed_digest(empty, trips);
    const auto file = folder / "a.gpkg";

    Sweep done;
    for (std::size_t number = 1; number <= most; number += step) {
        SCOPED_TRACE(::testing::Message() << "access " << number);
        fs::copy_file(empty, file, fs::copy_options::overwrite_existing);
        fs::copy_file(key_file_of(empty), key_file_of(file), fs::copy_options::overwrite_existing);
        const auto failed = import_with({fault, number, number / step % 2 == 0}, file);
        if (!failed.met_the_fault) {
            break; // it has fewer accesses
        }
        ++done.met;
        done.closing += failed.ended_before ? 1U : 0U;
        if (!failed.refusal.empty()) {
            ++done.refused;
            EXPECT_THAT(failed.refusal, ::testing::ContainsRegex("a\\.gpkg: .*" + cause_of(fault)));
        }
        const FaultyDisk sound;
        EXPECT_EQ(testing::damage_of(file), "ok");
        {
            const auto store = StoreReader::open(file);
            for (const int trip : failed.acknowledged) {
                EXPECT_TRUE(store.contains_trip(testing::trip_record(trip).sha256)) << trip;
            }
        }
        import_into(file, trips);
        EXPECT_EQ(StoreReader::open(file).digest(), whole);
        fs::remove(file);
    }
    std::cout << "accesses that failed: " << done.met << ", imports refused: " << done.refused
              << '\n';
    return done;
}

// A single failure before the first trip can be got over by trying again, and what is only tidied
// up when the store is closed can wait: such an import says nothing, and nothing is missing.
void expect_most_refused(const Sweep& done) {
    EXPECT_GT(done.met, done.closing);
    EXPECT_GE(done.refused + 5, done.met - done.closing);
}

TEST(IoFailure, OfAFullDiskIsNamedAndLosesNothing) {
    expect_most_refused(sweep(Fault::full, testing::tries(9, 1)));
}

TEST(IoFailure, OfABrokenDiskIsNamedAndLosesNothing) {
    expect_most_refused(sweep(Fault::broken, testing::tries(17, 1)));
}

TEST(IoFailure, OfASyncIsNamedAndLosesNothing) {
    expect_most_refused(sweep(Fault::no_sync, testing::tries(3, 1)));
}

std::vector<std::string> names_in(const fs::path& folder) {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator{folder}) {
        names.push_back(entry.path().filename());
    }
    return names;
}

/// \returns whether the fault came before the store was there.
bool leaves_no_half_store(const FaultPlan& plan) {
    const auto file = test_folder() / "b.gpkg";
    std::string refusal;
    {
        FaultyDisk disk;
        disk.plan(plan);
        refusal = refusal_of([&] { testing::new_store(file); });
    }
    if (fs::exists(file)) {
        EXPECT_EQ(testing::damage_of(file), "ok");
        return false;
    }
    EXPECT_THAT(refusal, ::testing::ContainsRegex("b\\.gpkg: .*" + cause_of(plan.fault)));
    EXPECT_THAT(names_in(file.parent_path()), ::testing::IsEmpty());
    return true;
}

TEST(IoFailure, LeavesNoHalfStore) {
    for (const auto fault : {Fault::full, Fault::broken}) {
        std::size_t number = 1;
        while (leaves_no_half_store({fault, number, false})) {
            number += testing::tries(7, 1);
        }
        EXPECT_GT(number, 10U);
    }
}

} // namespace
} // namespace macadam
