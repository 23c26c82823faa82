#include "storage/trips/trip_reader.hpp"

#include "estimator/common/error.hpp"
#include "support/files/compressed.hpp"
#include "support/files/files.hpp"
#include "support/program/places.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

using namespace macadam;
using namespace macadam::testing;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;

namespace {

/// A log of the given header and rows, with the right end.
std::string log_of(const std::string& header, const std::vector<std::string>& rows) {
    std::string text = "# macadam-trip 1\n" + header + "\n";
    for (const auto& row : rows) {
        text += row + "\n";
    }
    return text + "# end rows: " + std::to_string(rows.size()) + "\n";
}

const TripNeeds everything{.acc = true, .gyro = true, .speed = true, .fixes = true};

std::string hash_of(const TripSource& source) {
    return OpenTrip{source}.sha256();
}

TripLog read_text(std::string_view text, const TripNeeds& needs = everything) {
    return read_trip({written(test_folder(), "a.trip.csv", text), ""}, needs);
}

std::string refusal_of_text(std::string_view text, const TripNeeds& needs = everything) {
    return refusal_of([&] { read_text(text, needs); });
}

const std::string small = log_of("t_s,acc_z_mps2,speed_mps", {"0,9.81,", "0.01,9.9,", "0.02,,20"});

} // namespace

TEST(TripReader, PutsEachSensorIntoItsOwnStream) {
    const auto trip = read_text(small);
    EXPECT_THAT(trip.acc.t_s, ElementsAre(0, 0.01));
    EXPECT_THAT(trip.acc.z, ElementsAre(9.81F, 9.9F));
    EXPECT_TRUE(std::isnan(trip.acc.x[0]));
    EXPECT_THAT(trip.speed.t_s, ElementsAre(0.02));
    EXPECT_THAT(trip.speed.speed_mps, ElementsAre(20.0F));
    EXPECT_THAT(trip.rows, ElementsAre(row_content::acc, row_content::acc, row_content::speed));
}

TEST(TripReader, ReadsAFixWithWhatTheReceiverSaysOfIt) {
    const auto trip = read_text(log_of("t_s,lat_deg,lon_deg,gnss_speed_mps,course_deg,hacc_m",
                                       {"1,48.25,16.5,13.5,271.25,3.5"}));
    ASSERT_EQ(trip.fixes.size(), 1U);
    const auto& fix = trip.fixes.front();
    EXPECT_EQ(fix.at, (GeoPoint{48.25, 16.5}));
    EXPECT_EQ(fix.speed_mps, 13.5F);
    EXPECT_EQ(fix.course_deg, 271.25F);
    EXPECT_EQ(fix.accuracy_m, 3.5F);
}

TEST(TripReader, ReadsAllThatTheHeadSays) {
    const auto meta =
        read_text("# macadam-trip 1\n"
                  "# trip_id: t7\n# vehicle_id: v9\n# t0_utc: 2018-08-02T16:14:48.25Z\n"
                  "# frame: FRD\n# gravity: removed\n# mount_rpy_deg: 1, -2.5, 90\n"
                  "# mount_quat: 0 0 0 1\n# acc_sensor_pos_m: 1.2 0 0.5\n"
                  "# gnss_antenna_pos_m: 1 0 1.4\n# gnss_latency_s: 0.2\n"
                  "# speed_latency_s: 0.05\n# speed_scale: 1.01\n# operator: me: myself\n"
                  "# mount: auto\nt_s\n# end rows: 0\n")
            .meta;
    EXPECT_EQ(meta.trip_id, "t7");
    EXPECT_EQ(meta.vehicle_id, "v9");
    EXPECT_EQ(meta.t0_utc_s, 1533226488.25); // date -u -d 2018-08-02T16:14:48.25Z +%s.%N
    EXPECT_EQ(meta.frame, Frame::frd);
    EXPECT_FALSE(meta.gravity_included);
    EXPECT_TRUE(meta.mount_auto);
    EXPECT_EQ(meta.mount_rpy_deg, (std::array{1.0, -2.5, 90.0}));
    EXPECT_EQ(meta.mount_quat, (std::array{0.0, 0.0, 0.0, 1.0}));
    EXPECT_EQ(meta.acc_sensor_pos_m, (std::array{1.2, 0.0, 0.5}));
    EXPECT_EQ(meta.gnss_antenna_pos_m, (std::array{1.0, 0.0, 1.4}));
    EXPECT_EQ(meta.gnss_latency_s, 0.2);
    EXPECT_EQ(meta.speed_latency_s, 0.05);
    EXPECT_EQ(meta.speed_scale, 1.01);
    EXPECT_EQ(meta.other.at("operator"), "me: myself");
}

