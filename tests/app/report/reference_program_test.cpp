// Reference surveys and control sections, by the program itself: a simulated fleet whose truth is
// the survey.

#include "support/program/program.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <sstream>
#include <string>
#include <unistd.h>
#include <vector>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::AllOf;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Not;

/// A block of a town of about 400 m.
const std::string town = R"(<osm version="0.6">
<node id="1" lat="48.4000000" lon="15.6000000"/>
<node id="2" lat="48.4000000" lon="15.6054000"/>
<node id="4" lat="48.4036000" lon="15.6000000"/>
<node id="5" lat="48.4036000" lon="15.6054000"/>
<way id="11"><nd ref="1"/><nd ref="2"/><tag k="highway" v="primary"/><tag k="name" v="Ring"/></way>
<way id="12"><nd ref="4"/><nd ref="5"/><tag k="highway" v="primary"/></way>
<way id="13"><nd ref="1"/><nd ref="4"/><tag k="highway" v="residential"/></way>
<way id="14"><nd ref="2"/><nd ref="5"/><tag k="highway" v="residential"/></way>
</osm>
)";

const std::string recipe = R"([trips]
count = 4
length_km = [1.4, 1.6]
stop_share = 0
[[car]]
id = "one"
[[car]]
id = "two"
)";

testing::Run ran(const std::vector<std::string>& words) {
    auto run = run_macadam(words);
    EXPECT_EQ(run.exit_status, 0) << run.err;
    return run;
}

/// A store with the trips of a fleet, made once.
class Reference : public ::testing::Test {
protected:
    static void SetUpTestSuite() {
        // Tests may run at once, each as a process of its own.
        fleet_ = fs::path{::testing::TempDir()} / fmt::format("macadam_reference_{}", ::getpid());
        fs::remove_all(fleet_);
        fs::create_directories(fleet_);
        write_file(fleet_ / "town.osm", town);
        write_file(fleet_ / "recipe.toml", recipe);
        const auto made = (fleet_ / "fleet").string();
        ran({"simulate",
             "-o",
             made,
             "--network",
             (fleet_ / "town.osm").string(),
             "--recipe",
             (fleet_ / "recipe.toml").string()});
        ran({"init", made + "/roads.gpkg", "--network", made + "/network.osm.pbf"});
        ran({"import", made + "/roads.gpkg", made + "/trips", "--method", "kf"});
    }

    static void TearDownTestSuite() { fs::remove_all(fleet_); }

    void SetUp() override {
        folder_ = fresh_folder();
        store_ = (folder_ / "roads.gpkg").string();
        fs::copy(fleet_ / "fleet" / "roads.gpkg", store_);
        truth_ = (fleet_ / "fleet" / "truth.csv").string();
    }

    std::string written(const std::string& name, const std::string& text) const {
        write_file(folder_ / name, text);
        return (folder_ / name).string();
    }

    json info() const { return json::parse(ran({"info", store_, "--json"}).out); }

    /// The refusal of an import, which leaves the store as it was.
    std::string refusal_of(std::vector<std::string> words, int exit_status = 1) const {
        const auto before = ran({"info", store_, "--digest"}).out;
        words.insert(words.begin(), {"import", store_});
        const auto run = run_macadam(words);
        EXPECT_EQ(run.exit_status, exit_status) << run.out;
        EXPECT_EQ(ran({"info", store_, "--digest"}).out, before);
        return run.err;
    }

    static fs::path fleet_;
    fs::path folder_;
    std::string store_;
    std::string truth_;
};

fs::path Reference::fleet_;

