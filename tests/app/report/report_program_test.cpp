// `macadam report` and `query --worst` as users run them.

#include "support/files/sample_photo.hpp"
#include "support/program/program.hpp"
#include "support/roads/drive.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <sstream>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;

/// A store of a road of 1200 m whose third quarter is poor and the rest good, driven by two trips
/// of one car.
class ReportProgram : public ::testing::Test {
protected:
    void SetUp() override {
        folder_ = fresh_folder();
        store_ = (folder_ / "roads.gpkg").string();
        // Waves of a poor road, and a quarter of them outside the third quarter.
        const auto road = patched_road([](double x_m) { return x_m < 600 || x_m >= 900; }, 0.25);
        std::vector<std::string> trips;
        for (const double speed_mps : {15.0, 22.0}) {
            const Drive drive{.length_m = 1200,
                              .speed_mps = speed_mps,
                              .trip_id = fmt::format("at-{}", speed_mps)};
            trips.push_back((folder_ / (drive.trip_id + ".trip.csv")).string());
            write_file(trips.back(),
                       text_of(drive_over(road, drive, *built_in_vehicle("golden-car")), drive));
        }
        ASSERT_EQ(run_macadam({"init", store_, "--trace", trips[0]}).exit_status, 0);
        empty_ = (folder_ / "empty.gpkg").string();
        fs::copy(store_, empty_);
        ASSERT_EQ(run_macadam({"import", store_, trips[0], trips[1], "--method", "kf"}).exit_status,
                  0);
    }

    std::string out(const std::string& name) const { return (folder_ / name).string(); }

    std::string report(const std::string& store, const std::string& name) const {
        const auto run = run_macadam({"report", store, "-o", out(name), "--title", "A <road>"});
        EXPECT_EQ(run.exit_status, 0) << run.err;
        return read_file(out(name));
    }

    /// Returns the midpoint of the worst section.
    GeoPoint worst_place() const {
        const auto run = run_macadam({"query", store_, "--worst", "1", "--format", "json"});
        EXPECT_EQ(run.exit_status, 0) << run.err;
        const auto worst = nlohmann::json::parse(run.out).at(0);
        return {worst.at("lat_deg").get<double>(), worst.at("lon_deg").get<double>()};
    }

    /// Returns the position of the beginning of a measured segment, "LAT,LON".
    std::string place_on_road(std::size_t segment) const {
        const auto run = run_macadam({"export", store_, "-o", out("all.geojson")});
        EXPECT_EQ(run.exit_status, 0) << run.err;
        const auto all = nlohmann::json::parse(read_file(out("all.geojson")));
        const auto at = all.at("features").at(segment).at("geometry").at("coordinates").at(0);
        return fmt::format("{},{}", at.at(1).get<double>(), at.at(0).get<double>());
    }

    fs::path folder_;
    std::string store_;
    std::string empty_; ///< the same roads, no trip
};

std::vector<std::string> cells_of(const std::string& row) {
    std::vector<std::string> cells;
    std::istringstream text{row};
    for (std::string cell; std::getline(text, cell, ',');) {
        cells.push_back(cell);
    }
    return cells;
}

/// Rows of a CSV without commas in its text, the header first.
std::vector<std::vector<std::string>> rows_of(const std::string& csv) {
    std::vector<std::vector<std::string>> rows;
    std::istringstream lines{csv};
    for (std::string line; std::getline(lines, line);) {
        rows.push_back(cells_of(line));
    }
    return rows;
}

double number(const std::vector<std::vector<std::string>>& rows,
              std::size_t row,
              const std::string& column) {
    const auto at = std::ranges::find(rows[0], column) - rows[0].begin();
    return std::stod(rows[row][static_cast<std::size_t>(at)]);
}