TEST(TripReader, TakesUnknownAndEmptyValuesForNone) {
    const auto meta = read_text("# macadam-trip 1\n# vehicle_id: unknown\n# t0_utc: unknown\n"
                                "# acc_sensor_pos_m:\n# speed_scale: unknown\nt_s\n# end rows: 0\n")
                          .meta;
    EXPECT_EQ(meta.vehicle_id, "");
    EXPECT_FALSE(meta.t0_utc_s || meta.acc_sensor_pos_m || meta.speed_scale);
}

TEST(TripReader, KeepsAMountThatIsFreeText) {
    const auto meta =
        read_text("# macadam-trip 1\n# mount: phone: X right\nt_s\n# end rows: 0\n").meta;
    EXPECT_FALSE(meta.mount_auto);
    EXPECT_EQ(meta.other.at("mount"), "phone: X right");
}

TEST(TripReader, SaysWhatAKeyExpects) {
    EXPECT_THAT(refusal_of_text("# macadam-trip 1\n# mount_rpy_deg: 1 2\nt_s\n# end rows: 0\n"),
                EndsWith("a.trip.csv:2: key 'mount_rpy_deg' is '1 2', expected three numbers"));
    EXPECT_THAT(refusal_of_text("# macadam-trip 1\n# frame: ENU\nt_s\n# end rows: 0\n"),
                EndsWith("key 'frame' is 'ENU', expected FLU, FRD or sensor"));
    EXPECT_THAT(refusal_of_text("# macadam-trip 1\n# gravity: yes\nt_s\n# end rows: 0\n"),
                EndsWith("key 'gravity' is 'yes', expected included or removed"));
    EXPECT_THAT(
        refusal_of_text("# macadam-trip 1\n# t0_utc: 2018-08-02 16:14\nt_s\n# end rows: 0\n"),
        HasSubstr("key 't0_utc' is '2018-08-02 16:14', expected a time like"));
    EXPECT_THAT(refusal_of_text("# macadam-trip 1\n# mount_quat: 1 1 0 0\nt_s\n# end rows: 0\n"),
                HasSubstr("of length 1"));
    EXPECT_THAT(refusal_of_text("# macadam-trip 1\n# speed_scale: 0\nt_s\n# end rows: 0\n"),
                HasSubstr("expected a number above 0"));
    EXPECT_THAT(refusal_of_text("# macadam-trip 1\n# gnss_latency_s: fast\nt_s\n# end rows: 0\n"),
                HasSubstr("key 'gnss_latency_s' is 'fast', expected a number"));
    EXPECT_THAT(refusal_of_text("# macadam-trip 1\n# trimmed_m: -1\nt_s\n# end rows: 0\n"),
                HasSubstr("key 'trimmed_m' is '-1', expected a length of 0 m or more"));
}

TEST(TripReader, ReadsTheSameFromTextOfAnotherSystem) {
    const auto plain = read_text(log_of("t_s,acc_z_mps2", {"0,9.81", "0.01,-0.25"}));
    const auto other = read_text("\xef\xbb\xbf# macadam-trip 1\r\n\r\n t_s , acc_z_mps2 \r\n"
                                 "+0, 9.81E0\r\n\r\n# a remark\r\n1e-2,-2.5e-1\t\r\n# end rows: 2");
    EXPECT_EQ(plain.acc.t_s, other.acc.t_s);
    EXPECT_EQ(plain.acc.z, other.acc.z);
    EXPECT_EQ(plain.rows, other.rows);
}

