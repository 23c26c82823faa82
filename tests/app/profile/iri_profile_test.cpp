// `macadam iri` and what is under it, on profiles in every form.

#include "support/program/program.hpp"

#include "app/profile/iri_analysis.hpp"
#include "estimator/iri/iri.hpp"
#include "storage/profiles/profile_reader.hpp"
#include "support/program/places.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <charconv>
#include <cmath>
#include <fstream>
#include <numeric>
#include <random>
#include <sstream>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

const fs::path data = fs::path{source_folder()} / "tests" / "data";
const std::string even = (data / "sorel" / "profile_1.txt").string();
const std::string uneven = (data / "sorel" / "profile_2.txt").string();

constexpr double foot_m = 0.3048;
constexpr double inch_m = 0.0254;

std::string expect_done(std::vector<std::string> words) {
    words.insert(words.begin(), "iri");
    const auto run = run_macadam(words);
    EXPECT_EQ(run.exit_status, 0) << run.err;
    EXPECT_EQ(run.err, "");
    return run.out;
}

Run refused(std::vector<std::string> words) {
    words.insert(words.begin(), "iri");
    auto run = run_macadam(words);
    EXPECT_EQ(run.out, "");
    return run;
}

/// A column of CSV with a header.
std::vector<double> column(const std::string& csv, const std::string& name) {
    std::istringstream lines{csv};
    std::string line;
    std::getline(lines, line);
    std::size_t index = 0;
    std::istringstream names{line};
    for (std::string one; std::getline(names, one, ',') && one != name;) {
        ++index;
    }
    std::vector<double> values;
    while (std::getline(lines, line)) {
        std::istringstream cells{line};
        std::string cell;
        for (std::size_t i = 0; i <= index; ++i) {
            std::getline(cells, cell, ',');
        }
        values.push_back(std::strtod(cell.c_str(), nullptr));
    }
    return values;
}

