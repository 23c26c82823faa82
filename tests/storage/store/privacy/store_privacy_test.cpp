// Profile and key of a store: whose cars it holds, and under what names.

#include "storage/store/road_store.hpp"
#include "support/files/files.hpp"
#include "support/roads/fleet_passes.hpp"
#include "support/roads/store_world.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <set>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::SizeIs;

std::string bytes_of(const fs::path& file) {
    std::ifstream in{file, std::ios::binary};
    return {std::istreambuf_iterator<char>{in}, {}};
}

RoadStore opened(const fs::path& file) {
    return RoadStore::open(file);
}

TEST(PrivacyProfile, IsKeptAsItWasChosen) {
    const auto folder = test_folder();
    EXPECT_EQ(new_store(folder / "own.gpkg").settings().privacy, PrivacyProfile::own);
    auto crowd = settings();
    crowd.privacy = PrivacyProfile::crowd;
    RoadStore::create(folder / "crowd.gpkg", small_country(), crowd);
    EXPECT_EQ(StoreReader::open(folder / "crowd.gpkg").settings().privacy, PrivacyProfile::crowd);
}

TEST(StoreKey, IsMadeWithTheStoreAndMakesItsHolderTheOperator) {
    const auto file = test_folder() / "a.gpkg";
    {
        const auto store = new_store(file);
        EXPECT_TRUE(store.is_operator());
        EXPECT_EQ(store.key()->hex(), read_key(key_file_of(file))->hex());
        EXPECT_THAT(bytes_of(file), Not(HasSubstr(store.key()->hex())));
    }
    fs::rename(key_file_of(file), file.string() + ".away");
    EXPECT_FALSE(StoreReader::open(file).is_operator());
}

TEST(StoreKey, ThatLiesThereAlreadyIsTaken) {
    const auto file = test_folder() / "a.gpkg";
    new_store(file);
    const auto key = bytes_of(key_file_of(file));
    fs::remove(file);
    EXPECT_TRUE(new_store(file).is_operator());
    EXPECT_EQ(bytes_of(key_file_of(file)), key);
}

TEST(StoreKey, GoesAgainWithAStoreThatCouldNotBeMade) {
    const auto folder = test_folder();
    auto wrong = settings();
    wrong.class_table = "seven";
    EXPECT_THAT(refusal_of([&] { RoadStore::create(folder / "a.gpkg", small_country(), wrong); }),
                HasSubstr("seven"));
    EXPECT_TRUE(fs::is_empty(folder));
}

TEST(StoreKey, OfAnotherStoreIsRefusedWithWhatToDo) {
    const auto folder = test_folder();
    new_store(folder / "a.gpkg");
    new_store(folder / "b.gpkg");
    fs::copy_file(key_file_of(folder / "b.gpkg"),
                  key_file_of(folder / "a.gpkg"),
                  fs::copy_options::overwrite_existing);
    const auto refused = HasSubstr("a.gpkg.key: is not the key of ");
    EXPECT_THAT(refusal_of([&] { StoreReader::open(folder / "a.gpkg"); }), refused);
    EXPECT_THAT(refusal_of([&] { RoadStore::open(folder / "a.gpkg"); }), refused);
}

TEST(StoreKey, ThatIsGoneIsMadeAnewAndOldCarsAreNotJoined) {
    const auto file = test_folder() / "a.gpkg";
    {
        auto store = new_store(file);
        import_trips(store, 3); // cars 0 to 2
        EXPECT_FALSE(store.importer.make_missing_key());
    }
    fs::remove(key_file_of(file));
    auto store = opened(file);
    EXPECT_FALSE(store.is_operator());
    EXPECT_TRUE(store.importer.make_missing_key());
    EXPECT_TRUE(store.is_operator());
    add_trip(store, trip_record(3), passes_of(3)); // car 0 again
    EXPECT_THAT(store.usage().cars, SizeIs(4));
    EXPECT_TRUE(opened(file).is_operator());
}

TEST(StoreKey, IsMissedOnlyWhereACarHasToBeNamed) {
    const auto file = test_folder() / "a.gpkg";
    new_store(file);
    fs::remove(key_file_of(file));
    auto store = opened(file);
    auto nobody = trip_record(0);
    nobody.vehicle_id = "";
    add_trip(store, nobody, passes_of(0));
    EXPECT_FALSE(store.is_operator());
    add_trip(store, trip_record(1), passes_of(1));
    EXPECT_TRUE(store.is_operator());
    EXPECT_TRUE(fs::exists(key_file_of(file)));
}