TEST(TripReader, TakesNanForAnEmptyCell) {
    const auto trip = read_text(log_of("t_s,acc_z_mps2,speed_mps", {"0,nan,20", "1,NaN,"}));
    EXPECT_THAT(trip.rows, ElementsAre(row_content::speed, code(RowReason::no_sample)));
}

TEST(TripReader, KeepsTheNamesOfColumnsThatNobodyKnows) {
    const auto trip = read_text(log_of("t_s,odo_km,acc_z_mps2,mark,", {"0,many,9.8,bump,"}));
    EXPECT_THAT(trip.unknown_columns, ElementsAre("odo_km"));
    EXPECT_THAT(trip.rows, ElementsAre(row_content::acc));
}

TEST(TripReader, SaysWhyARowGaveNothing) {
    const auto trip = read_text(log_of("t_s,acc_z_mps2,speed_mps",
                                       {"0,9.8,",
                                        "1,9.8",
                                        "1,9.8,,",
                                        "1,9.8,fast",
                                        "1,1.2.3,20",
                                        "1,inf,",
                                        ",9.8,20",
                                        "1,,",
                                        "0,9.8,",
                                        "1,20000,",
                                        "1e11,9.8,",
                                        "1,9.8,"}));
    EXPECT_THAT(trip.rows,
                ElementsAre(row_content::acc,
                            code(RowReason::wrong_cell_count),
                            code(RowReason::wrong_cell_count),
                            code(RowReason::bad_number),
                            code(RowReason::bad_number),
                            code(RowReason::bad_number),
                            code(RowReason::no_time),
                            code(RowReason::no_sample),
                            code(RowReason::time_not_increasing),
                            code(RowReason::out_of_range),
                            code(RowReason::out_of_range),
                            row_content::acc));
    EXPECT_THAT(trip.acc.t_s, ElementsAre(0, 1));
}

TEST(TripReader, LosesToAStampOfTheFarFutureThatRowAndNoOther) {
    constexpr int wild = 1000;
    std::vector<std::string> rows;
    for (int i = 0; i < 5000; ++i) {
        rows.push_back((i == wild ? "4102444800" : std::to_string(0.01 * i)) + ",9.8,20");
    }
    const auto trip = read_text(log_of("t_s,acc_z_mps2,speed_mps", rows));
    EXPECT_EQ(trip.acc.t_s.size(), rows.size() - 1);
    EXPECT_EQ(trip.speed.t_s.size(), rows.size() - 1);
    EXPECT_EQ(trip.rows[wild], code(RowReason::time_not_increasing));
    EXPECT_EQ(std::ranges::count(trip.rows, row_content::acc | row_content::speed),
              std::ssize(rows) - 1);
}

TEST(TripReader, RefusesOldTimesSensorBySensor) {
    const auto trip =
        read_text(log_of("t_s,acc_z_mps2,speed_mps", {"0,9.8,", "2,9.8,", "1,9.8,20", "2,,20"}));
    EXPECT_THAT(trip.acc.t_s, ElementsAre(0, 2));
    EXPECT_THAT(trip.speed.t_s, ElementsAre(1, 2));
    EXPECT_THAT(
        trip.rows,
        ElementsAre(row_content::acc, row_content::acc, row_content::speed, row_content::speed));
}

TEST(TripReader, TakesNoPlaceWhereTheReceiverHasNone) {
    const auto trip =
        read_text(log_of("t_s,lat_deg,lon_deg,gnss_fix",
                         {"0,0,0,1", "1,-9999,16,1", "2,48,181,1", "3,48,16,0", "4,48,16,1"}));
    constexpr int bad = code(RowReason::out_of_range);
    EXPECT_THAT(trip.rows, ElementsAre(bad, bad, bad, bad, row_content::fix));
}

TEST(TripReader, TakesANegativeSpeedOrCourseOfTheReceiverForUnknown) {
    const auto trip = read_text(log_of("t_s,lat_deg,lon_deg,gnss_speed_mps,course_deg",
                                       {"0,48,16,-1,-1", "1,48.1,16,0,361"}));
    ASSERT_EQ(trip.fixes.size(), 2U);
    EXPECT_TRUE(std::isnan(trip.fixes[0].speed_mps));
    EXPECT_TRUE(std::isnan(trip.fixes[0].course_deg));
    EXPECT_EQ(trip.fixes[1].speed_mps, 0);
    EXPECT_TRUE(std::isnan(trip.fixes[1].course_deg));
}