TEST_F(ReportProgram, SaysTheMeanOfTheExportedSegments) {
    const auto html = report(store_, "report.html");
    ASSERT_EQ(run_macadam({"export", store_, "-o", out("all.csv")}).exit_status, 0);
    const auto rows = rows_of(read_file(out("all.csv")));
    double length_m = 0, sum = 0, poor_m = 0;
    for (std::size_t i = 1; i < rows.size(); ++i) {
        const double metres = number(rows, i, "to_m") - number(rows, i, "from_m");
        length_m += metres;
        sum += metres * number(rows, i, "iri");
        poor_m += number(rows, i, "iri") > 170 / 63.36 ? metres : 0;
    }
    EXPECT_THAT(html,
                HasSubstr(fmt::format("<b>{:.2f}\u00A0<span class=\"nw\">mm/m</span></b>",
                                      sum / length_m)));
    EXPECT_THAT(html, HasSubstr(fmt::format("<b>{:.2f}\u00A0km</b>", length_m / 1000)));
    EXPECT_THAT(html, HasSubstr(fmt::format("<b>{:.1f}\u00A0%</b>", 100 * poor_m / length_m)));
    EXPECT_THAT(html, HasSubstr("<h1>A &lt;road&gt;</h1>"));
    EXPECT_THAT(html, HasSubstr("<b>1 car</b>"));
}

TEST_F(ReportProgram, GivesTheSameBytesForTheSameStore) {
    EXPECT_EQ(report(store_, "a.html"), report(store_, "b.html"));
}

TEST_F(ReportProgram, WritesAPdfWithTheSameBytesForTheSameStore) {
    const auto once = report(store_, "a.pdf");
    EXPECT_THAT(once.substr(0, 5), "%PDF-");
    EXPECT_TRUE(once == report(store_, "b.pdf")); // too long to print
}

TEST_F(ReportProgram, ShowsPhotosAtTheWorstSectionsAndTellsOfTheOthers) {
    const auto photos = folder_ / "photos";
    fs::create_directories(photos / "subfolder");
    const auto [lat_deg, lon_deg] = worst_place();
    constexpr double deg_per_m = 1 / 111'200.0;
    for (const double north_m : {2, 4, 8, 16, 500}) {
        write_photo_at(photos / fmt::format("{:03.0f}-m.jpg", north_m),
                       {lat_deg + north_m * deg_per_m, lon_deg});
    }
    write_file(photos / "my\nnotes.txt", "no photo");
    const auto shown_in = [&](const std::string& name) {
        const auto run =
            run_macadam({"report", store_, "-o", out(name), "--photos", photos.string()});
        EXPECT_EQ(run.exit_status, 0) << run.err;
        EXPECT_THAT(run.err, HasSubstr("my\\x0anotes.txt: is not a JPEG"));
        EXPECT_THAT(run.err,
                    HasSubstr("photos: 3 of 6 shown, 1 farther than 30 m from all roads listed, 1 "
                              "beyond the nearest 3 of a section or strip, 1 skipped"));
        EXPECT_THAT(run.err, HasSubstr("photos may show people and number plates"));
        return read_file(out(name));
    };
    const auto html = shown_in("photos.html");
    std::size_t shown = 0;
    for (auto at = html.find("data:image/jpeg;"); at != std::string::npos;
         at = html.find("data:image/jpeg;", at + 1)) {
        ++shown;
    }
    EXPECT_EQ(shown, 3U);
    EXPECT_THAT(html, HasSubstr("Photo of 2026-03-12, 2\u00A0m from the road"));
    EXPECT_THAT(html, Not(HasSubstr("500-m")));
    EXPECT_THAT(shown_in("photos.pdf").substr(0, 5), "%PDF-");
}

