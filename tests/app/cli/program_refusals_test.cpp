// What the program says to files that are not what they should be, and what it leaves behind.

#include "support/program/program.hpp"
#include "support/roads/drive.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// A folder with a good trip, a store of its road with the trip in it, and room for bad files.
class Refusals : public ::testing::Test {
protected:
    void SetUp() override {
        folder_ = fresh_folder();
        const Drive drive{.length_m = 600};
        good_text_ = text_of(drive_over(patched_road([](double) { return false; }, 1),
                                        drive,
                                        *built_in_vehicle("golden-car")),
                             drive);
        good_ = file("good.trip.csv", good_text_);
        store_ = (folder_ / "roads.gpkg").string();
        ASSERT_EQ(run_macadam({"init", store_, "--trace", good_}).exit_status, 0);
        ASSERT_EQ(run_macadam({"import", store_, good_, "--method", "kf"}).exit_status, 0);
        digest_ = run_macadam({"info", store_, "--digest"}).out;
    }

    std::string file(const std::string& name, const std::string& text) const {
        write_file(folder_ / name, text);
        return (folder_ / name).string();
    }

    /// Another trip on the same road, which the store does not know.
    std::string other_trip() const {
        const Drive drive{.length_m = 600, .speed_mps = 17, .trip_id = "other"};
        return file("other.trip.csv",
                    text_of(drive_over(patched_road([](double) { return false; }, 2),
                                       drive,
                                       *built_in_vehicle("golden-car")),
                            drive));
    }

    void expect_store_unchanged() const {
        EXPECT_EQ(run_macadam({"info", store_, "--digest"}).out, digest_);
        EXPECT_FALSE(fs::exists(store_ + "-journal"));
    }

    fs::path folder_;
    std::string good_text_;
    std::string good_;
    std::string store_;
    std::string digest_;
};

TEST_F(Refusals, OfAnEmptyTripSayWhatWasExpected) {
    const auto run = run_macadam({"trace", file("empty.trip.csv", "")});
    EXPECT_EQ(run.exit_status, 1);
    EXPECT_THAT(run.err, HasSubstr("empty.trip.csv: is empty, expected"));
    EXPECT_THAT(run.out, IsEmpty());
}

TEST_F(Refusals, OfATruncatedTripNameTheLineWhereItEnds) {
    const auto cut = good_text_.substr(0, good_text_.find("# end rows"));
    const auto run = run_macadam({"import", store_, file("cut.trip.csv", cut), "--json"});
    EXPECT_EQ(run.exit_status, 1);
    EXPECT_THAT(run.out, HasSubstr("\"result\":\"rejected\""));
    EXPECT_THAT(run.out, ::testing::ContainsRegex("cut.trip.csv:[0-9]+: "));
    EXPECT_THAT(run.out, HasSubstr("# end rows"));
    expect_store_unchanged();
}

TEST_F(Refusals, OfABinaryTripShowItsFirstBytes) {
    const auto run =
        run_macadam({"match",
                     file("picture.trip.csv", std::string{"\x89PNG\r\n\x1a\n\0\0", 10}),
                     "--network",
                     store_});
    EXPECT_EQ(run.exit_status, 1);
    EXPECT_THAT(run.err, HasSubstr("expected '# macadam-trip 1'"));
}

TEST_F(Refusals, OfAMisheadedTripNameTheColumnsThatItLacks) {
    auto text = good_text_;
    for (const auto* column : {"acc_x_mps2", "acc_y_mps2", "acc_z_mps2"}) {
        text.replace(text.find(column), 3, "axx");
    }
    const auto run = run_macadam({"trace", file("misheaded.trip.csv", text)});
    EXPECT_EQ(run.exit_status, 1);
    EXPECT_THAT(run.err, ::testing::ContainsRegex("misheaded.trip.csv:8: "));
}

TEST_F(Refusals, OfOneBadTripLetTheOthersIn) {
    const auto run =
        run_macadam({"import", store_, file("bad.trip.csv", "hello\n"), other_trip(), "--json"});
    EXPECT_EQ(run.exit_status, 1);
    EXPECT_THAT(run.out, HasSubstr("\"result\":\"imported\""));
    EXPECT_THAT(run.err, HasSubstr("1 of 2 trips rejected"));
}