TEST(TripReader, KeepsTheSpeedOfAReceiverThatSaysNoPlace) {
    const auto trip = read_text(log_of("t_s,gnss_speed_mps", {"0,12.5"}));
    ASSERT_EQ(trip.fixes.size(), 1U);
    EXPECT_EQ(trip.fixes[0].speed_mps, 12.5F);
    EXPECT_TRUE(std::isnan(trip.fixes[0].at.lat_deg));
}

TEST(TripReader, CountsAStaleFixOnce) {
    const auto trip =
        read_text(log_of("t_s,lat_deg,lon_deg,gnss_speed_mps",
                         {"0,48,16,9", "0.1,48,16,9", "0.2,48,16,9", "1,48.0001,16,9"}));
    constexpr int stale = code(RowReason::repeated_fix);
    EXPECT_THAT(trip.rows, ElementsAre(row_content::fix, stale, stale, row_content::fix));
}

TEST(TripReader, BelievesAReceiversClockThatAnEqualFixIsNew) {
    const auto trip = read_text(log_of("t_s,lat_deg,lon_deg,gnss_utc_s",
                                       {"0,48,16,1000", "1,48,16,1001", "1.1,48,16,1001"}));
    EXPECT_THAT(trip.rows,
                ElementsAre(row_content::fix, row_content::fix, code(RowReason::repeated_fix)));
}

TEST(TripReader, TakesTheMeanOfTheWheelsForSpeedWhereThereIsNoOther) {
    const auto trip = read_text(log_of("t_s,wheel_fl_mps,wheel_fr_mps,wheel_rl_mps,wheel_rr_mps",
                                       {"0,9,10,11,12", "1,8,,10,"}));
    EXPECT_THAT(trip.speed.speed_mps, ElementsAre(10.5F, 9.0F));
    const auto both = read_text(log_of("t_s,speed_mps,wheel_fl_mps", {"0,20,10", "1,,10"}));
    EXPECT_THAT(both.speed.speed_mps, ElementsAre(20.0F));
    EXPECT_EQ(both.rows[1], code(RowReason::unused_channel));
}

TEST(TripReader, HoldsOnlyTheSensorsThatAreNeeded) {
    const auto text = log_of("t_s,acc_z_mps2,gyro_x_radps,lat_deg,lon_deg",
                             {"0,9.8,,,", "1,,0.1,,", "2,9.8,0.1,48,16"});
    const auto trip = read_text(text, needs_of_match());
    EXPECT_THAT(trip.rows,
                ElementsAre(code(RowReason::unused_channel),
                            code(RowReason::unused_channel),
                            row_content::fix));
    EXPECT_TRUE(trip.acc.t_s.empty() && trip.gyro.t_s.empty());
}

TEST(TripReader, NamesTheColumnsThatAreMissing) {
    EXPECT_THAT(refusal_of_text(log_of("t_s,lat_deg,lon_deg,speed_mps", {}), needs_of_import()),
                EndsWith("a.trip.csv:2: the header has 't_s,lat_deg,lon_deg,speed_mps', expected "
                         "also acc_z_mps2 or acc_y_mps2"));
    EXPECT_THAT(refusal_of_text(log_of("t_s", {}), needs_of_match()),
                EndsWith("expected also lat_deg and lon_deg"));
    EXPECT_THAT(refusal_of_text(log_of("t_s,acc_y_mps2", {}), needs_of_trace()),
                HasSubstr("expected also speed_mps or gnss_speed_mps"));
}

TEST(TripReader, RefusesTwoColumnsOfOneName) {
    EXPECT_THAT(refusal_of_text(log_of("t_s,speed_mps,speed_mps", {})),
                EndsWith("a.trip.csv:2: column 'speed_mps' occurs twice, expected once"));
}

