// What real logs do wrong, one sentence each; the files are in tests/data/defects. Those that only
// show when a car drives are in tests/app/pipeline/defects_on_the_road_test.cpp.

#include "storage/trips/foreign/time_parsing.hpp"
#include "storage/trips/mappings/column_mapping_file.hpp"
#include "storage/trips/trip_reader.hpp"

#include "estimator/common/error.hpp"
#include "support/files/files.hpp"
#include "support/program/places.hpp"
#include "support/roads/walked_trips.hpp"

#include <gmock/gmock.h>

#include <cmath>

using namespace macadam;
using namespace macadam::testing;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::FloatNear;
using ::testing::HasSubstr;
using ::testing::SizeIs;

namespace {

const TripNeeds everything{.acc = true, .gyro = true, .speed = true, .fixes = true};

std::filesystem::path defect(const std::string& name) {
    return std::filesystem::path{source_folder()} / "tests/data/defects" / name;
}

TripLog read(const std::string& name) {
    return read_trip(find_trips(defect(name)).trips.at(0), everything);
}

TripLog read(const std::string& name, const std::string& mapping) {
    const auto shared = std::make_shared<const TripMapping>(read_mapping(defect(mapping).string()));
    return read_trip(find_trips(defect(name), shared).trips.at(0), everything);
}

constexpr int late = code(RowReason::time_not_increasing);
constexpr int acc = row_content::acc;
constexpr int speed = row_content::speed;
constexpr int fix = row_content::fix;

double time_of(const std::string& text, TimeMapping mapping) {
    const auto time = parse_time(text, mapping);
    return time ? time->s : std::nan("");
}

TimeMapping format(TimeFormat of) {
    return {.columns = {}, .format = of, .utc_offset_s = {}, .fraction_s = {}};
}

} // namespace

TEST(Defect02HiddenPause, OpensAgainWhereTheExportTellsOfIt) {
    const auto trip = read("02-hidden-pause");
    // The clock stood at 0.02 s for 299.98 s; of two samples with that stamp one is left.
    ASSERT_THAT(trip.acc.t_s, SizeIs(4));
    EXPECT_NEAR(trip.acc.t_s[1], 0.01, 1e-6);
    EXPECT_NEAR(trip.acc.t_s[2], 300, 1e-6);
    EXPECT_NEAR(trip.acc.t_s[3], 300.01, 1e-6);
    EXPECT_NEAR(trip.fixes[1].t_s, 300.005, 1e-6);
    EXPECT_NEAR(trip.meta.t0_utc_s.value(), 1759650000, 1e-3);
}

TEST(Defect03EqualStamps, CountOnceForEachSensor) {
    const auto trip = read("03-equal-stamps.trip.csv");
    EXPECT_THAT(trip.rows, ElementsAre(acc, speed, late, acc, late, speed, acc));
    EXPECT_THAT(trip.acc.z, ElementsAre(9.8F, 9.9F, 9.6F));
}

TEST(Defect04OutOfOrder, CostsOnlyTheRowsThatAreOld) {
    const auto trip = read("04-out-of-order.trip.csv");
    EXPECT_THAT(trip.rows, ElementsAre(fix, fix, late, fix, late, fix));
    EXPECT_THAT(trip.fixes, SizeIs(4));
}

TEST(Defect04WildStamp, CostsItselfOnly) {
    const auto trip = read("04-wild-stamp.trip.csv");
    EXPECT_THAT(trip.rows, ElementsAre(acc, acc, late, acc, acc, late, acc));
    EXPECT_THAT(trip.acc.t_s, ElementsAre(0, 0.01, 0.02, 0.03, 0.04));
}