TEST_F(Refusals, NameAMissingFile) {
    EXPECT_THAT(run_macadam({"trace", "nowhere.trip.csv"}).err, HasSubstr("nowhere.trip.csv: "));
    EXPECT_THAT(
        run_macadam({"init", (folder_ / "new.gpkg").string(), "--network", "nowhere.osm.pbf"}).err,
        HasSubstr("nowhere.osm.pbf: "));
    EXPECT_THAT(run_macadam({"info", "nowhere.gpkg"}).err, HasSubstr("nowhere.gpkg: "));
    EXPECT_THAT(run_macadam({"iri", "nowhere.csv"}).err, HasSubstr("nowhere.csv: "));
    EXPECT_THAT(run_macadam({"trace", good_, "--vehicle", "nowhere.toml"}).err,
                HasSubstr("nowhere.toml: "));
}

TEST_F(Refusals, LeaveNoStoreBehindWithoutANetwork) {
    const auto store = folder_ / "new.gpkg";
    EXPECT_EQ(
        run_macadam({"init", store.string(), "--network", file("map.osm", "no map")}).exit_status,
        1);
    EXPECT_FALSE(fs::exists(store));
}

TEST_F(Refusals, OfAStoreThatExistsKeepIt) {
    const auto run = run_macadam({"init", store_, "--trace", good_});
    EXPECT_EQ(run.exit_status, 1);
    EXPECT_THAT(run.err, HasSubstr("roads.gpkg: "));
    expect_store_unchanged();
}

TEST_F(Refusals, OfAFileThatIsNoStoreSayWhoMakesOne) {
    const auto run = run_macadam({"query", file("text.gpkg", "just text"), "--worst", "3"});
    EXPECT_EQ(run.exit_status, 1);
    EXPECT_THAT(run.err, HasSubstr("macadam init"));
}

TEST_F(Refusals, ToReplaceAStoreOrAnInputKeepThem) {
    const auto onto_itself = run_macadam({"export", store_, "-o", store_});
    EXPECT_EQ(onto_itself.exit_status, 1);
    EXPECT_THAT(onto_itself.err, HasSubstr("expected another file to write to"));
    const auto other = (folder_ / "other.gpkg").string();
    fs::copy(store_, other);
    EXPECT_EQ(run_macadam({"export", store_, "-o", other}).exit_status, 1);

    const auto csv = (folder_ / "good.csv").string();
    fs::copy(good_, csv);
    EXPECT_EQ(run_macadam({"match", csv, "--network", store_, "-o", csv}).exit_status, 1);
    EXPECT_EQ(read_file(csv), good_text_);
    expect_store_unchanged();
}

TEST_F(Refusals, NameTheTripAndLeaveTheOthersBe) {
    const Drive slow{.length_m = 600, .rate_hz = 20, .trip_id = "slow"};
    const auto slow_trip = file("slow.trip.csv",
                                text_of(drive_over(patched_road([](double) { return false; }, 1),
                                                   slow,
                                                   *built_in_vehicle("golden-car")),
                                        slow));
    const auto run = run_macadam({"import",
                                  store_,
                                  slow_trip,
                                  "nowhere.trip.csv",
                                  file("cut.zip", "PK\x03\x04 and no more"),
                                  other_trip()});
    EXPECT_EQ(run.exit_status, 1);
    EXPECT_THAT(run.out, HasSubstr("slow.trip.csv: acceleration was sampled at 20.0 Hz"));
    EXPECT_THAT(run.out, HasSubstr("nowhere.trip.csv: "));
    EXPECT_THAT(run.out, HasSubstr("cut.zip: "));
    EXPECT_THAT(run.out, HasSubstr("imported  "));
    EXPECT_THAT(run_macadam({"trace", slow_trip}).err,
                HasSubstr("slow.trip.csv: acceleration was sampled"));
}

TEST_F(Refusals, OfALatencyThatNoReceiverHasNameItsLine) {
    auto text = good_text_;
    text.replace(text.find("gnss_latency_s: 0.2"), 19, "gnss_latency_s: 1e14");
    EXPECT_THAT(run_macadam({"trace", file("late.trip.csv", text)}).err,
                HasSubstr("late.trip.csv:7: key 'gnss_latency_s' is '1e14'"));
}

TEST_F(Refusals, OfAServersAddressWhereOnlyAFileServesSayHowToGetOne) {
    const std::string server = "postgresql://roads/all";
    const auto run = run_macadam({"export", server, "-o", "roads.qgz"});
    EXPECT_EQ(run.exit_status, 1);
    EXPECT_THAT(run.err, HasSubstr("'macadam copy postgresql://roads/all roads.gpkg' makes one"));
    EXPECT_THAT(run_macadam({"info", "mysql://roads/all"}).err, HasSubstr("expected a .gpkg file"));
}

