#include "storage/trips/trip_follower.hpp"

#include "storage/trips/trip_reader.hpp"
#include "support/files/compressed.hpp"
#include "support/files/files.hpp"

#include <gmock/gmock.h>

using namespace macadam;
using namespace macadam::testing;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

namespace {

const std::string open_log = "# macadam-trip 1\n# vehicle_id: car\nt_s,acc_z_mps2,speed_mps\n"
                             "0.00,9.8,\n0.01,,20\nnonsense\n0.02,9.9,\n";
const std::string whole_log = open_log + "# end rows: 4\n";

struct Fed {
    std::vector<double> acc_t_s;
    std::vector<double> speed_t_s;
    std::vector<int> rows;
    bool closed = false;
};

Fed fed(const std::filesystem::path& file) {
    TripFollower feed{file, needs_of_trace()};
    Fed fed;
    while (const auto row = feed.next()) {
        fed.acc_t_s.insert(fed.acc_t_s.end(), row->acc.t_s.begin(), row->acc.t_s.end());
        fed.speed_t_s.insert(fed.speed_t_s.end(), row->speed.t_s.begin(), row->speed.t_s.end());
        fed.rows.insert(fed.rows.end(), row->rows.begin(), row->rows.end());
    }
    fed.closed = feed.closed();
    return fed;
}

} // namespace

TEST(TripFollower, GivesRowByRowWhatTheReaderGivesAtOnce) {
    const auto file = written(test_folder(), "a.trip.csv", whole_log);
    const auto row_by_row = fed(file);
    const auto at_once = read_trip({file, ""}, needs_of_trace());
    EXPECT_EQ(row_by_row.acc_t_s, at_once.acc.t_s);
    EXPECT_EQ(row_by_row.speed_t_s, at_once.speed.t_s);
    EXPECT_EQ(row_by_row.rows, (std::vector<int>{at_once.rows.begin(), at_once.rows.end()}));
}

TEST(TripFollower, ReadsCompressedLogs) {
    const auto file = written(test_folder(), "a.trip.csv.gz", gzipped(whole_log));
    EXPECT_THAT(fed(file).acc_t_s, ElementsAre(0, 0.02));
}

TEST(TripFollower, KnowsWhetherTheLogWasClosed) {
    EXPECT_TRUE(fed(written(test_folder(), "a.trip.csv", whole_log)).closed);
    EXPECT_FALSE(fed(written(test_folder(), "a.trip.csv", open_log)).closed);
}

TEST(TripFollower, RefusesAWrongNumberOfRows) {
    const auto file = written(test_folder(), "a.trip.csv", open_log + "# end rows: 3\n");
    EXPECT_THAT(refusal_of([&] { fed(file); }),
                HasSubstr("a.trip.csv:8: '# end rows: 3', expected '# end rows: 4'"));
}

TEST(TripFollower, RefusesALogWithoutWhatIsNeeded) {
    const auto file = written(test_folder(), "a.trip.csv", "# macadam-trip 1\nt_s,acc_z_mps2\n");
    EXPECT_THAT(refusal_of([&] { fed(file); }), HasSubstr("expected also speed_mps or"));
}

TEST(TripFollower, SaysARowWithItsLine) {
    TripFollower feed{written(test_folder(), "a.trip.csv", whole_log), needs_of_trace()};
    for (int row = 0; row < 3; ++row) {
        feed.next();
    }
    EXPECT_THAT(feed.row_text(), HasSubstr("a.trip.csv:6: 'nonsense'"));
}

TEST(TripFollower, TakesARepeatedFixForOne) {
    const auto file = written(test_folder(),
                              "a.trip.csv",
                              "# macadam-trip 1\nt_s,acc_z_mps2,lat_deg,lon_deg,gnss_speed_mps\n"
                              "0,9.8,48,11,20\n0.1,,48,11,20\n0.2,,48.1,11,20\n");
    TripFollower feed{file, needs_of_trace()};
    std::size_t fixes = 0;
    while (const auto row = feed.next()) {
        fixes += row->fixes.size();
    }
    EXPECT_EQ(fixes, 2U);
}