TEST_F(Reference, ToldTheTruthTheComparisonSaysWhatTheTruthSays) {
    const auto of_truth =
        json::parse(ran({"info", store_, "--json", "--truth", truth_}).out)["truth"]["all"];
    const auto imported = json::parse(
        ran({"import", store_, "--reference", truth_, "--date", "2026-05-01", "--json"}).out);
    EXPECT_EQ(imported["result"], "imported");
    EXPECT_EQ(imported["rows_used"], imported["rows_read"]);
    EXPECT_EQ(imported["vehicle"], nullptr);

    const auto out = (folder_ / "reference.json").string();
    ran({"report", store_, "--against-reference", "-o", out});
    const auto report = json::parse(read_file(out));
    const auto& segments = report["segments"]["iri"]["all"];
    EXPECT_EQ(segments["pieces"], of_truth["segments"]);
    for (const auto& [ours, theirs] : {std::pair{"bias", "bias"},
                                       std::pair{"rmse", "rmse_20m"},
                                       std::pair{"correlation", "correlation"},
                                       std::pair{"coverage_90", "coverage_90"}}) {
        // The truth file has micrometres, and so do passes; an interval's end is rounded.
        EXPECT_NEAR(segments[ours].get<double>(), of_truth[theirs].get<double>(), 2e-4) << ours;
    }
    EXPECT_EQ(report["hundred_metres"]["iri"]["all"]["pieces"], of_truth["runs_100m"]);
    EXPECT_NEAR(report["hundred_metres"]["iri"]["all"]["rmse"].get<double>(),
                of_truth["rmse_100m"].get<double>(),
                2e-3); // here by length: segments differ by some centimetres
    EXPECT_EQ(report["references_span"], "2026-05-01");
}

TEST_F(Reference, BringsTheMapToTheTruthAndShowsTheSurveyApart) {
    const auto before = info();
    ran({"import", store_, "--reference", truth_, "--survey-name", "laser", "--accuracy", "1"});
    const auto after = info();
    for (const auto* const key : {"trips", "passes", "vehicles", "cars", "passes_per_day"}) {
        EXPECT_EQ(after[key], before[key]) << key;
    }
    ASSERT_EQ(after["surveys"].size(), 1U);
    EXPECT_EQ(after["surveys"][0]["name"], "laser");
    EXPECT_EQ(after["surveys"][0]["accuracy"], 0.01);
    EXPECT_EQ(after["surveys"][0]["date"], nullptr);
    EXPECT_THAT(ran({"info", store_}).out, HasSubstr("reference survey"));

    const auto truth =
        json::parse(ran({"info", store_, "--json", "--truth", truth_}).out)["truth"]["all"];
    EXPECT_LT(truth["rmse_20m"].get<double>(), 0.05);
    const auto passes =
        json::parse(ran({"query", store_, "--segment", "11+0000", "--passes", "--json"}).out);
    const auto survey =
        std::ranges::find_if(passes, [](const json& pass) { return pass["reference"] == "laser"; });
    ASSERT_NE(survey, passes.end());
    EXPECT_EQ((*survey)["vehicle"], nullptr);
}

TEST_F(Reference, IsKnownTheSecondTime) {
    ran({"import", store_, "--reference", truth_});
    const auto digest = ran({"info", store_, "--digest"}).out;
    const auto again = ran({"import", store_, "--reference", truth_, "--accuracy", "9"});
    EXPECT_THAT(again.out, HasSubstr("already imported"));
    EXPECT_THAT(again.out, HasSubstr("was imported before and stays unchanged"));
    EXPECT_EQ(ran({"info", store_, "--digest"}).out, digest);
}

TEST_F(Reference, ReportsForPeopleWithPictures) {
    ran({"import", store_, "--reference", truth_, "--date", "2026-05-01"});
    const auto table = ran({"report", store_, "--against-reference"}).out;
    EXPECT_THAT(table, HasSubstr("100 m, mm/m"));
    const auto page = (folder_ / "reference.html").string();
    ran({"report", store_, "--against-reference", "-o", page, "--title", "A <survey>"});
    const auto html = read_file(page);
    EXPECT_THAT(html, HasSubstr("A &lt;survey&gt;"));
    EXPECT_THAT(html, HasSubstr("aria-label=\"IRI of the cars against IRI of the reference"));
    EXPECT_THAT(html, HasSubstr("aria-label=\"Histograms of the difference between the cars"));
    EXPECT_EQ(html.find("<script"), html.rfind("<script")); // no more than the page's own
    EXPECT_THAT(html, Not(HasSubstr("nan")));

    const auto csv = (folder_ / "reference.csv").string();
    ran({"report", store_, "--against-reference", "-o", csv});
    EXPECT_THAT(read_file(csv), HasSubstr("\nsegment,truth,11+0005,11+0005,"));
    EXPECT_THAT(read_file(csv), HasSubstr("\n100m,truth,11"));
    EXPECT_EQ(ran({"report", store_, "--against-reference", "--format", "csv"}).out,
              read_file(csv));
}

