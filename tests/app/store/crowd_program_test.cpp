// A database of other people's cars, from `init --privacy crowd` to what is handed on.

#include "storage/postgres/server_connection.hpp"
#include "support/program/places.hpp"
#include "support/program/postgres_server.hpp"
#include "support/program/program.hpp"
#include "support/roads/crowd_logs.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <regex>
#include <set>
#include <thread>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

constexpr int cars = 6;

/// The road of a crowd, which six cars drive.
class Crowd : public ::testing::Test {
protected:
    void SetUp() override {
        folder_ = fresh_folder();
        store_ = (folder_ / "crowd.gpkg").string();
        write_file(folder_ / "road.osm", crowd_road_osm());
        fs::create_directories(folder_ / "trips");
        for (int number = 0; const auto& log : crowd_logs(cars)) {
            write_file(folder_ / "trips" / fmt::format("{}.trip.csv", number++), log);
        }
    }

    void make(const std::string& privacy) const {
        run({"init", store_, "--network", at("road.osm"), "--privacy", privacy});
        run({"import", store_, at("trips"), "--method", "kf", "--vehicle", "golden-car"});
    }

    /// Lets the logs state what their recorder left out.
    void state_trimmed(int length_m) const {
        for (int number = 0; number < cars; ++number) {
            const auto log = folder_ / "trips" / fmt::format("{}.trip.csv", number);
            auto text = read_file(log);
            text.insert(text.find('\n') + 1, fmt::format("# trimmed_m: {}\n", length_m));
            write_file(log, text);
        }
    }

    std::string at(const std::string& name) const { return (folder_ / name).string(); }

    static testing::Run run(const std::vector<std::string>& words, int expected = 0) {
        auto done = run_macadam(words);
        EXPECT_EQ(done.exit_status, expected) << words.front() << ": " << done.err;
        return done;
    }

    std::set<int> exported_ways() const {
        run({"export", store_, "-o", at("out.geojson")});
        const auto text = read_file(folder_ / "out.geojson");
        fs::remove(folder_ / "out.geojson");
        std::set<int> ways;
        const std::regex way{"\"way_id\": ?([0-9]+)"};
        for (std::sregex_iterator it{text.begin(), text.end(), way}, end; it != end; ++it) {
            ways.insert(std::stoi((*it)[1]));
        }
        return ways;
    }

    /// Waits for the next month if this one is about to end, UTC: a test is to publish twice in
    /// one.
    static void await_a_month() {
        using namespace std::chrono;
        constexpr minutes longest{1};
        const auto month_at = [](auto time) { return year_month_day{floor<days>(time)}.month(); };
        while (month_at(system_clock::now()) != month_at(system_clock::now() + longest)) {
            std::this_thread::sleep_for(seconds{1});
        }
    }

    void lose_key() const { fs::rename(store_ + ".key", at("kept.key")); }

    fs::path folder_;
    std::string store_;
};

TEST_F(Crowd, HandsOnWhatIsPublishedAndNothingElse) {
    make("crowd");
    await_a_month();
    EXPECT_THAT(exported_ways(), IsEmpty());
    EXPECT_THAT(run({"export", store_, "-o", at("none.csv")}).err,
                HasSubstr("crowd database without a publication"));

    EXPECT_THAT(run({"publish", store_}).out,
                AllOf(HasSubstr("from at least 5 trips of 5 cars"), HasSubstr("left out: up to")));
    const auto ways = exported_ways();
    EXPECT_THAT(ways, Not(IsEmpty()));
    for (const int way : ways) { // 300 m and the block in which a drive's end lies
        EXPECT_GE(way, 3);
        EXPECT_LE(way, crowd_ways - 2);
    }
    EXPECT_THAT(run({"publish", store_}, 1).err, HasSubstr("can be published once a month"));
    run({"report", store_, "-o", at("report.html")});
    const auto report = read_file(folder_ / "report.html");
    EXPECT_THAT(report, HasSubstr("are based on five cars or more"));
    EXPECT_THAT(report, Not(HasSubstr("not anonymised")));
    run({"render", store_, "-o", at("map.png"), "--size", "400x300"});
}

TEST_F(Crowd, LeavesEventsOfAPeriodOutOfMapsAndReportsAlike) {
    make("crowd");
    run({"publish", store_});
    lose_key();
    const auto month = "2026-03";
    const auto refused = run({"query", store_, "--events", "--since", month}, 1).err;
    EXPECT_THAT(refused, HasSubstr("published"));
    const auto map = run({"render", store_, "-o", at("a.png"), "--events", "--since", month}).err;
    const auto report = run({"report", store_, "-o", at("a.html"), "--since", month}).err;
    for (const auto& warned : {map, report}) {
        EXPECT_THAT(warned,
                    HasSubstr("potholes and other events are left out: a crowd database publishes "
                              "them without months"));
    }
}