double mean(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// A column of the table of published values, by 20 m from 478.5 m.
std::vector<double> published(const std::string& name) {
    return column(read_file(data / "iri_reference" / "sorel_profile1_start478.5.csv"), name);
}

/// Two tracks that wander about one another.
struct Road {
    std::vector<double> left_m;
    std::vector<double> right_m;
};

Road rough_road(std::size_t points) {
    std::mt19937 random{17};
    std::normal_distribution<double> step_m{0, 0.0008};
    Road road;
    double left_m = 0;
    double right_m = 0;
    for (std::size_t i = 0; i < points; ++i) {
        const double both_m = step_m(random);
        road.left_m.push_back(left_m += both_m + 0.5 * step_m(random));
        road.right_m.push_back(right_m += both_m + 0.5 * step_m(random));
    }
    return road;
}

std::string csv_of(const Road& road, double step_m) {
    std::string csv = "station_m,left_m,right_m\n";
    for (std::size_t i = 0; i < road.left_m.size(); ++i) {
        csv += fmt::format("{:.6f},{:.9f},{:.9f}\n",
                           step_m * static_cast<double>(i),
                           road.left_m[i],
                           road.right_m[i]);
    }
    return csv;
}

std::string written(const std::string& name, const std::string& text) {
    const auto file = fresh_folder() / name;
    write_file(file, text);
    return file.string();
}

TEST(IriProgram, MeetsThePublishedSegmentsOfAMeasuredRoad) {
    const auto iri =
        column(expect_done({even, "--from-m", "478.5", "--to-m", "1018.5", "--length", "20"}),
               "iri_profile");
    const auto reference = published("A_init_11m_correct");
    ASSERT_EQ(iri.size(), 27U);
    for (std::size_t i = 0; i < iri.size(); ++i) {
        EXPECT_NEAR(iri[i], reference[i], 6e-5) << i; // four decimals are printed
    }
    EXPECT_NEAR(mean(iri), 3.3102, 1e-4 * 3.3102);
}

/// The same road, thinned unevenly by its publishers, who smooth nothing: 3.1132, not 3.310.
TEST(IriProgram, MeetsThePublishedSegmentsOfUnevenStations) {
    const auto iri = column(
        expect_done(
            {uneven, "--from-m", "478.5", "--to-m", "1018.5", "--length", "20", "--no-envelope"}),
        "iri_profile");
    const auto reference = published("published_code_semianalytical_on_profile_2_irregular");
    ASSERT_EQ(iri.size(), 27U);
    for (std::size_t i = 0; i < iri.size(); ++i) {
        // They start at the slope of 0.5 s (11.11 m) instead of 11 m: seen in the first 40 m.
        EXPECT_NEAR(iri[i], reference[i], (i < 2 ? 5e-3 : 1e-4) * reference[i]) << i;
    }
    EXPECT_NEAR(mean(iri), 3.1132, 5e-4 * 3.1132);
}

TEST(IriAnalysis, OfSegmentsIsThatOfLongerOnesAndOfTheWhole) {
    for (const auto& file : {even, uneven}) {
        const IriQuestion question{
            .profile = file, .step_m = {}, .from_m = 480, .to_m = 980, .envelope = true};
        const auto of_20 = iri_of_pieces(question, 20).channels[0];
        const auto of_100 = iri_of_pieces(question, 100).channels[0];
        const double whole = iri_of_pieces(question, {}).channels[0].whole;
        EXPECT_NEAR(of_20.whole, whole, 1e-9 * whole);
        EXPECT_NEAR(of_100.whole, whole, 1e-9 * whole);
        EXPECT_NEAR(mean(of_20.pieces), whole, 1e-9 * whole);
        EXPECT_NEAR(mean(of_100.pieces), whole, 1e-9 * whole);
    }
}

TEST(IriAnalysis, GivesMriAsMeanOfTheTracksAndHriOfTheMeanProfile) {
    const auto road = rough_road(4001);
    const auto file = written("a.csv", csv_of(road, 0.1));
    const auto report = iri_of_pieces(
        {.profile = file, .step_m = {}, .from_m = {}, .to_m = {}, .envelope = true}, {});
    std::vector<double> mean_m;
    for (std::size_t i = 0; i < road.left_m.size(); ++i) {
        mean_m.push_back((road.left_m[i] + road.right_m[i]) / 2);
    }
    const double left = iri_mm_per_m(road.left_m, 0.1);
    const double right = iri_mm_per_m(road.right_m, 0.1);
    // A nanometre is printed: 1e-5 of the slopes.
    EXPECT_NEAR(report.channels[0].whole, left, 1e-5 * left);
    EXPECT_NEAR(report.mri.value().whole, (left + right) / 2, 1e-5 * left);
    EXPECT_NEAR(report.hri.value().whole, iri_mm_per_m(mean_m, 0.1), 1e-5 * left);
    EXPECT_LT(report.hri->whole, report.mri->whole);
}

/// The form of the file that UMTRI publishes with its program: a step of 0.2069 ft, inches.
TEST(IriProgram, OfAnErdFileInFeetAndInchesIsThatOfTheSameRoadInMetres) {
    const double step_m = 0.2069 * foot_m;
    const auto road = rough_road(3001);
    std::string erd = "ERDFILEV2.00\n2, 3001, -1, 1, 5, 0.2069, -1,\n"
                      "SHORTNAMLElev.  RElev.  \nUNITSNAMin      in      \nXUNITS  ft\nEND\n";
    for (std::size_t i = 0; i < road.left_m.size(); ++i) {
        erd +=
            fmt::format(" {:12.7f} {:12.7f}\n", road.left_m[i] / inch_m, road.right_m[i] / inch_m);
    }
    const auto folder = fresh_folder();
    write_file(folder / "a.erd", erd);
    write_file(folder / "a.csv", csv_of(road, step_m));
    const auto of_erd = expect_done({(folder / "a.erd").string(), "--units", "in/mi"});
    const auto of_csv = expect_done({(folder / "a.csv").string()});
    EXPECT_THAT(of_erd, StartsWith("from_m,to_m,iri_left,iri_right,mri,hri,lead_in\n0.000,"));
    for (const char* const name : {"iri_left", "iri_right", "mri", "hri"}) {
        const double expected = 63.36 * column(of_csv, name).front();
        EXPECT_NEAR(column(of_erd, name).front(), expected, 1e-4 * expected) << name;
    }
}

TEST(IriProgram, OfAProFileInMilsIsThatOfTheSameRoadInMetres) {
    const auto road = rough_road(3001);
    std::string pro = "HEAD3,x\nCMET3,x\nMaker,mils,both,3.0,in\n0,0,0,0,0\nnone\n";
    for (std::size_t i = 0; i < road.left_m.size(); ++i) {
        pro += fmt::format(
            "{:.4f},{:.4f},\n", 1000 * road.left_m[i] / inch_m, 1000 * road.right_m[i] / inch_m);
    }
    const auto folder = fresh_folder();
    write_file(folder / "a.pro", pro);
    write_file(folder / "a.csv", csv_of(road, 3 * inch_m));
    const auto of_pro = column(expect_done({(folder / "a.pro").string(), "--length", "20"}), "mri");
    const auto of_csv = column(expect_done({(folder / "a.csv").string(), "--length", "20"}), "mri");
    ASSERT_EQ(of_pro.size(), 11U); // of 228.6 m
    for (std::size_t i = 0; i < of_pro.size(); ++i) {
        EXPECT_NEAR(of_pro[i], of_csv[i], 1e-4 * of_csv[i]);
    }
}

TEST(IriProgram, WritesWhatItReadAsErd) {
    const auto folder = fresh_folder();
    const auto file = (folder / "a.csv").string();
    const auto erd = (folder / "a.erd").string();
    write_file(file, csv_of(rough_road(2001), 0.05));
    const auto of_csv = column(expect_done({file, "-o", erd}), "mri").front();
    EXPECT_NEAR(column(expect_done({erd}), "mri").front(), of_csv, 1e-3 * of_csv);
    EXPECT_THAT(refused({uneven, "-o", erd}).err, HasSubstr("has uneven stations"));
    EXPECT_EQ(refused({file, "-o", "a.txt"}).exit_status, 2);
    EXPECT_THAT(refused({erd, "-o", erd}).err, HasSubstr("a.erd"));
}

TEST(IriProgram, FlagsThePiecesOfTheFirst60Metres) {
    const auto csv = expect_done({even, "--length", "20"});
    EXPECT_THAT(csv, HasSubstr("\n518.000,538.000,"));
    std::istringstream lines{csv};
    std::vector<std::string> flags;
    for (std::string line; std::getline(lines, line);) {
        flags.push_back(line.substr(line.rfind(',') + 1));
    }
    flags.resize(6);
    EXPECT_THAT(flags, ElementsAre("lead_in", "yes", "yes", "yes", "no", "no"));
    // With 100 m of it before, nothing shows.
    EXPECT_THAT(expect_done({even, "--from-m", "578", "--length", "20"}),
                ::testing::Not(HasSubstr("yes")));
}

TEST(IriProgram, ReportsTheLastPieceThoughTheEnvelopeEndsBeforeIt) {
    const auto file = written("a.csv", csv_of(rough_road(2001), 0.05)); // 100 m
    EXPECT_THAT(expect_done({file, "--length", "50"}), HasSubstr("\n50.000,99.800,"));
}

/// Moving means of the stroke, summed afresh at every place.
TEST(IriProgram, MovesABaseOf25FeetAlongTheProfile) {
    const auto road = rough_road(1201);
    const auto csv = expect_done({written("a.csv", csv_of(road, 0.1)), "--continuous"});
    const auto at_m = column(csv, "at_m");
    const auto left = column(csv, "iri_left");
    const auto mri = column(csv, "mri");
    const auto left_stroke = rectified_stroke_mm_per_m(road.left_m, 0.1);
    const auto right_stroke = rectified_stroke_mm_per_m(road.right_m, 0.1);
    ASSERT_EQ(at_m.size(), left_stroke.size() - 76); // 76.2 steps
    EXPECT_NEAR(at_m.front(), 7.7 - 3.81, 1e-3);
    for (std::size_t i = 0; i < at_m.size(); i += 50) {
        double sum_left = 0.2 * static_cast<double>(left_stroke[i]);
        double sum_right = 0.2 * static_cast<double>(right_stroke[i]);
        for (std::size_t j = i + 1; j <= i + 76; ++j) {
            sum_left += static_cast<double>(left_stroke[j]);
            sum_right += static_cast<double>(right_stroke[j]);
        }
        EXPECT_NEAR(left[i], sum_left / 76.2, 1e-4 * left[i] + 1e-4);
        EXPECT_NEAR(mri[i], (sum_left + sum_right) / 2 / 76.2, 1e-4 * mri[i] + 1e-4);
    }
}

/// A bump of 20 mm over 2 m at 150 m on the left wheel path of a smooth plane.
TEST(IriProgram, ListsThePlacesThatAreTooRough) {
    std::string csv = "left_m,right_m\n";
    for (int i = 0; i < 6000; ++i) {
        const double x_m = 0.05 * i - 150;
        csv += fmt::format("{:.7f},0\n",
                           x_m > 0 && x_m < 2 ? 0.01 * (1 - std::cos(3.14159265 * x_m)) : 0.0);
    }
    const auto file = written("a.csv", csv);
    const auto places = expect_done({file, "--step", "0.05", "--continuous", "--threshold", "3"});
    EXPECT_THAT(places, StartsWith("channel,from_m,to_m,peak,peak_at_m\nmri,1"));
    EXPECT_THAT(places, ::testing::Not(HasSubstr("right")));
    EXPECT_THAT(places, HasSubstr("\nleft,1"));
    const auto peaks_at_m = column(places, "peak_at_m");
    ASSERT_EQ(peaks_at_m.size(), 2U);
    EXPECT_NEAR(peaks_at_m[0], 153, 2); // the car swings behind the bump
    EXPECT_NEAR(2 * column(places, "peak")[0], column(places, "peak")[1], 2e-4); // as printed
    // The same threshold in inches a mile.
    const auto in_per_mi = expect_done(
        {file, "--step", "0.05", "--continuous", "--threshold", "190.08", "--units", "in/mi"});
    EXPECT_EQ(column(in_per_mi, "from_m"), column(places, "from_m"));
    EXPECT_THAT(
        expect_done({file, "--step", "0.05", "--continuous", "--threshold", "500", "--json"}),
        HasSubstr("\"base_m\":7.620000,\"threshold\":500.000000,\"unit\":\"mm/m\","
                  "\"method\":\"sampled\",\"step_m\":0.050000,\"envelope_samples\":5,"
                  "\"places\":[]}"));
}

TEST(IriProgram, MovesAnyBaseOnUnevenStationsToo) {
    const auto csv = expect_done({uneven, "--continuous", "30"});
    const auto at_m = column(csv, "at_m");
    EXPECT_NEAR(at_m[0], 478 + 15, 1e-3);
    EXPECT_NEAR(at_m[1] - at_m[0], 1, 2e-3); // a thirtieth
    const auto moved = column(csv, "iri_profile");
    const auto pieces =
        column(expect_done({uneven, "--from-m", "478", "--length", "30"}), "iri_profile");
    EXPECT_NEAR(moved[0], pieces[0], 1e-3);
    EXPECT_NEAR(moved[30], pieces[1], 1e-3);
    EXPECT_NEAR(moved[60], pieces[2], 1e-3);
}

TEST(IriProgram, SaysHowItSolvedTheProfile) {
    EXPECT_THAT(expect_done({even, "--json"}),
                HasSubstr("\"unit\":\"mm/m\",\"method\":\"sampled\",\"step_m\":0.250000,"
                          "\"envelope_samples\":1}"));
    EXPECT_THAT(expect_done({uneven, "--json"}),
                HasSubstr("\"method\":\"exact\",\"step_m\":null,\"envelope_samples\":null}"));
    EXPECT_THAT(expect_done({even, "--continuous", "--json"}),
                StartsWith("{\"channels\":[\"profile\"],\"base_m\":7.620000,\"unit\":\"mm/m\","
                           "\"method\":\"sampled\",\"step_m\":0.250000,\"envelope_samples\":1,"
                           "\"points\":[{\"at_m\":"));
}

TEST(IriProgram, RefusesWhatIsAskedForWrongly) {
    const auto coarse = written("a.txt", "0 1\n0.5 1\n1 1\n");
    EXPECT_THAT(refused({coarse}).err,
                HasSubstr("a.txt: has a point every 0.5 m, expected 0 to 0.3"));
    EXPECT_EQ(refused({coarse}).exit_status, 1);
    EXPECT_THAT(refused({even, "--from-m", "2000"}).err,
                HasSubstr("contains no part of the profile, expected 478 to 1022 m"));
    EXPECT_THAT(refused({even, "--from-m", "100"}).err, HasSubstr("expected 478 to 1022 m"));
    EXPECT_THAT(refused({even, "--length", "600"}).err, HasSubstr("are shorter than --length 600"));
    EXPECT_THAT(refused({even, "--continuous", "600"}).err,
                HasSubstr("are shorter than the base, 600 m"));
    const auto misused = {std::vector<std::string>{even, "--threshold", "3"},
                          std::vector<std::string>{even, "--length", "0"},
                          std::vector<std::string>{even, "--length", "20", "--continuous"},
                          std::vector<std::string>{even, "--continuous", "x"},
                          std::vector<std::string>{even, "--continuous", "-1"},
                          std::vector<std::string>{even, "--step", "-1"}};
    for (const auto& words : misused) {
        EXPECT_EQ(refused(words).exit_status, 2) << words.back();
    }
}

} // namespace
} // namespace macadam::testing