TEST_F(ReportProgram, ShowsPhotosByChainageOnAStripChart) {
    const auto photos = folder_ / "photos";
    fs::create_directories(photos);
    const auto place = place_on_road(5); // of a good road, so of no worst section
    const auto comma = place.find(',');
    write_photo_at(photos / "here.jpg",
                   {std::stod(place.substr(0, comma)), std::stod(place.substr(comma + 1))});
    const auto run = run_macadam(
        {"report", store_, "-o", out("way.html"), "--way", "1", "--photos", photos.string()});
    ASSERT_EQ(run.exit_status, 0) << run.err;
    EXPECT_THAT(run.err, HasSubstr("photos: 1 of 1 shown\n"));
    EXPECT_THAT(
        read_file(out("way.html")),
        ::testing::ContainsRegex("At [0-9]+\u00A0m: Photo of 2026-03-12, 0\u00A0m from the road"));
}

TEST_F(ReportProgram, RefusesPhotosThatAreNoFolderBeforeItReadsAnything) {
    const auto run =
        run_macadam({"report", store_, "-o", out("a.html"), "--photos", out("nowhere")});
    EXPECT_EQ(run.exit_status, 1);
    EXPECT_THAT(run.err, HasSubstr("nowhere: is no folder, expected a folder of photos"));
}

TEST_F(ReportProgram, SaysWhatCannotBeCompared) {
    const auto run =
        run_macadam({"report", store_, "-o", out("s.html"), "--compare-since", "2026-03"});
    ASSERT_EQ(run.exit_status, 0) << run.err;
    EXPECT_THAT(read_file(out("s.html")),
                HasSubstr("No segment has dated passes both before and since 2026-03-01"));
}

TEST_F(ReportProgram, SpeaksTheLanguageAndUnitThatItIsAskedFor) {
    const auto run = run_macadam(
        {"report", store_, "-o", out("de.html"), "--language", "de", "--unit", "in/mi"});
    ASSERT_EQ(run.exit_status, 0) << run.err;
    const auto html = read_file(out("de.html"));
    EXPECT_THAT(html, HasSubstr("<h1>Straßenebenheit</h1>"));
    EXPECT_THAT(html, HasSubstr("in/mi"));
    EXPECT_THAT(html, Not(HasSubstr("mm/m")));
}

TEST_F(ReportProgram, OfAStoreWithoutTripsSaysThatNothingWasMeasured) {
    EXPECT_THAT(report(empty_, "empty.html"), HasSubstr("No measurements yet."));
}

TEST_F(ReportProgram, OfARouteNeverDrivenSaysThatNothingWasMeasuredAlongIt) {
    const auto run = run_macadam(
        {"report", empty_, "-o", out("way.html"), "--route", place_on_road(0), place_on_road(9)});
    ASSERT_EQ(run.exit_status, 0) << run.err;
    EXPECT_THAT(read_file(out("way.html")), HasSubstr("No measurement along this road."));
}

TEST_F(ReportProgram, SaysThatAWayIsNotOnTheNetworkOrNotMeasured) {
    const auto refusal_of = [&](const std::string& way) {
        return run_macadam({"render", empty_, "-o", out("a.png"), "--way", way}).err;
    };
    EXPECT_THAT(refusal_of("42"), HasSubstr("the network has no way '42'"));
    EXPECT_THAT(refusal_of("1"), HasSubstr("the selection contains no measured segment"));
}

TEST_F(ReportProgram, RefusesARouteBetweenTwoPointsAtOnePlace) {
    const auto place = place_on_road(0);
    const auto run =
        run_macadam({"report", store_, "-o", out("here.html"), "--route", place, place});
    EXPECT_EQ(run.exit_status, 1);
    EXPECT_THAT(run.err,
                HasSubstr("the route has no length, expected two points at different places of a "
                          "road"));
    EXPECT_FALSE(fs::exists(out("here.html")));
}

TEST_F(ReportProgram, RefusesToReplaceTheStoreThatItReads) {
    const auto link = out("link.html");
    fs::create_symlink(store_, link);
    const auto before = read_file(store_);
    const auto run = run_macadam({"report", store_, "-o", link});
    EXPECT_EQ(run.exit_status, 1);
    EXPECT_THAT(run.err, HasSubstr("is also an input, expected another file to write to"));
    EXPECT_EQ(read_file(store_), before);
}