TEST_F(Crowd, ShowsMoreToWhoHoldsTheKey) {
    make("crowd");
    run({"publish", store_});
    EXPECT_THAT(run({"query", store_, "--segment", "6+0003", "--passes"}).err,
                HasSubstr("do not pass it on"));
    lose_key();
    EXPECT_THAT(run({"query", store_, "--segment", "6+0003", "--passes"}, 1).err,
                HasSubstr("for their operator only"));
    EXPECT_THAT(run({"query", store_, "--segment", "6+0003", "--changes"}, 1).err,
                HasSubstr("for their operator only"));
    EXPECT_THAT(run({"calibrate", store_, "--dry-run"}, 1).err,
                HasSubstr("for their operator only"));
    EXPECT_THAT(run({"publish", store_}, 1).err, HasSubstr("who holds the key publishes"));
    EXPECT_THAT(run({"query", store_, "--events"}).err,
                HasSubstr("of at least five cars is published there"));
    EXPECT_THAT(run({"query", store_, "--worst", "3", "--since", "2026-03-15"}, 1).err,
                HasSubstr("given by whole months"));
    const auto info = run({"info", store_, "--json"}).out;
    EXPECT_THAT(info, AllOf(HasSubstr("\"published_alone\""), Not(HasSubstr("\"v-"))));
    EXPECT_THAT(run({"info", store_}).out, HasSubstr("at least 5 of 5 cars"));
}

TEST_F(Crowd, IsOnAServerWhatItIsInAFile) {
    PostgresServer server;
    const auto address = server.new_database("roads");
    const auto file = store_;
    run({"init", file, "--network", at("road.osm"), "--privacy", "crowd"});
    EXPECT_THAT(run({"copy", file, address}).err,
                HasSubstr("a superuser hides these with 'macadam privacy postgresql://SUPERUSER@"));
    run({"import", file, at("trips"), "--method", "kf"});
    write_file(folder_ / "trips" / "bad.trip.csv", "t_s,acc_z_mps2\n0,9.8\n");
    const auto objects = at("objects");
    run({"submit", address, at("trips"), "--objects", objects});
    EXPECT_THAT(run({"worker", address, "--once", "--keep-logs"}, 1).err,
                HasSubstr("is a crowd database, whose logs are erased once they are worked out"));
    const auto worked = run({"worker", address, "--once", "--method", "kf"});
    EXPECT_THAT(worked.out + worked.err, HasSubstr("were removed, for privacy"));
    for (const auto& each : fs::recursive_directory_iterator{objects}) {
        EXPECT_FALSE(each.is_regular_file()) << each.path(); // not even the one that was refused
    }
    const auto expect_same = [&](const std::vector<std::string>& words) {
        auto on_server = words, in_file = words;
        on_server.insert(on_server.begin() + 1, address);
        in_file.insert(in_file.begin() + 1, file);
        EXPECT_EQ(run(on_server).out, run(in_file).out) << words.front();
    };
    expect_same({"info", "--digest"});
    await_a_month();
    expect_same({"publish"});
    const auto ways_in_file = exported_ways();
    store_ = address;
    EXPECT_EQ(exported_ways(), ways_in_file);
    EXPECT_THAT(ways_in_file, Not(IsEmpty()));
    expect_same({"forget", "--vehicle-id", "car-1"});
    expect_same({"info", "--digest"});
    expect_same({"query", "--segment", "6+0003", "--passes", "--format", "csv"});
    expect_same({"export", "-o", "-", "--format", "csv"});
    EXPECT_THAT(run({"publish", address}, 1).err, HasSubstr("can be published once a month"));
    const std::vector<std::string> hide{"privacy", server.address("roads"), "crowd"};
    EXPECT_THAT(run(hide).err,
                HasSubstr("'REVOKE CONNECT ON DATABASE postgres, template1 FROM PUBLIC'"));
    ServerConnection{server.address()}.run(
        "REVOKE CONNECT ON DATABASE postgres, template1 FROM PUBLIC");
    EXPECT_EQ(run(hide).err, "");
    EXPECT_THAT(run({"cells", server.address("roads"), "--move", "1", "--to", address}, 1).err,
                HasSubstr("has no cell 1"));

    fs::remove_all(at("kept"));
    fs::rename(fs::path{std::getenv("XDG_CONFIG_HOME")} / "macadam", at("kept"));
    EXPECT_THAT(run({"query", address, "--segment", "6+0003", "--passes"}, 1).err,
                AllOf(HasSubstr("for their operator only"), HasSubstr("macadam/keys/")));
    EXPECT_THAT(run({"info", address}).out, HasSubstr("at least 5 of 5 cars"));
    EXPECT_EQ(exported_ways(), ways_in_file);
    EXPECT_THAT(run({"import", address, at("trips")}, 1).err, HasSubstr("the key of its cars is"));
}