TEST(Cars, AreNamedUnderTheKeyAndComeInTheOrderOfTheirFirstTripWhateverTheKey) {
    const auto folder = test_folder();
    std::set<std::string> names;
    for (const auto* const name : {"a.gpkg", "b.gpkg", "c.gpkg"}) {
        auto store = new_store(folder / name);
        std::vector<int> order{0, 1, 2, 3, 4, 5, 6};
        if (*name == 'b') {
            std::ranges::reverse(order);
        }
        for (const int number : order) {
            add_trip(store, trip_record(number), passes_of(number));
        }
        auto nobody = trip_record(7);
        nobody.vehicle_id = "";
        add_trip(store, nobody, passes_of(7));
        const auto& key = *store.key();
        EXPECT_THAT(
            store.usage().cars,
            ElementsAre(
                key.pseudonym("car-0"), key.pseudonym("car-1"), key.pseudonym("car-2"), "unknown"));
        EXPECT_EQ(store.info().vehicles, store.usage().cars);
        names.insert(store.usage().cars.front());
    }
    EXPECT_EQ(names.size(), 3U);
}

TEST(Cars, OfAnyKeyGiveOneDigestAlsoWhenTheyAreCalibrated) {
    const auto folder = test_folder();
    std::set<std::string> digests;
    for (int i = 0; i < 6; ++i) {
        auto store = fleet_store(folder / (std::to_string(i) + ".gpkg"), 24);
        EXPECT_THAT(store.maintenance.calibrate().cars, SizeIs(3));
        digests.insert(store.digest());
    }
    EXPECT_THAT(digests, SizeIs(1));
}

TEST(VehicleIds, StandNowhereInTheStoreNorBesideIt) {
    const auto folder = test_folder();
    const std::string id = "WVWZZZ1JZXW000001";
    auto trip = trip_record(0);
    trip.vehicle_id = id;
    trip.trip_id = id + "-0001";
    trip.file_name = "log of " + id + " (" + id + ").trip.csv";
    {
        auto store = new_store(folder / "a.gpkg");
        add_trip(store, trip, passes_of(0));
        store.importer.refresh();
        for (const auto& file : fs::directory_iterator{folder}) { // the log among them
            EXPECT_THAT(bytes_of(file), Not(HasSubstr(id))) << file.path();
        }
    }
    ASSERT_TRUE(fs::exists(folder / "a.gpkg"));
    for (const auto& file : fs::directory_iterator{folder}) {
        EXPECT_THAT(bytes_of(file), Not(HasSubstr(id))) << file.path();
    }
}

TEST(Forget, FindsATripByANameWithTheIdOfItsCarForWhoHasTheKey) {
    const auto folder = test_folder();
    auto store = new_store(folder / "a.gpkg");
    for (int number = 0; number < 6; ++number) {
        auto trip = trip_record(number);
        trip.trip_id = trip.vehicle_id + "-" + std::to_string(number / 3);
        trip.file_name = trip.trip_id + ".trip.csv.gz";
        add_trip(store, trip, passes_of(number));
    }
    EXPECT_EQ(store.maintenance.forget({.trips = {"car-1-0"}, .vehicles = {}}).trips, 1U);
    EXPECT_EQ(store.maintenance.forget({.trips = {"car-2-1.trip.csv.gz"}, .vehicles = {}}).trips,
              1U);
    EXPECT_FALSE(store.contains_trip(trip_record(1).sha256));
    EXPECT_FALSE(store.contains_trip(trip_record(5).sha256));
    EXPECT_EQ(store.info().trips, 4U);
    EXPECT_THAT(
        refusal_of([&] { store.maintenance.forget({.trips = {"car-1-0"}, .vehicles = {}}); }),
        HasSubstr("has no trip 'car-1-0'"));

    fs::remove(key_file_of(store.file()));
    auto other = opened(store.file());
    EXPECT_THAT(refusal_of([&] { other.maintenance.forget({.trips = {}, .vehicles = {"car-0"}}); }),
                HasSubstr("the key of the database is not beside it"));
    EXPECT_EQ(
        other.maintenance.forget({.trips = {}, .vehicles = {other.usage().cars.front()}}).trips,
        2U);
}

} // namespace
} // namespace macadam::testing