TEST_F(Reference, ReportsInTheLanguageAndUnitThatItIsAskedFor) {
    ran({"import", store_, "--reference", truth_, "--date", "2026-05-01"});
    const auto page = (folder_ / "reference.html").string();
    ran({"report", store_, "--against-reference", "-o", page});
    EXPECT_THAT(read_file(page), HasSubstr("<h1>Cars compared with reference surveys</h1>"));
    EXPECT_THAT(read_file(page), Not(HasSubstr("in/mi")));
    ran({"report",
         store_,
         "--against-reference",
         "-o",
         page,
         "--language",
         "de",
         "--unit",
         "in/mi"});
    const auto html = read_file(page);
    EXPECT_THAT(html, HasSubstr("<html lang=\"de\">"));
    for (const auto* words : {"<h1>Fahrzeuge und Referenzmessungen</h1>",
                              "Fahrzeuge neben Referenzen",
                              "Stücke von 328 ft",
                              "01.05.2026",
                              "Referenz, in/mi",
                              "63\u00A0– 127",
                              "IRI der Fahrzeuge, in/mi",
                              "Im 90-%-Intervall"}) {
        EXPECT_THAT(html, HasSubstr(words));
    }
    for (const auto* words : {"mm/m", "Reference", "Cars", "cars", "pieces", " to "}) {
        const auto body = html.substr(html.find("<body"));
        EXPECT_THAT(body, Not(HasSubstr(words)));
    }
    const auto pdf = (folder_ / "reference.pdf").string();
    ran({"report", store_, "--against-reference", "-o", pdf, "--language", "de"});
    EXPECT_THAT(read_file(pdf).substr(0, 5), "%PDF-");
}

TEST_F(Reference, GivesRowsInUsUnits) {
    ran({"import", store_, "--reference", truth_, "--date", "2026-05-01"});
    const std::vector<std::string> report{"report", store_, "--against-reference"};
    const auto rows = [&](std::vector<std::string> words) {
        words.insert(words.begin(), report.begin(), report.end());
        return ran(words).out;
    };
    const auto si = json::parse(rows({"--json"}));
    const auto us = json::parse(rows({"--json", "--units", "us"}));
    EXPECT_NEAR(us.at("segment_length_ft"), double(si.at("segment_length_m")) / 0.3048, 0.01);
    const auto score = [](const json& of) { return of.at("segments").at("iri").at("all"); };
    EXPECT_NEAR(score(us).at("bias_in_per_mi"), 63.36 * double(score(si).at("bias")), 0.01);
    EXPECT_FALSE(score(us).contains("bias"));
    EXPECT_THAT(rows({"--format", "csv", "--units", "us"}),
                AllOf(HasSubstr(",length_ft,"), HasSubstr(",reference_in_per_mi,")));
    EXPECT_THAT(rows({"--units", "us"}),
                AllOf(HasSubstr("328 ft, in/mi"), Not(HasSubstr("mm/m")), Not(HasSubstr(" km"))));
}

