// `trace --profile` and `trace --against`, by the program itself.

#include "support/program/program.hpp"
#include "support/roads/drive.hpp"

#include "estimator/iri/iri.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

constexpr double fine_m = 0.05;

/// A drive of 800 m due east, rough from 300 to 500 m.
class TraceOutputs : public ::testing::Test {
protected:
    void SetUp() override {
        folder_ = fresh_folder();
        const auto text =
            text_of(drive_over(road_, drive_, *built_in_vehicle("golden-car")), drive_);
        write_file(folder_ / "drive.trip.csv", text);
    }

    std::string at(const std::string& name) const { return (folder_ / name).string(); }

    testing::Run trace(std::vector<std::string> more) const {
        std::vector<std::string> words{"trace", at("drive.trip.csv"), "--method", "kf"};
        words.insert(words.end(), more.begin(), more.end());
        return run_macadam(words);
    }

    /// E1926 on the road itself.
    double true_iri(double from_m, double to_m) const {
        std::vector<double> elevation_m;
        for (int i = 0; i * fine_m < drive_.length_m; ++i) {
            elevation_m.push_back(road_(i * fine_m));
        }
        const auto stroke = rectified_stroke_mm_per_m(elevation_m, fine_m);
        double sum = 0;
        for (auto i = std::lround(from_m / fine_m); i < std::lround(to_m / fine_m); ++i) {
            sum += static_cast<double>(stroke[static_cast<std::size_t>(i)]);
        }
        return sum * fine_m / (to_m - from_m);
    }

    /// Rows of 50 m from from_m to to_m, as places of their middles and the true IRI.
    std::string survey(double from_m, double to_m, double unit = 1) const {
        std::string text = "lat_deg,lon_deg,iri\n";
        for (double middle_m = from_m + 25; middle_m < to_m; middle_m += 50) {
            const auto place = place_of(drive_, middle_m);
            const bool driven = middle_m > 0 && middle_m < drive_.length_m - 25;
            const double iri = driven ? true_iri(middle_m - 25, middle_m + 25) : 1;
            text += fmt::format("{:.9f},{:.9f},{}\n", place.lat_deg, place.lon_deg, iri * unit);
        }
        write_file(folder_ / "survey.csv", text);
        return at("survey.csv");
    }

    const Drive drive_{.length_m = 800};
    const Road road_ = patched_road([](double at_m) { return at_m > 300 && at_m < 500; }, 2);
    fs::path folder_;
};

/// Cells of one column of CSV.
std::vector<std::string> column(const std::string& csv, const std::string& name) {
    std::istringstream lines{csv};
    std::vector<std::string> values;
    std::optional<std::size_t> wanted;
    for (std::string line; std::getline(lines, line);) {
        std::istringstream cells{line};
        std::size_t i = 0;
        for (std::string cell; std::getline(cells, cell, ','); ++i) {
            if (wanted == i) {
                values.push_back(cell);
            } else if (cell == name) {
                wanted = i;
            }
        }
    }
    return values;
}

/// The log without its vibration from 20 to 23 s, as if the sensor had fallen silent.
std::string with_hole(const std::string& text) {
    std::istringstream lines{text};
    std::string out;
    std::size_t rows = 0;
    for (std::string line; std::getline(lines, line);) {
        const bool is_row = !line.empty() && std::isdigit(static_cast<unsigned char>(line[0])) != 0;
        if (is_row) {
            const double t_s = std::stod(line);
            const bool is_fix = line.find(",,,,,") != std::string::npos;
            if (t_s > 20 && t_s < 23 && !is_fix) {
                continue;
            }
            ++rows;
        }
        out += (line.starts_with("# end rows") ? fmt::format("# end rows: {}", rows) : line) + "\n";
    }
    return out;
}

} // namespace

TEST_F(TraceOutputs, AProfileIsAsRoughForIriAsTheTraceSays) {
    for (const char* const method : {"kf", "smoother"}) {
        const auto file = at(fmt::format("{}.erd", method));
        const auto run = run_macadam({"trace",
                                      at("drive.trip.csv"),
                                      "--method",
                                      method,
                                      "--length",
                                      "200",
                                      "--profile",
                                      file});
        ASSERT_EQ(run.exit_status, 0) << run.err;
        EXPECT_THAT(run.err, HasSubstr(".erd: mean of both tracks from "));
        const auto iri = run_macadam({"iri", file, "--from-m", "200", "--to-m", "400"});
        ASSERT_EQ(iri.exit_status, 0) << iri.err;
        const double of_trace = std::stod(column(run.out, "iri").at(1));
        const double of_profile = std::stod(column(iri.out, "iri_centre").at(0));
        EXPECT_NEAR(of_profile / of_trace, 1, 0.05) << method;
    }
}

TEST_F(TraceOutputs, AProfileSaysWhatItIsAndNotWhereTheCarWas) {
    ASSERT_EQ(trace({"--profile", at("road.erd")}).exit_status, 0);
    auto text = read_file(at("road.erd"));
    text.resize(text.find("\nEND\n"));
    EXPECT_THAT(text, HasSubstr("TITLE   Estimated by macadam trace"));
    EXPECT_THAT(text, HasSubstr("HISTORY Vehicle golden-car, 72 to 72 km/h, method kf\n"));
    EXPECT_THAT(text, HasSubstr("XUNITS  m\n"));
    EXPECT_THAT(text,
                AllOf(Not(HasSubstr("trip_id")), Not(HasSubstr("48.0")), Not(HasSubstr("2026"))));
}