TEST(Defect06TimeEncodings, AllSayTheSameInstant) {
    const double instant = 1559715331.25; // date -u -d 2019-06-05T06:15:31.25 +%s.%N
    const double midnight = 1559692800;
    auto number = format(TimeFormat::number);
    EXPECT_EQ(time_of("1559715331.25", number), instant);
    number.unit_s = 1e-3;
    EXPECT_NEAR(time_of("1559715331250", number), instant, 1e-6);
    number.unit_s = 1e-9;
    EXPECT_NEAR(time_of("1559715331250000000", number), instant, 1e-6);

    EXPECT_EQ(midnight + time_of("06:15:31.25", format(TimeFormat::clock)), instant);
    EXPECT_EQ(midnight + time_of("06:15:31:2500", format(TimeFormat::clock)), instant);
    EXPECT_EQ(midnight + time_of("61531.25", format(TimeFormat::compact_clock)), instant);
    auto tenths = format(TimeFormat::clock);
    tenths.fraction_s = 1e-4;
    EXPECT_EQ(midnight + time_of("6:15:31:2500", tenths), instant);

    EXPECT_EQ(time_of("2019-06-05T06:15:31.25Z", format(TimeFormat::year_month_day)), instant);
    EXPECT_EQ(time_of("2019-06-05 08:15:31,25+02:00", format(TimeFormat::year_month_day)), instant);
    auto local = format(TimeFormat::day_month_year);
    local.utc_offset_s = 7200;
    EXPECT_EQ(time_of("05/06/2019 08:15:31.25", local), instant);
}

TEST(Defect06TimeEncodings, OfNoSuchDayAreNoTime) {
    const auto date = format(TimeFormat::year_month_day);
    EXPECT_TRUE(std::isnan(time_of("0001-01-01T00:00:00Z", date)));
    EXPECT_TRUE(std::isnan(time_of("2019-02-30T00:00:00Z", date)));
    EXPECT_TRUE(std::isnan(time_of("25:00:00", format(TimeFormat::clock))));
}

TEST(Defect06LocalTime, WithoutAZoneDatesNothing) {
    const auto local = format(TimeFormat::day_month_year);
    EXPECT_FALSE(parse_time("05/06/2019 08:15:31", local)->dated);
}

TEST(Defect06TwoClocks, OfOneTripMeetWhereTheirOffsetsAreStated) {
    const auto trip = read("06-clock_acc.csv", "06-clock.toml");
    EXPECT_THAT(trip.acc.t_s, SizeIs(3));
    EXPECT_NEAR(trip.acc.t_s[1], 0.010, 1e-6); // 31.0090 s after 30.9990 s
    EXPECT_NEAR(trip.fixes[0].t_s, 0.501, 1e-6);
    EXPECT_NEAR(trip.meta.t0_utc_s.value(), 1559715330.999, 1e-3);
}

TEST(Defect07ChannelsThatStartLater, KeepTheirOwnTimes) {
    const auto trip = read("07-late-gyro");
    EXPECT_EQ(trip.acc.t_s.front(), 0);
    EXPECT_NEAR(trip.gyro.t_s.front(), 0.15, 1e-9);
}

TEST(Defect09NoFix, IsNoPlace) {
    const auto trip = read("09-no-fix.trip.csv");
    constexpr int none = code(RowReason::out_of_range);
    EXPECT_THAT(trip.rows, ElementsAre(none, none, none, fix, fix, fix));
    EXPECT_EQ(trip.fixes[0].accuracy_m, 419.0F); // which the odometer leaves out
    EXPECT_TRUE(std::isnan(trip.fixes[1].speed_mps));
}

TEST(Defect11StaleFix, IsTakenOnceHoweverOftenItIsWritten) {
    const auto trip = read("11-stale-fix.trip.csv");
    EXPECT_THAT(trip.fixes, SizeIs(3));
    EXPECT_THAT(trip.acc.t_s, SizeIs(30));
}

TEST(Defect12Units, BecomeOurs) {
    const auto trip = read("12-units.csv", "12-units.toml");
    EXPECT_THAT(trip.speed.speed_mps, ElementsAre(FloatNear(10, 1e-5F), FloatNear(20, 1e-5F)));
    EXPECT_NEAR(trip.fixes[1].speed_mps, 20, 1e-5);
    EXPECT_THAT(trip.acc.z, ElementsAre(FloatNear(9.80665F, 1e-5F), FloatNear(-4.903325F, 1e-5F)));
    EXPECT_EQ(trip.fixes[0].course_deg, 10);
    EXPECT_TRUE(std::isnan(trip.fixes[1].course_deg)); // -1 is none
}