TEST(TripReader, KnowsThatALogIsCutOff) {
    EXPECT_THAT(
        refusal_of_text("# macadam-trip 1\nt_s\n0\n1\n"),
        EndsWith("a.trip.csv:4: the file ends here after 2 rows, expected '# end rows: N' at "
                 "its end"));
    EXPECT_THAT(
        refusal_of_text("# macadam-trip 1\nt_s\n0\n1\n# end rows: 20\n"),
        EndsWith("a.trip.csv:5: '# end rows: 20', expected '# end rows: 2', the number of rows "
                 "present"));
    EXPECT_THAT(refusal_of_text("# macadam-trip 1\n# trip_id: a\n"),
                HasSubstr("expected a header"));
}

TEST(TripReader, RefusesMoreAfterTheEnd) {
    EXPECT_THAT(refusal_of_text("# macadam-trip 1\nt_s\n0\n# end rows: 1\n\n2\n"),
                EndsWith("a.trip.csv:6: '2', expected the end of the file after '# end rows:'"));
}

TEST(TripReader, ShowsTheBytesOfWhatIsNoText) {
    EXPECT_THAT(
        refusal_of_text("PK\x03\x04 and more of it"),
        EndsWith("a.trip.csv:1: 'PK\\x03\\x04 and more of it', expected '# macadam-trip 1': "
                 "not a Macadam log; for other CSV files see 'macadam inspect'"));
    EXPECT_THAT(refusal_of_text(std::string_view{"# macadam-trip 1\nt_s\n0\0\n", 23}),
                EndsWith("a.trip.csv:3: '0\\x00', expected text"));
    EXPECT_THAT(refusal_of_text(std::string(3 << 20, 'x')), HasSubstr("expected lines shorter"));
    EXPECT_THAT(refusal_of_text(""),
                EndsWith("a.trip.csv: is empty, expected a trip log ('# macadam-trip 1')"));
}

TEST(TripReader, SaysWhyAFileCannotBeRead) {
    const auto folder = test_folder();
    EXPECT_THAT(refusal_of([&] {
                    read_trip({folder / "none", ""}, everything);
                }),
                EndsWith("none: cannot be read: No such file or directory"));
    EXPECT_THAT(refusal_of([&] {
                    read_trip({folder, ""}, everything);
                }),
                EndsWith("cannot be read: Is a directory"));
}

TEST(TripReader, ReadsTheSameCompressed) {
    const auto folder = test_folder();
    const auto plain = read_trip({written(folder, "a.trip.csv", small), ""}, everything);
    for (const auto& bytes : {gzipped(small), zstd_compressed(small)}) {
        const auto trip = read_trip({written(folder, "b.trip.csv.x", bytes), ""}, everything);
        EXPECT_EQ(trip.sha256, plain.sha256);
        EXPECT_EQ(trip.acc.z, plain.acc.z);
    }
}

TEST(TripReader, ReadsPiecesOfGzipThatFollowEachOther) {
    const auto bytes = gzipped(small.substr(0, 20)) + gzipped(small.substr(20));
    EXPECT_EQ(read_text(bytes).rows.size(), 3U);
}

TEST(TripReader, RefusesCompressedDataThatIsCutOff) {
    const auto gz = gzipped(small);
    const auto zst = zstd_compressed(small);
    EXPECT_THAT(refusal_of_text(gz.substr(0, gz.size() - 4)), HasSubstr("gzip data is truncated"));
    EXPECT_THAT(refusal_of_text(zst.substr(0, zst.size() - 4)),
                HasSubstr("zstd data is "
                          "truncated"));
}

TEST(TripReader, RefusesCompressedDataThatIsDamaged) {
    auto gz = gzipped(small);
    gz[gz.size() - 6] = static_cast<char>(gz[gz.size() - 6] ^ 1); // of the checksum
    EXPECT_THAT(refusal_of_text(gz), HasSubstr("gzip data is damaged"));
}

TEST(TripReader, RefusesABomb) {
    const std::string zeros(20 << 20, '\n'); // beyond the 16 MiB that may grow at will
    EXPECT_THAT(refusal_of_text(gzipped("# macadam-trip 1\n" + zeros)),
                HasSubstr("grows more than 100-fold when decompressed"));
}