TEST_F(ReportProgram, LeavesNoHalfReportOnAFullDisk) {
    const auto run = run_macadam({"report", store_, "-o", out("full.html")}, 20000);
    EXPECT_EQ(run.exit_status, 1);
    EXPECT_THAT(run.err, HasSubstr("full.html"));
    for (const auto& entry : fs::directory_iterator{folder_}) {
        EXPECT_THAT(entry.path().filename().string(), Not(HasSubstr("full")));
    }
}

TEST_F(ReportProgram, IsMisusedByAnotherNameANumberOrAClassTableThatIsNone) {
    for (const auto& [words, says] : std::vector<std::pair<std::vector<std::string>, std::string>>{
             {{}, "-o report.html is missing"},
             {{"-o", "a.doc"}, "-o is 'a.doc', expected a name that ends in .html or .pdf"},
             {{"-o", "a.html", "--paper", "A4"}, "--paper requires -o FILE.pdf"},
             {{"-o", "a.pdf", "--paper", "A3"}, "--paper is 'A3', expected A4 or letter"},
             {{"-o", "a.pdf", "--unit", "m/km"},
              "--units is 'm/km', expected si or us or mm/m or in/mi"},
             {{"-o", "a.pdf", "--language", "xx"},
              "--language is 'xx', expected en, de, hu or the path of a .po file"},
             {{"-o", "a.pdf", "--compare-since", "spring"},
              "--compare-since is 'spring', expected a time such as"},
             {{"-o", "a.html", "--compare-since", "2026-03", "--class", "poor"},
              "--compare-since and --class cannot be combined"},
             {{"-o", "a.html", "--worst", "-1"}, "--worst is -1, expected 0 to 200"},
             {{"-o", "a.html", "--classes", "six"}, "--classes is 'six', expected fhwa or five"}}) {
        std::vector<std::string> call{"report", store_};
        call.insert(call.end(), words.begin(), words.end());
        const auto run = run_macadam(call);
        EXPECT_EQ(run.exit_status, 2);
        EXPECT_THAT(run.err, HasSubstr(says));
    }
}

TEST_F(ReportProgram, FindsTheRoughQuarterAsOneStretchInEveryFormat) {
    const auto query = [&](const std::string& format) {
        const auto run = run_macadam({"query", store_, "--worst", "3", "--format", format});
        EXPECT_EQ(run.exit_status, 0) << run.err;
        return run.out;
    };
    const auto rows = rows_of(query("csv"));
    ASSERT_EQ(rows.size(), 2U);
    EXPECT_EQ(number(rows, 1, "rank"), 1);
    EXPECT_NEAR(number(rows, 1, "from_m"), 600, 40); // of 20 m segments, along a traced road
    EXPECT_NEAR(number(rows, 1, "to_m"), 900, 40);
    EXPECT_EQ(number(rows, 1, "passes_median"), 2);

    EXPECT_THAT(query("json"), StartsWith("[{\"rank\":1,"));
    EXPECT_THAT(query("table"), StartsWith("rank"));
    const auto geojson = query("geojson");
    EXPECT_THAT(geojson, HasSubstr("\"type\":\"LineString\""));
    EXPECT_EQ(geojson.find("\"Feature\""), geojson.rfind("\"Feature\""));
}

