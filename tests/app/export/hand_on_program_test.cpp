// What `query`, `export`, `render` and `report` hand on to other programs: standard output, CSV for
// Excel, workbooks, and units of the United States.

#include "support/files/xlsx_reader.hpp"
#include "support/program/places.hpp"
#include "support/program/road_program.hpp"
#include "support/program/shell.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <regex>
#include <sstream>

namespace macadam::testing {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ContainsRegex;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsSupersetOf;
using ::testing::Not;
using ::testing::StartsWith;
using Json = nlohmann::json;

/// Text of a page: without its style, tags and their attributes other than descriptions.
std::string text_of_html(const std::string& html) {
    std::string text;
    for (std::size_t at = 0; at < html.size();) {
        if (html[at] != '<') {
            text += html[at++];
            continue;
        }
        if (html.compare(at, 6, "<style") == 0) {
            at = html.find("</style>", at);
        }
        const auto end = html.find('>', at);
        const auto tag = html.substr(at, end - at);
        for (const auto* attribute : {" alt=\"", " aria-label=\"", " title=\""}) {
            if (const auto found = tag.find(attribute); found != std::string::npos) {
                const auto begin = tag.find('"', found) + 1;
                text += " " + tag.substr(begin, tag.find('"', begin) - begin);
            }
        }
        text += ' ';
        at = end + 1;
    }
    return text;
}

/// What no report for an American agency has.
const std::regex metric{
    R"((^|[^A-Za-z/])(mm/m|m/km|km/h|km|mm|cm|m|metres?|kilometres?)($|[^A-Za-z0-9]))"};

std::string metric_units_in(const std::string& text) {
    std::string found;
    for (std::sregex_iterator hit{text.begin(), text.end(), metric}, end; hit != end; ++hit) {
        const auto at = static_cast<std::size_t>(hit->position());
        found += "..." + text.substr(at > 30 ? at - 30 : 0, 60) + "\n";
    }
    return found;
}

class HandingOn : public RoadProgram {};

TEST_F(HandingOn, ToStandardOutputGivesTheBytesOfAFile) {
    for (const auto* format : {"geojson", "geojsonl", "csv", "kml"}) {
        const auto file = file_of("export", fmt::format("a.{}", format));
        EXPECT_TRUE(done("export", {"-o", "-", "--format", format}) == read_file(file)) << format;
    }
    const auto events = file_of("export", "events.csv", {"--events"});
    EXPECT_EQ(done("export", {"-o", "-", "--format", "csv", "--events"}), read_file(events));
    for (const auto* format : {"png", "pdf"}) {
        const std::vector<std::string> size{format == std::string{"png"} ? "--size=400x300"
                                                                         : "--paper=A5"};
        const auto file = file_of("render", fmt::format("a.{}", format), size);
        EXPECT_TRUE(done("render", {"-o", "-", "--format", format, size[0]}) == read_file(file));
    }
    const auto page = file_of("report", "a.html", {"--worst", "0"});
    EXPECT_TRUE(done("report", {"-o", "-", "--worst", "0"}) == read_file(page));
    EXPECT_EQ(done("query", {"--way", "1", "--json", "-o", "-"}),
              done("query", {"--way", "1", "--json"}));
}

TEST_F(HandingOn, ToStandardOutputIsRefusedWhereAFormatNeedsAFile) {
    EXPECT_THAT(
        refusal("export", {"-o", "-", "--format", "gpkg"}),
        HasSubstr("-o - cannot write .gpkg, which needs a file; expected --format geojson"));
    EXPECT_THAT(refusal("render", {"-o", "-", "--format", "tif"}),
                HasSubstr("-o - cannot write a .tif or a world file"));
    EXPECT_THAT(
        refusal("export", {"-o", "a.csv", "--format", "csv"}),
        HasSubstr("--format is for -o - and for 'site'; the name of a file tells its format"));
    EXPECT_THAT(refusal("report", {"-o", "a.html", "--format", "html"}),
                HasSubstr("--format html is for -o -"));
    EXPECT_THAT(refusal("report", {"-o", "-", "--format", "csv"}),
                HasSubstr("--format csv requires --against-reference"));
}

TEST_F(HandingOn, ToExcelInGermanHasSemicolonsAndCommas) {
    const auto english = read_file(file_of("export", "a.csv"));
    const auto german = read_file(file_of("export", "de.csv", {"--excel", "de"}));
    EXPECT_THAT(german, StartsWith("\xEF\xBB\xBFsegment;way_id;name;"));
    EXPECT_EQ(std::ranges::count(german, '\n'), std::ranges::count(english, '\n'));
    EXPECT_THAT(german, Not(HasSubstr("19.99")));
    EXPECT_THAT(german, HasSubstr(";19,99;"));
    EXPECT_EQ(done("query", {"--way", "1", "--format", "csv", "--excel", "de"}), german);
    EXPECT_EQ(run_macadam({"query", "--excel", store_, "--way", "1", "--format", "csv"}).out,
              read_file(file_of("export", "any.csv", {"--excel"})));
    EXPECT_EQ(read_file(file_of("export", "en.csv", {"--excel=en"})), "\xEF\xBB\xBF" + english);
    EXPECT_THAT(refusal("export", {"-o", "a.csv", "--excel", "tlh"}),
                HasSubstr("--excel is 'tlh', expected a language such as en, "));
    EXPECT_THAT(refusal("export", {"-o", "a.kml", "--excel", "de"}),
                HasSubstr("--excel requires -o FILE.csv"));
    EXPECT_THAT(refusal("query", {"--way", "1", "--excel", "de"}),
                HasSubstr("--excel requires --format csv"));
}

TEST_F(HandingOn, AsAWorkbookHasSegmentsWorstSectionsAndADictionary) {
    const auto sections = file("sections.csv", "way_id,from_m,to_m\n1,0,100\n");
    const auto book = file_of("export", "a.xlsx");
    const auto sheets = read_xlsx(book);
    ASSERT_EQ(sheets.size(), 3U);
    EXPECT_EQ(sheets[0].name, "segments");
    EXPECT_EQ(sheets[0].rows.size(), 21U); // with the header
    EXPECT_EQ(sheets[0].rows[1].at("A").text, "1+0000");
    EXPECT_EQ(sheets[1].name, "worst");
    EXPECT_EQ(sheets[2].name, "columns");
    for (std::size_t i = 1; i < sheets[2].rows.size(); ++i) {
        EXPECT_TRUE(sheets[2].rows[i].contains("D")) // the meaning
            << sheets[2].rows[i].at("B").text;
    }
    const auto with_sections = file_of("export", "b.xlsx", {"--sections", sections});
    EXPECT_EQ(read_xlsx(with_sections)[1].name, "sections");
    EXPECT_EQ(read_xlsx(with_sections)[1].rows.size(), 2U);
    EXPECT_TRUE(read_file(book) == read_file(file_of("export", "again.xlsx")));
}

TEST_F(HandingOn, InUsUnitsConcernsCalibrationsAndMatchesToo) {
    // No car of this database shares 50 segments with others: there are rows, and exit status 1.
    const auto cars = run("calibrate", {"--dry-run", "--format", "csv", "--units", "us"});
    EXPECT_THAT(cars.out, StartsWith("vehicle,trips,shared_passes,gain,offset_in_per_mi,"));
    const auto trip = fmt::format("{}/sample_data/gyor/gyor_q3_00.trip.csv", source_folder());
    const auto roads = (folder_ / "traced.gpkg").string();
    ASSERT_EQ(run_macadam({"init", roads, "--trace", trip}).exit_status, 0);
    const auto si = run_macadam({"match", trip, "--network", roads, "--format", "json"});
    const auto us =
        run_macadam({"match", trip, "--network", roads, "--format", "json", "--units", "us"});
    EXPECT_THAT(si.err, HasSubstr(" km on roads"));
    EXPECT_THAT(us.err, AllOf(HasSubstr(" mi on roads"), Not(HasSubstr(" km"))));
    const auto longest = [](const Json& rows, const char* column) {
        double most = 0;
        for (const auto& row : rows) {
            most = row.at(column).is_null() ? most : std::max(most, double(row.at(column)));
        }
        return most;
    };
    EXPECT_NEAR(
        longest(Json::parse(us.out), "to_ft"), longest(Json::parse(si.out), "to_m") / 0.3048, 0.05);
}

TEST_F(HandingOn, InUsUnitsSaysTheUnitInTheNamesOfColumns) {
    const auto si = Json::parse(done("query", {"--way", "1", "--json"})).at(0);
    const auto us = Json::parse(done("query", {"--way", "1", "--json", "--units", "us"})).at(0);
    EXPECT_NEAR(us.at("iri_in_per_mi"), 63.36 * double(si.at("iri")), 0.1);
    EXPECT_NEAR(us.at("to_ft"), double(si.at("to_m")) / 0.3048, 0.05);
    EXPECT_FALSE(us.contains("iri"));
    const auto geojson =
        Json::parse(done("export", {"-o", "-", "--units", "us"})).at("features").at(0);
    EXPECT_TRUE(geojson.at("properties").contains("iri_in_per_mi"));
    const auto sheet = read_xlsx(file_of("export", "us.xlsx", {"--units", "us"})).back();
    std::vector<std::string> units;
    for (const auto& row : sheet.rows) {
        units.push_back(row.contains("C") ? row.at("C").text : "");
    }
    EXPECT_THAT(
        units, AllOf(Contains("in/mi"), Contains("ft"), Not(Contains("m")), Not(Contains("mm/m"))));
    EXPECT_THAT(refusal("export", {"-o", "a.qgz", "--units", "us"}),
                HasSubstr("the project shows the database, which is metric; export a .gpkg"));
    EXPECT_THAT(refusal("export", {"-o", "a.mbtiles", "--tiles", "picture", "--units", "us"}),
                HasSubstr("--units us has no effect on pictures"));
}

/// Fields of a layer as GDAL lists them: "iri_in_per_mi".
std::vector<std::string> fields_in(const std::filesystem::path& folder, const std::string& file) {
    const auto lines = output_of(folder,
                                 "/usr/bin/python3 -c 'import sys; from osgeo import ogr; "
                                 "file = ogr.Open(sys.argv[1]); "
                                 "print(*(each.name for each in file.GetLayer(0).schema))' " +
                                     file);
    std::istringstream words{lines};
    std::vector<std::string> names;
    for (std::string name; words >> name;) {
        names.push_back(name);
    }
    return names;
}

TEST_F(HandingOn, InUsUnitsHasTheColumnsOfCsvInFilesOfOtherPrograms) {
    auto header = done("export", {"-o", "-", "--format", "csv", "--units", "us"});
    header = header.substr(0, header.find(",lat_deg"));
    for (const auto* suffix : {"gpkg", "fgb"}) {
        const auto file = file_of("export", fmt::format("us.{}", suffix), {"--units", "us"});
        EXPECT_EQ(fmt::format("{}", fmt::join(fields_in(folder_, file), ",")), header) << suffix;
    }
    const auto kml = read_file(file_of("export", "us.kml", {"--units", "us"}));
    EXPECT_THAT(kml,
                AllOf(HasSubstr(R"(name="iri_in_per_mi")"),
                      HasSubstr("Roughness (IRI, in/mi)."),
                      Not(HasSubstr(R"(name="iri")"))));
}

TEST_F(HandingOn, InUsUnitsHasNamesOfTenBytesInAShapefile) {
    const auto file = file_of("export", "us.shp", {"--units", "us"});
    EXPECT_THAT(fields_in(folder_, file),
                AllOf(IsSupersetOf({"from_ft", "iri_inmi", "sd_inmi", "right_inmi", "trsd_inmi"}),
                      Not(Contains("iri")),
                      Not(Contains("from_m"))));
    const auto style = read_file(folder_ / "us.qml");
    EXPECT_THAT(style, HasSubstr(R"(attr="iri_inmi")"));
    EXPECT_THAT(style, HasSubstr(R"(lower="95.000000000" upper="170.000000000")"));
    EXPECT_THAT(style, HasSubstr("fair (95 to 170 in/mi)"));
    EXPECT_THAT(style, HasSubstr(R"~(field="trend_inmi" name="Trend (in/mi per year)")~"));
    EXPECT_THAT(style, HasSubstr(R"~(field="from_ft" name="From (ft along the way)")~"));
    EXPECT_EQ(metric_units_in(style.substr(style.find("<aliases>"))), "");
    const auto sld = read_file(folder_ / "us.sld");
    EXPECT_THAT(sld,
                HasSubstr("<ogc:PropertyName>iri_inmi</ogc:PropertyName><ogc:Literal>95.000000"));
    EXPECT_THAT(sld, HasSubstr("poor (above 170 in/mi)"));
}

TEST_F(HandingOn, InUsUnitsHasTilesAndEventsWithoutAMetricField) {
    done("export", {"-o", (folder_ / "tiles/").string(), "--units", "us"});
    const auto metadata = Json::parse(read_file(folder_ / "tiles" / "metadata.json"));
    const auto& layer = metadata.at("vector_layers").at(0);
    EXPECT_THAT(layer.at("description"), HasSubstr("IRI in in/mi"));
    for (const auto* field : {"from_ft", "iri_in_per_mi", "length_ft", "good_ft"}) {
        EXPECT_TRUE(layer.at("fields").contains(field)) << field;
    }
    EXPECT_EQ(metric_units_in(layer.at("description")), "");
    for (const auto* field : {"from_m", "iri", "length_m"}) {
        EXPECT_FALSE(layer.at("fields").contains(field)) << field;
    }
    const auto events = file_of("export", "us.gpkg", {"--events", "--units", "us"});
    EXPECT_THAT(fields_in(folder_, events),
                AllOf(IsSupersetOf({"size_in", "length_ft"}), Not(Contains("size_mm"))));
}

TEST_F(HandingOn, InUsUnitsIsInfoWithoutAMetricUnit) {
    const auto truth = file("truth.csv",
                            "segment,way_id,direction,from_m,to_m,iri_left,iri_right,mri,hri\n"
                            "1+0000,1,forward,0,19.99,2,2,2,2\n");
    const auto text = done("info", {"--units", "us", "--truth", truth});
    EXPECT_THAT(text, AllOf(HasSubstr(" mi"), HasSubstr("IRI (MRI) in in/mi")));
    EXPECT_EQ(metric_units_in(text), "");
    const auto si = Json::parse(done("info", {"--json", "--truth", truth}));
    const auto us = Json::parse(done("info", {"--json", "--truth", truth, "--units", "us"}));
    EXPECT_NEAR(us.at("mi"), double(si.at("km")) / 1.609344, 0.001);
    EXPECT_EQ(us.at("digest"), si.at("digest"));
    EXPECT_NEAR(us.at("truth").at("all").at("mean_truth_in_per_mi"), 2 * 63.36, 0.01);
    for (const auto* metric_name : {"\"km\"", "_m\":", "_km\":", "_mm", "\"iri\""}) {
        EXPECT_THAT(us.dump(), Not(HasSubstr(metric_name)));
    }
}

TEST_F(HandingOn, InUsUnitsIsAReportWithoutAMetricUnit) {
    const auto sections = file("sections.csv", "way_id,from_m,to_m\n1,0,100\n");
    const std::vector<std::string> words{
        "--units", "us", "--compare-since", "2026-01", "--sections", sections};
    const auto html = read_file(file_of("report", "us.html", words));
    EXPECT_EQ(metric_units_in(text_of_html(html)), "");
    EXPECT_THAT(text_of_html(html), AllOf(HasSubstr("in/mi"), HasSubstr(" mi"), HasSubstr("ft")));
    const auto pdf = file_of("report", "us.pdf", words);
    EXPECT_EQ(metric_units_in(output_of(folder_, "pdftotext " + pdf + " -")), "");
    EXPECT_NE(metric_units_in(text_of_html(read_file(file_of("report", "si.html")))), "");
}

TEST_F(HandingOn, TakesTheEarlierNameOfUnitsWithANote) {
    const auto now = run("report", {"-o", (folder_ / "a.html").string(), "--units", "us"});
    const auto earlier = run("report", {"-o", (folder_ / "b.html").string(), "--unit", "in/mi"});
    EXPECT_THAT(earlier.err, HasSubstr("--unit is called --units now"));
    EXPECT_TRUE(read_file(folder_ / "a.html") == read_file(folder_ / "b.html"));
    EXPECT_EQ(now.exit_status, 0);
}

TEST_F(HandingOn, ShowsASelectionInAReportAndOnAMap) {
    const auto page = text_of_html(read_file(
        file_of("report", "way.html", {"--way", "1", "--min-cars", "2", "--worst", "0"})));
    EXPECT_THAT(page,
                ContainsRegex("Selected by +--way +1 +--min-cars +2; cars, trips and data used"));
    const auto none = run("render", {"-o", (folder_ / "a.png").string(), "--min-passes", "99"});
    EXPECT_EQ(none.exit_status, 1);
    EXPECT_THAT(none.err, HasSubstr("the selection contains no measured segment"));
    EXPECT_THAT(refusal("render", {"-o", "a.png", "--compare-since", "2026", "--ramp", "viridis"}),
                HasSubstr("--compare-since is '2026', expected a time"));
    EXPECT_THAT(
        refusal("render", {"-o", "a.png", "--compare-since", "2026-01", "--ramp", "viridis"}),
        HasSubstr("--compare-since and --ramp cannot be combined"));
}

TEST_F(HandingOn, SiteIsAFolderAndRejectsOptionsOfOtherFormats) {
    const auto site = (folder_ / "site").string();
    EXPECT_THAT(refusal("export", {"-o", site + ".geojson", "--format", "site"}),
                HasSubstr("expected a new or empty folder with --format site, such as public/"));
    EXPECT_THAT(refusal("export", {"-o", site, "--format", "site", "--events"}),
                HasSubstr("--events and --format site cannot be combined"));
    EXPECT_THAT(refusal("export", {"-o", site, "--format", "site", "--tiles", "picture"}),
                HasSubstr("--tiles and --format site cannot be combined"));
    EXPECT_THAT(refusal("export", {"-o", site + "/", "--title", "Town"}),
                HasSubstr("--title requires --format site"));
    EXPECT_FALSE(std::filesystem::exists(site));
}

} // namespace
} // namespace macadam::testing