TEST(TripReader, HashesTheContentItself) {
    const auto file = written(test_folder(), "a.trip.csv.gz", gzipped(small));
    EXPECT_EQ(hash_of({file, ""}), read_trip({file, ""}, everything).sha256);
    // FIPS 180-2, appendix B.1
    EXPECT_EQ(hash_of({written(test_folder(), "abc", "abc"), ""}),
              "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(OpenTrip, IsRecognisedBeforeItIsParsed) {
    const auto file = written(test_folder(), "a.trip.csv.gz", gzipped(small));
    OpenTrip trip{{file, ""}};
    const auto ahead = trip.sha256_ahead();
    ASSERT_TRUE(ahead);
    std::filesystem::remove(file); // it is open, and is not opened again
    EXPECT_EQ(trip.read(everything).rows.size(), 3U);
    EXPECT_EQ(trip.sha256(), *ahead);
}

TEST(OpenTrip, ThatIsLongIsHashedWhileItIsParsed) {
    const auto file = written(test_folder(), "a.trip.csv", small);
    OpenTrip trip{{file, ""}};
    EXPECT_FALSE(trip.sha256_ahead(small.size() - 1));
    const auto log = trip.read(everything);
    EXPECT_EQ(log.rows.size(), 3U);
    EXPECT_EQ(log.sha256, hash_of({file, ""}));
}

TEST(OpenTrip, HasAHashEvenIfItIsNoLog) {
    const auto file = written(test_folder(), "a.trip.csv.gz", gzipped("abc"));
    OpenTrip trip{{file, ""}};
    EXPECT_THAT(refusal_of([&] { trip.read(everything); }), HasSubstr("not a Macadam log"));
    EXPECT_EQ(trip.sha256(), hash_of({written(test_folder(), "abc", "abc"), ""}));
}

TEST(OpenTrip, HasNoHashIfItCannotBeReadToItsEnd) {
    const auto gz = gzipped("no log\n" + std::string(100'000, 'x'));
    const auto file = written(test_folder(), "a.trip.csv.gz", gz.substr(0, gz.size() - 4));
    OpenTrip trip{{file, ""}};
    EXPECT_THAT(refusal_of([&] { trip.read(everything); }), ::testing::Not(""));
    EXPECT_THAT(refusal_of([&] { trip.sha256(); }), HasSubstr("gzip data is truncated"));
}

TEST(TripReader, AccountsForEveryRowOfTwoRealTrips) {
    const std::string samples = source_folder() + "/sample_data/";
    const auto rav4 =
        read_trip({samples + "comma2k19/comma2k19_rav4.trip.csv", ""}, needs_of_import());
    const auto gyor = read_trip({samples + "gyor/gyor_q3_00.trip.csv", ""}, needs_of_import());
    EXPECT_EQ(rav4.rows.size(), 11808U);
    EXPECT_EQ(gyor.rows.size(), 25770U);
    for (const auto& trip : {rav4, gyor}) {
        const auto with = [&](std::uint8_t flag) {
            return static_cast<std::size_t>(
                std::count_if(trip.rows.begin(), trip.rows.end(), [&](std::uint8_t row) {
                    return row < 16 && (row & flag) != 0;
                }));
        };
        EXPECT_EQ(with(row_content::acc), trip.acc.t_s.size());
        EXPECT_EQ(with(row_content::speed), trip.speed.t_s.size());
        EXPECT_EQ(with(row_content::fix), trip.fixes.size());
    }
}

TEST(TripReader, StopsWhenThatIsWished) {
    std::string text = "# macadam-trip 1\nt_s\n";
    for (int i = 0; i < 70000; ++i) {
        text += "1\n";
    }
    std::stop_source source;
    source.request_stop();
    const auto file = written(test_folder(), "a.trip.csv", text);
    EXPECT_THAT(refusal_of([&] {
                    read_trip({file, ""}, everything, {.report = {}, .stop = source.get_token()});
                }),
                EndsWith("reading was stopped"));
}
