// A real log, cut anywhere and with any byte turned into another: it is refused with words, or
// every row of what is left is accounted for. `./run test --all` tries a hundred times as many.

#include "app/pipeline/pipeline.hpp"
#include "estimator/motion/trip_motion.hpp"

#include "estimator/common/error.hpp"
#include "storage/trips/trip_reader.hpp"
#include "support/program/places.hpp"
#include "support/program/program.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <random>

namespace macadam {
namespace {

/// The first rows of the recorded trip, with the right end: enough for everything to happen.
std::string short_log() {
    constexpr int rows = 1500;
    const auto whole = testing::read_file(testing::source_folder() +
                                          "/sample_data/comma2k19/comma2k19_rav4.trip.csv");
    auto end = whole.find("\nt_s,") + 1;
    for (int i = 0; i <= rows; ++i) {
        end = whole.find('\n', end) + 1;
    }
    return whole.substr(0, end) + "# end rows: " + std::to_string(rows) + "\n";
}

int tries(int usual) {
    return std::getenv("MACADAM_TEST_ALL") != nullptr ? 100 * usual : usual;
}

enum class Outcome { refused, used };

/// Reads and estimates a damaged log. Whatever it holds, this must neither fail otherwise than with
/// an InputError nor lose a row.
Outcome outcome_of(const std::filesystem::path& file, const std::string& text) {
    testing::write_file(file, text);
    try {
        const auto trip = read_trip({file, ""}, needs_of_import());
        const auto trace = trace_of(trip, motion_of(trip), *built_in_vehicle("generic"), {});
        const auto rows = account(trip, trace.use);
        EXPECT_EQ(rows.read, trip.rows.size());
        EXPECT_EQ(rows.read, rows.used + rows.rejected);
        return Outcome::used;
    } catch (const InputError& error) {
        EXPECT_STRNE(error.what(), "");
        return Outcome::refused;
    }
}

TEST(DamagedTrips, AreRefusedWhereverTheyAreCut) {
    const auto log = short_log();
    const auto file = testing::fresh_folder() / "cut.trip.csv";
    ASSERT_EQ(outcome_of(file, log), Outcome::used);
    std::mt19937_64 random{20260301};
    for (int i = 0; i < tries(30); ++i) {
        const auto length = random() % (log.size() - 1); // the last newline may be missing
        EXPECT_EQ(outcome_of(file, log.substr(0, length)), Outcome::refused) << length;
    }
}

TEST(DamagedTrips, LoseNoRowWhateverByteIsTurned) {
    const auto log = short_log();
    const auto file = testing::fresh_folder() / "turned.trip.csv";
    std::mt19937_64 random{20260302};
    int used = 0;
    for (int i = 0; i < tries(60); ++i) {
        auto damaged = log;
        damaged[random() % damaged.size()] = static_cast<char>(random());
        used += outcome_of(file, damaged) == Outcome::used ? 1 : 0;
    }
    EXPECT_GT(used, tries(60) / 2); // one bad cell is no reason to refuse a trip
}

} // namespace
} // namespace macadam