TEST_F(Refusals, OfAPasswordInAnAddressDoNotRepeatIt) {
    const std::string server = "postgresql://me:s3cret@roads/all";
    for (const std::vector<std::string>& call : {std::vector<std::string>{"info", server},
                                                 {"import", server, good_},
                                                 {"query", server},
                                                 {"export", server, "-o", "a.csv"},
                                                 {"copy", store_, server},
                                                 {"copy", server, "a.gpkg"}}) {
        const auto run = run_macadam(call);
        EXPECT_EQ(run.exit_status, 2) << call.front();
        EXPECT_THAT(run.err, HasSubstr("~/.pgpass"));
        EXPECT_THAT(run.out + run.err, ::testing::Not(HasSubstr("s3cret")));
    }
}

TEST_F(Refusals, OfAFullDiskLeaveTheStoreAsItWas) {
    constexpr std::size_t room = 8192; // two pages: less than what comes in
    const auto trip = other_trip();
    const auto run = run_macadam({"import", store_, trip, "--method", "kf"}, room);
    EXPECT_EQ(run.exit_status, 1) << run.out << run.err;
    EXPECT_THAT(run.err, HasSubstr("roads.gpkg: "));
    expect_store_unchanged();
    EXPECT_EQ(run_macadam({"import", store_, trip, "--method", "kf"}).exit_status, 0);
}

TEST_F(Refusals, OfAFullDiskLeaveNoHalfExport) {
    const auto out = folder_ / "roads.geojson";
    const auto run = run_macadam({"export", store_, "-o", out.string()}, 4000);
    EXPECT_EQ(run.exit_status, 1);
    EXPECT_THAT(run.err, HasSubstr("roads.geojson"));
    for (const auto& entry : fs::directory_iterator{folder_}) {
        EXPECT_THAT(entry.path().filename().string(), ::testing::Not(HasSubstr("geojson")));
    }
}

TEST_F(Refusals, OfAFullStandardOutputAreAFailure) {
    const auto run = run_macadam_into("/dev/full", {"trace", good_, "--method", "kf"});
    EXPECT_EQ(run.exit_status, 1);
    EXPECT_THAT(run.err, HasSubstr("standard output: "));
}

TEST_F(Refusals, OfABoxInDisorderAreMisuse) {
    const auto run = run_macadam(
        {"export", store_, "-o", (folder_ / "a.csv").string(), "--bbox", "11,49,12,48"});
    EXPECT_EQ(run.exit_status, 2);
    EXPECT_THAT(run.err, HasSubstr("south < north; west > east crosses the antimeridian"));
}

TEST_F(Refusals, OfSensorsThatNobodyKnowsNameThem) {
    const std::pair<const char*, const char*> lists[] = {
        {"nose", "nose"}, {"vertical,nose", "nose"}, {"vertical,", ""}, {"both,roll", "both"}};
    for (const auto& [list, unknown] : lists) {
        const auto run = run_macadam({"trace", good_, "--channels", list});
        EXPECT_EQ(run.exit_status, 2) << list;
        EXPECT_THAT(run.err,
                    HasSubstr(fmt::format("--channels names '{}', expected automatic, both, or "
                                          "some of vertical,lateral,roll,pitch,yaw",
                                          unknown)));
    }
}

TEST_F(Refusals, OfRatesOfTurnForTheFilterSayWhatItKnows) {
    const auto run =
        run_macadam({"import", store_, good_, "--method", "kf", "--channels", "vertical,roll"});
    EXPECT_EQ(run.exit_status, 2);
    EXPECT_THAT(run.err,
                HasSubstr("--channels is 'vertical,roll', but --method kf supports vertical "
                          "and lateral only"));
    expect_store_unchanged();
}

TEST_F(Refusals, OfALogWithoutTheRatesThatAreAskedForNameTheColumns) {
    const auto run = run_macadam({"trace", good_, "--channels", "vertical,pitch"});
    EXPECT_EQ(run.exit_status, 1);
    EXPECT_THAT(run.err,
                HasSubstr("good.trip.csv: contains no angular rates, expected gyro_x_radps, "
                          "gyro_y_radps and gyro_z_radps"));
    EXPECT_THAT(run.out, IsEmpty());
}

TEST_F(Refusals, OfASizeOutOfRangeAreMisuse) {
    for (const auto* size : {"0x0", "big", "20000x100", "512"}) {
        EXPECT_EQ(
            run_macadam({"render", store_, "-o", (folder_ / "a.png").string(), "--size", size})
                .exit_status,
            2)
            << size;
    }
}

} // namespace
} // namespace macadam::testing