TEST(Defect16Axes, AreTurnedAsTheMappingSays) {
    const auto trip = read("16-axes.csv", "16-axes.toml");
    EXPECT_EQ(trip.acc.x[0], 2);
    EXPECT_EQ(trip.acc.y[0], -1);
    EXPECT_EQ(trip.acc.z[0], 3);
    EXPECT_EQ(trip.gyro.x[0], 0.2F);
    EXPECT_EQ(trip.gyro.y[0], -0.1F);
}

TEST(Defect18Gravity, IsAddedWithTheSignOfThePhone) {
    for (const auto* const phone : {"android", "ios", "ios-standardised"}) {
        const auto trip = read(std::string{"18-gravity/"} + phone);
        EXPECT_TRUE(trip.meta.gravity_included) << phone;
        EXPECT_THAT(trip.acc.z, Each(FloatNear(10.0F, 1e-5F))) << phone;
        EXPECT_THAT(trip.acc.x, Each(FloatNear(0.01F, 1e-6F))) << phone;
        EXPECT_THAT(trip.gyro.z, Each(0.3F)) << phone; // rotation has one sign everywhere
        EXPECT_EQ(trip.rows.size(), 10U) << phone;
        EXPECT_EQ(trip.rows[0], code(RowReason::merged)) << phone;
    }
}

TEST(Defect19RawNumbers, TakeScaleOffsetAndSign) {
    const auto trip = read("19-offset.csv", "19-offset.toml");
    // 10 mg a count, upside down, 2048 being zero.
    EXPECT_THAT(trip.acc.z, ElementsAre(FloatNear(0, 1e-4F), FloatNear(-9.80665F, 1e-4F)));
}

TEST(Defect21Encodings, ReadAlike) {
    for (const auto* const file : {"21-bom.csv", "21-utf16le.csv", "21-double-encoded.csv"}) {
        const auto trip = read(file, "21-encoding.toml");
        EXPECT_THAT(trip.speed.t_s, ElementsAre(0, 0.5)) << file;
        EXPECT_THAT(trip.speed.speed_mps, ElementsAre(10.0F, 11.0F)) << file;
    }
}

TEST(Defect22Text, CostsOnlyTheRowsThatSayNothing) {
    const auto trip = read("22-text.csv", "22-text.toml");
    constexpr int all = acc | speed | fix;
    EXPECT_THAT(trip.rows,
                ElementsAre(all,
                            all,
                            code(RowReason::no_time),
                            acc | fix,
                            code(RowReason::bad_number),
                            code(RowReason::wrong_cell_count),
                            all));
    EXPECT_THAT(trip.speed.speed_mps, ElementsAre(10.0F, 10.5F, 11.5F));
    EXPECT_THAT(trip.acc.z, ElementsAre(9.97F, -0.15F, 9.8F, 9.9F));
    EXPECT_NEAR(trip.fixes[1].speed_mps, 10.5, 1e-5); // the second column "speed", in km/h
}

TEST(Defect23Truncation, OfOurLogIsRefused) {
    EXPECT_THAT(refusal_of([] { read("23-cut.trip.csv"); }),
                EndsWith("the file ends here after 2 rows, expected '# end rows: N' at its end"));
}

TEST(Defect23Truncation, OfAForeignLogCostsItsLastRow) {
    const auto trip = read("23-cut-cell.csv", "23-cut.toml");
    EXPECT_THAT(trip.rows, ElementsAre(acc, acc, code(RowReason::wrong_cell_count)));
}

TEST(Defect24LocaleOfDates, IsWhatTheMappingSays) {
    const auto day_first = parse_time("09/03/2024 10:00:00", format(TimeFormat::day_month_year));
    const auto month_first = parse_time("03/09/2024 10:00:00", format(TimeFormat::month_day_year));
    EXPECT_EQ(day_first->s, month_first->s);
    EXPECT_EQ(day_first->s, 1709978400); // date -u -d 2024-03-09T10:00 +%s
}