TEST_F(TraceOutputs, EachPartWithoutAHoleGetsAProfileOfItsOwn) {
    write_file(folder_ / "drive.trip.csv", with_hole(read_file(folder_ / "drive.trip.csv")));
    const auto run = trace({"--profile", at("road.erd")});
    ASSERT_EQ(run.exit_status, 0) << run.err;
    EXPECT_THAT(run.err, AllOf(HasSubstr("road.erd: "), HasSubstr("road-2.erd: ")));
    EXPECT_THAT(read_file(at("road-2.erd")), HasSubstr("XSTART  46"));
    EXPECT_FALSE(fs::exists(at("road-3.erd")));
}

TEST_F(TraceOutputs, RefusesProfilesThatCannotBe) {
    EXPECT_EQ(trace({"--profile", at("road.csv")}).exit_status, 2);
    const auto lateral = trace({"--channels", "lateral", "--profile", at("road.erd")});
    EXPECT_EQ(lateral.exit_status, 1);
    EXPECT_THAT(lateral.err,
                HasSubstr("was estimated from lateral acceleration only, which does not give "
                          "elevations"));
    EXPECT_FALSE(fs::exists(at("road.erd")));
}

/// A car that is known, noise-free: what is left is the filters' and the rows' borders. Travel
/// begins where the receiver, 0.2 s late, saw the car first: 4 m behind the start.
TEST_F(TraceOutputs, ASurveyOfTheTruthIsMet) {
    const auto run = trace({"--against", survey(100, 750)});
    ASSERT_EQ(run.exit_status, 0) << run.err;
    const auto truths = column(run.out, "survey");
    const auto errors = column(run.out, "error");
    ASSERT_EQ(errors.size(), 13U);
    for (std::size_t i = 0; i < errors.size(); ++i) {
        EXPECT_LT(std::abs(std::stod(errors[i])), 0.1 * std::stod(truths[i])) << i;
        EXPECT_NEAR(
            std::stod(column(run.out, "from_m")[i]), 104 + 50 * static_cast<double>(i), 0.5);
        EXPECT_LT(std::stod(column(run.out, "distance_m")[i]), 0.1);
    }
    EXPECT_THAT(run.err,
                HasSubstr("13 of the survey's 13 rows were driven, 13 times in all; 13 "
                          "compared\n"));
    EXPECT_THAT(run.err, HasSubstr("corr.  in 90 %\nall                 13"));
}

TEST_F(TraceOutputs, SaysHowMuchOfASurveyWasNotDriven) {
    const auto run = trace({"--against", survey(100, 1200)});
    ASSERT_EQ(run.exit_status, 0) << run.err;
    EXPECT_THAT(run.err, HasSubstr("of the survey's 22 rows were driven"));
    EXPECT_EQ(column(run.out, "survey_line").back(), "14") << "of 700 to 750 m";
}

TEST_F(TraceOutputs, TakesASurveyInInchesAMile) {
    const auto metric = trace({"--against", survey(100, 700)});
    const auto inches = trace({"--against", survey(100, 700, 63.36), "--unit", "in/mi"});
    EXPECT_EQ(inches.out, metric.out);
    EXPECT_THAT(metric.out, StartsWith("survey_line,pass,lat_deg,"));
}

TEST_F(TraceOutputs, GivesASurveyAsJsonAndAsAFigure) {
    const auto run = trace({"--against", survey(100, 700), "--json", "-o", at("both.svg")});
    ASSERT_EQ(run.exit_status, 0) << run.err;
    EXPECT_THAT(run.out, StartsWith("{\"survey_rows\":12,\"met\":12,\"score\":{\"pieces\":12,"));
    EXPECT_THAT(read_file(at("both.svg")), AllOf(StartsWith("<svg"), HasSubstr("<circle")));
}

/// What one drive says may stand for the survey of another.
TEST_F(TraceOutputs, ATraceIsASurvey) {
    write_file(folder_ / "trace.csv", trace({"--length", "50"}).out);
    const auto run = trace({"--against", at("trace.csv")});
    ASSERT_EQ(run.exit_status, 0) << run.err;
    EXPECT_THAT(run.err, HasSubstr("\nall "));
}

TEST_F(TraceOutputs, RefusesASurveyOfAnotherRoad) {
    write_file(folder_ / "far.csv", "lat_deg,lon_deg,iri\n50,11,2\n50,11.001,2\n");
    const auto run = trace({"--against", at("far.csv")});
    EXPECT_EQ(run.exit_status, 1);
    EXPECT_THAT(run.err,
                HasSubstr("drive.trip.csv: covers none of the survey's 2 rows, expected some "
                          "within 8 m and 30 degrees of its path"));
}

TEST_F(TraceOutputs, RefusesWordsThatDoNotFitASurvey) {
    const auto survey_file = survey(100, 700);
    EXPECT_EQ(trace({"--max-distance", "5"}).exit_status, 2);
    EXPECT_EQ(trace({"-o", at("a.svg")}).exit_status, 2);
    EXPECT_EQ(trace({"--against", survey_file, "--length", "50"}).exit_status, 2);
    EXPECT_EQ(trace({"--against", survey_file, "--max-angle", "0"}).exit_status, 2);
    EXPECT_EQ(trace({"--against", survey_file, "-o", at("a.png")}).exit_status, 2);
    EXPECT_EQ(trace({"--against", survey_file, "--profile", survey_file}).exit_status, 2);
}

} // namespace macadam::testing