TEST_F(Reference, WatchesControlSections) {
    // The known roughness of ten segments is their truth; "off" claims 1 mm/m more.
    std::istringstream rows{read_file(truth_)};
    double sum = 0, whole_m = 0;
    std::string from_m, to_m;
    for (std::string row; std::getline(rows, row);) {
        if (row >= "11+0005" && row < "11+0015") {
            std::vector<std::string> cells;
            std::istringstream text{row};
            for (std::string cell; std::getline(text, cell, ',');) {
                cells.push_back(cell);
            }
            from_m = from_m.empty() ? cells[3] : from_m;
            to_m = cells[4];
            const double length_m = std::stod(cells[4]) - std::stod(cells[3]);
            sum += length_m * std::stod(cells[7]);
            whole_m += length_m;
        }
    }
    const double known = sum / whole_m;
    const auto file = written("control.csv",
                              fmt::format("name,way_id,direction,from_m,to_m,iri,iri_sd,date\n"
                                          "ring,11,forward,{0},{1},{2:.3f},0.02,2026-05-01\n"
                                          "off,11,forward,{0},{1},{3:.3f},0.02,\n",
                                          from_m,
                                          to_m,
                                          known,
                                          known + 1));
    const auto digest = ran({"info", store_, "--digest"}).out;
    ran({"import", store_, "--control", file});
    EXPECT_EQ(ran({"info", store_, "--digest"}).out, digest);

    const auto sections = info()["control_sections"];
    ASSERT_EQ(sections.size(), 2U);
    EXPECT_EQ(sections[1]["name"], "ring");
    EXPECT_EQ(sections[1]["date"], "2026-05-01");
    EXPECT_NEAR(sections[1]["measured_m"].get<double>(), whole_m, 0.02);
    EXPECT_NEAR(
        sections[1]["difference"].get<double>() - sections[0]["difference"].get<double>(), 1, 2e-3);
    EXPECT_FALSE(sections[1]["months"].empty());
    EXPECT_THAT(ran({"info", store_}).out, HasSubstr("control section"));
    EXPECT_THAT(ran({"report", store_, "--against-reference"}).out, HasSubstr("'ring': known"));
}

TEST_F(Reference, RefusesWithWords) {
    EXPECT_THAT(refusal_of({"--reference", written("a.csv", "way_id,mri\n1,2\n")}),
                HasSubstr("a.csv:1: the header does not locate its rows"));
    EXPECT_THAT(
        refusal_of({"--reference", written("b.csv", "way_id,from_m,to_m,mri\n99,0,20,2\n")}),
        EndsWith("b.csv: none of its 1 row can be used: 1 no_such_way\n"));
    EXPECT_THAT(refusal_of({}, 2), HasSubstr("PATH is missing"));
    EXPECT_THAT(refusal_of({"--accuracy", "3", truth_}, 2),
                HasSubstr("--accuracy requires --reference FILE.csv"));
    EXPECT_THAT(refusal_of({"--reference", truth_, "--accuracy", "99"}, 2),
                HasSubstr("--accuracy is 99, expected 0.1 to 50 percent"));
    EXPECT_THAT(refusal_of({"--reference", truth_, "--date", "May"}, 2),
                HasSubstr("--date is 'May', expected a day such as 2026-03-01"));
    const auto report = run_macadam({"report", store_, "--against-reference"});
    EXPECT_EQ(report.exit_status, 1);
    EXPECT_THAT(report.err, HasSubstr("contains no reference survey and no control section"));
    const auto picture = run_macadam({"report", store_, "--against-reference", "-o", "a.png"});
    EXPECT_EQ(picture.exit_status, 2);
    EXPECT_THAT(picture.err,
                HasSubstr("expected a name that ends in .html, .pdf, .csv, .json, or "
                          "--format"));
    const auto page =
        run_macadam({"report", store_, "--against-reference", "-o", "a.html", "--json"});
    EXPECT_EQ(page.exit_status, 2);
    EXPECT_THAT(page.err,
                HasSubstr("-o a.html is a page, which --format and --json do not concern"));
    const auto whole = run_macadam({"report", store_, "-o", "a.html", "--format", "csv"});
    EXPECT_EQ(whole.exit_status, 2);
    EXPECT_THAT(whole.err, HasSubstr("--format csv requires --against-reference"));
}

} // namespace
} // namespace macadam::testing