TEST_F(Crowd, WhoseLogsWaitOnAServerForgetsThemToo) {
    PostgresServer server;
    store_ = server.new_database("roads");
    run({"init", store_, "--network", at("road.osm"), "--privacy", "crowd"});
    run({"submit", store_, at("trips/1.trip.csv"), "--objects", at("objects")});
    const auto forgot = run({"forget", store_, "--vehicle-id", "car-1"});
    EXPECT_THAT(forgot.err, HasSubstr("importing the logs that wait in the queue, first"));
    EXPECT_THAT(forgot.out, HasSubstr("1 trip permanently deleted"));
    EXPECT_THAT(run({"info", store_, "--json"}).out, HasSubstr("\"trips\":0,"));
}

TEST_F(Crowd, IsNeverMadeOfRoadsTracedFromTrips) {
    EXPECT_THAT(
        run({"init", store_, "--trace", at("trips/0.trip.csv"), "--privacy", "crowd"}, 2).err,
        HasSubstr("--trace cannot be combined with --privacy crowd"));
}

TEST_F(Crowd, IsNeverMadeOfTheRoadsNearTrips) {
    EXPECT_THAT(run({"init",
                     store_,
                     "--network",
                     source_folder() + "/sample_data/fleet/network.osm.pbf",
                     "--around",
                     at("trips/0.trip.csv"),
                     "--privacy",
                     "crowd"},
                    2)
                    .err,
                HasSubstr("--around cannot be combined with --privacy crowd: the outline of the "
                          "roads would show where the trips went"));
}

TEST_F(Crowd, ComesOfOnesOwnCarsByTrimmingThem) {
    make("own");
    const auto before = exported_ways();
    EXPECT_TRUE(before.contains(2));
    EXPECT_THAT(run({"privacy", store_, "crowd"}).out, HasSubstr("6 trips trimmed"));
    EXPECT_THAT(exported_ways(), IsEmpty());
    EXPECT_THAT(run({"query", store_, "--way", "1", "--format", "csv"}).out,
                Not(HasSubstr("\n1+")));
    EXPECT_THAT(run({"query", store_, "--way", "6", "--format", "csv"}).out, HasSubstr("6+0003"));
    EXPECT_THAT(run({"privacy", store_, "own"}, 1).err, HasSubstr("cannot be restored"));
    EXPECT_THAT(run({"privacy", store_, "crowd"}, 1).err,
                HasSubstr("is already a crowd "
                          "database"));
    run({"publish", store_});
    EXPECT_THAT(exported_ways(), Not(IsEmpty()));
}

TEST_F(Crowd, ComingOfOnesOwnCarsLeavesTripsAsTheyAreThatWereTrimmedOnThePhone) {
    state_trimmed(300);
    make("own");
    EXPECT_THAT(run({"privacy", store_, "crowd"}).out,
                HasSubstr("now a crowd database: 0 trips trimmed, 0 passes deleted; 6 trips had "
                          "been trimmed when recorded"));
    const auto digest = run({"info", store_, "--digest"}).out;
    store_ = at("imported.gpkg");
    make("crowd");
    EXPECT_EQ(digest, run({"info", store_, "--digest"}).out);
}

TEST_F(Crowd, ComingOfOnesOwnCarsTrimsTripsAgainThatWereTrimmedTooLittle) {
    state_trimmed(299);
    make("own");
    EXPECT_THAT(run({"privacy", store_, "crowd"}).out,
                AllOf(HasSubstr("6 trips trimmed"), Not(HasSubstr("had been trimmed"))));
}

TEST_F(Crowd, ComparesWhatIsPublishedWithoutCarsAndSpeeds) {
    make("crowd");
    std::string survey{"way_id,direction,from_m,to_m,mri\n"};
    for (int way = 1; way <= crowd_ways; ++way) {
        survey += fmt::format("{},forward,0,199,2\n", way);
    }
    write_file(folder_ / "survey.csv", survey);
    EXPECT_THAT(run({"compare", store_, at("survey.csv")}).out, HasSubstr("0 shared segments"));

    run({"publish", store_});
    const auto text = run({"compare", store_, at("survey.csv"), "-o", at("page.html")}).out;
    EXPECT_THAT(text, Not(HasSubstr("\n0 shared segments")));
    EXPECT_THAT(text, HasSubstr("Road class"));
    for (const auto& shown : {text, read_file(folder_ / "page.html")}) {
        EXPECT_THAT(shown,
                    AllOf(Not(HasSubstr("Speed")),
                          Not(HasSubstr("Car of")),
                          Not(HasSubstr("v-")),
                          Not(HasSubstr("not anonymised"))));
    }
    EXPECT_THAT(run({"compare", store_, at("survey.csv"), "--car-a", "car-1"}, 1).err,
                HasSubstr("is a crowd database, which tells no cars apart"));
}

} // namespace
} // namespace macadam::testing