TEST_F(ReportProgram, MeasuresTheStretchAsItsSegmentsDo) {
    const auto stretch =
        rows_of(run_macadam({"query", store_, "--worst", "1", "--format", "csv"}).out);
    ASSERT_EQ(stretch.size(), 2U);
    const auto segments =
        rows_of(run_macadam({"query", store_, "--way", "1", "--format", "csv"}).out);
    double length_m = 0, sum = 0, worst = 0;
    for (std::size_t i = 1; i < segments.size(); ++i) {
        if (number(segments, i, "from_m") >= number(stretch, 1, "from_m") - 0.01 &&
            number(segments, i, "to_m") <= number(stretch, 1, "to_m") + 0.01) {
            const double metres = number(segments, i, "to_m") - number(segments, i, "from_m");
            length_m += metres;
            sum += metres * number(segments, i, "iri");
            worst = std::max(worst, number(segments, i, "iri"));
        }
    }
    EXPECT_NEAR(number(stretch, 1, "length_m"), length_m, 0.1); // ends are written to a centimetre
    EXPECT_NEAR(number(stretch, 1, "iri"), sum / length_m, 0.002);
    EXPECT_EQ(number(stretch, 1, "iri_worst"), worst);
}

TEST_F(ReportProgram, LetsOtherConditionsLeaveSegmentsFirst) {
    const auto run = run_macadam(
        {"query", store_, "--worst", "3", "--bbox", "10,10,11,11", "--format", "geojson"});
    EXPECT_EQ(run.out, "{\"type\":\"FeatureCollection\",\"features\":[]}\n");
    EXPECT_THAT(run.err, HasSubstr("no section of 100 m or more has a mean IRI above 2.68 mm/m"));
}

TEST_F(ReportProgram, TakesAnotherBorderOfPoorAndAnotherLeastLength) {
    const auto above = run_macadam({"query", store_, "--worst", "3", "--above", "90"});
    EXPECT_THAT(above.out, IsEmpty());
    EXPECT_THAT(above.err, HasSubstr("above 90.00 mm/m"));
    const auto whole = rows_of(
        run_macadam({"query", store_, "--worst", "9", "--above", "0", "--format", "csv"}).out);
    ASSERT_EQ(whole.size(), 2U);
    EXPECT_GT(number(whole, 1, "length_m"), 1000); // all of the road is rougher than nothing
}

TEST_F(ReportProgram, ListsSectionsOfYourOwnRoads) {
    const auto table = out("sections.csv");
    write_file(table, "section,way_id,from_m,to_m\nA & B,1,0,500\nback,1,500,0\n");
    const auto run = run_macadam({"report", store_, "-o", out("s.html"), "--sections", table});
    ASSERT_EQ(run.exit_status, 0) << run.err;
    const auto html = read_file(out("s.html"));
    EXPECT_THAT(html, HasSubstr("<h2>Sections</h2>"));
    EXPECT_THAT(html, HasSubstr("A &amp; B"));
    const auto rows =
        rows_of(run_macadam({"query", store_, "--sections", table, "--format", "csv"}).out);
    EXPECT_THAT(html, HasSubstr(fmt::format(">{:.2f}</td>", number(rows, 1, "iri"))));
    EXPECT_THAT(report(store_, "plain.html"), Not(HasSubstr("<h2>Sections</h2>")));
}

TEST_F(ReportProgram, MisusesNothingOfWorstWithoutIt) {
    for (const auto& [words, says] : std::vector<std::pair<std::vector<std::string>, std::string>>{
             {{"--way", "1", "--min-length", "50"}, "--min-length requires --worst N"},
             {{"--way", "1", "--segments"}, "--segments requires --worst N"},
             {{"--worst", "0"}, "--worst is 0, expected at least 1"},
             {{"--worst", "1", "--above", "-1"}, "--above is -1, expected an IRI of 0 to 100 mm/m"},
             {{"--worst", "1", "--min-length", "-5"},
              "--min-length is -5, expected 0 m or more"}}) {
        std::vector<std::string> call{"query", store_};
        call.insert(call.end(), words.begin(), words.end());
        const auto run = run_macadam(call);
        EXPECT_EQ(run.exit_status, 2);
        EXPECT_THAT(run.err, HasSubstr(says));
    }
}

} // namespace
} // namespace macadam::testing
