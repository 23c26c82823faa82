#include "app/import/trip_inputs.hpp"

#include "support/files/files.hpp"

#include <gmock/gmock.h>

#include <fstream>
#include <future>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;

AskedTrips asked(const std::vector<fs::path>& paths) {
    return AskedTrips{paths, {}, Console{Verbosity::quiet}};
}

TEST(AskedTrips, AreTheTripsOfAllPathsInTheirOrder) {
    const auto folder = test_folder();
    for (const auto* const name : {"b.trip.csv", "c.trip.csv"}) {
        std::ofstream{folder / name} << "x";
    }
    auto trips = asked({folder / "c.trip.csv", folder / "gone.trip.csv", folder});
    EXPECT_EQ(trips.count(), 4U);
    for (const auto* const name : {"c.trip.csv", "gone.trip.csv", "b.trip.csv", "c.trip.csv"}) {
        const auto trip = trips.next();
        ASSERT_TRUE(trip);
        EXPECT_EQ(trip->file.filename(), name);
        EXPECT_EQ(trips.at_least(), 4U);
    }
    EXPECT_FALSE(trips.next());
    EXPECT_EQ(trips.count(), 4U);
}

// A pipe stands for an archive that takes long to read.
TEST(AskedTrips, AreCountedWhileOneIsExtracted) {
    const auto folder = test_folder();
    const auto slow = folder / "slow.tar";
    ASSERT_EQ(::mkfifo(slow.c_str(), 0600), 0);
    std::ofstream{folder / "a.trip.csv"} << "x";
    auto trips = asked({slow, folder / "a.trip.csv"});
    EXPECT_FALSE(trips.count());
    auto first = std::async(std::launch::async, [&] { return trips.next(); });
    std::ofstream writer{slow}; // opens once the archive is being read
    EXPECT_EQ(trips.at_least(), 2U);
    EXPECT_FALSE(trips.count());
    EXPECT_EQ(first.wait_for(std::chrono::seconds{0}), std::future_status::timeout);
    writer.close();
    while (first.wait_for(std::chrono::milliseconds{1}) != std::future_status::ready) {
        ::close(::open(slow.c_str(), O_WRONLY | O_NONBLOCK)); // if the archive is opened again
    }
}

} // namespace
} // namespace macadam::testing
