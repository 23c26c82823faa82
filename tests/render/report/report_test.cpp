#include "render/report/report.hpp"

#include "render/report/document/html.hpp"
#include "render/report/document/page_assets.hpp"
#include "render/report/figures.hpp"
#include "render/report/strip_chart.hpp"
#include "render/scene/unbroken_numbers.hpp"
#include "storage/files/sha256.hpp"
#include "support/program/html_text.hpp"
#include "support/roads/sample_report.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace macadam {
namespace {

using ::testing::AllOf;
using ::testing::AnyOf;
using testing::between;
using ::testing::Contains;
using ::testing::ContainsRegex;
using ::testing::Each;
using ::testing::ElementsAre;
using testing::fhwa;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using testing::nothing_measured;
using ::testing::SizeIs;
using ::testing::StartsWith;
using testing::stretch_named;
using testing::town;

/// Whether every element that is opened is closed in order; what is wrong first, or nothing. Knows
/// the elements without content that a report uses.
std::string flaw_in(const std::string& html) {
    constexpr std::array<std::string_view, 5> empty{"meta", "img", "br", "wbr", "!DOCTYPE"};
    std::vector<std::string> open;
    for (std::size_t at = html.find('<'); at != std::string::npos; at = html.find('<', at + 1)) {
        const auto end = html.find('>', at);
        if (end == std::string::npos) {
            return "a tag that does not end";
        }
        const auto tag = html.substr(at + 1, end - at - 1);
        const auto name = tag.substr(0, tag.find_first_of(" /\n", tag.front() == '/' ? 1 : 0));
        if (std::ranges::count(tag, '"') % 2 != 0) {
            return "odd quotes in <" + tag + ">";
        }
        if (name.front() == '/') {
            if (open.empty() || open.back() != name.substr(1)) {
                return "<" + name + "> closes " + (open.empty() ? "nothing" : open.back());
            }
            open.pop_back();
        } else if (tag.back() != '/' && std::ranges::find(empty, name) == empty.end()) {
            open.push_back(name);
        }
        if (name == "style" || name == "script") {
            at = html.find("</" + name + ">", end) - 1;
        }
    }
    return open.empty() ? "" : "<" + open.back() + "> stays open";
}

/// Returns the page of a report with plain spaces, of which some are no-break spaces.
std::string page_of(const Report& report) {
    return testing::with_plain_spaces(report_html(report));
}

TEST(Report, ClosesEveryElementThatItOpens) {
    EXPECT_EQ(flaw_in(report_html(town())), "");
    EXPECT_EQ(flaw_in(report_html(nothing_measured())), "");
}

TEST(Report, KeepsNumbersWithTheirUnits) {
    const auto html = report_html(town());
    EXPECT_THAT(html, HasSubstr("<b>8.00\u00A0km</b>"));
    EXPECT_THAT(html, HasSubstr("2.10\u00A0– 2.90"));
    EXPECT_THAT(html, HasSubstr("62\u00A0% of what was driven"));
    EXPECT_THAT(html, HasSubstr("(140\u00A0m towards N"));
    EXPECT_EQ(with_unbroken_numbers("4 min, 3 cars in 2 in"), "4 min, 3 cars in 2 in");
    EXPECT_EQ(with_unbroken_numbers("5 mm – 6 mm"), "5\u00A0mm – 6\u00A0mm");
    EXPECT_EQ(with_unbroken_numbers("12 "), "12 ");
}

/// Returns the text of a page that may go over several lines, with marks of what stays on one.
std::string flowing_text(std::string html) {
    for (const std::string element : {"title", "style", "script", "svg"}) {
        for (auto at = html.find("<" + element); at != std::string::npos;
             at = html.find("<" + element, at)) {
            html.erase(at, html.find("</" + element + ">", at) - at);
        }
    }
    for (const std::string unit : {"mm/m", "in/mi"}) {
        testing::replace_all(html, "<span class=\"nw\">" + unit + "</span>", "[unit]");
    }
    for (auto at = html.find('<'); at != std::string::npos; at = html.find('<', at)) {
        html.replace(at, html.find('>', at) + 1 - at, "|");
    }
    return html;
}

TEST(Report, EndsNoLineBetweenANumberAndItsUnitNorWithinAUnit) {
    auto report = testing::changed_town();
    report.title = "Roads above 2.5 mm/m";
    report.worst[0].stretch.name = "Road of 3 km";
    for (const auto unit : {IriUnit::mm_per_m, IriUnit::in_per_mi}) {
        report.wording.unit = unit;
        const auto text = flowing_text(report_html(report));
        EXPECT_THAT(text, HasSubstr("[unit]"));
        EXPECT_THAT(text, Not(HasSubstr("mm/m")));
        EXPECT_THAT(text, Not(HasSubstr("in/mi")));
        EXPECT_THAT(text, Not(ContainsRegex(R"([0-9] (%|km|m|mm|ft|mi|\[unit\])[^a-z])")));
    }
}

TEST(Report, DrawsNoNumberIntoAnArabicName) {
    auto report = town();
    report.worst[0].stretch.name = "شارع الملك";
    report.worst[1].stretch.name =
        "Rue \u202Eelur\u2066"; // neither override nor open isolate stays
    const auto html = page_of(report);
    EXPECT_THAT(html, HasSubstr("<bdi>شارع الملك</bdi></a></b> (140 m"));
    EXPECT_THAT(html, HasSubstr(">Rue elur</td>"));
    EXPECT_THAT(html, Not(HasSubstr("\u2068")));
    report.title = "\u2068\u2068open\u2069\u2069\u2069";
    EXPECT_EQ(flaw_in(report_html(report)), "");
}

TEST(Report, BreaksNoThaiSyllableNorMarkOffItsLetter) {
    auto report = town();
    const std::string name = "ถนนเฉลิมพระเกียรติกาญจนาภิเษกที่";
    ASSERT_FALSE(report.worst.empty());
    report.worst[0].stretch.name = name;
    EXPECT_THAT(report_html(report), HasSubstr(name));
    report.worst[0].stretch.name = "Aaaaaaaaaaaaaaaaaaaaaaae\u0301bbb";
    EXPECT_THAT(report_html(report), HasSubstr("ae\u0301<wbr>bbb"));
}

TEST(Report, SaysTheNumbersItWasGiven) {
    const auto html = page_of(town());
    EXPECT_THAT(html, HasSubstr("<b>8.00 km</b>"));
    EXPECT_THAT(html, HasSubstr("40.0 % of the network of 20.0 km"));
    EXPECT_THAT(html, HasSubstr("<b>2.50 mm/m</b>"));
    EXPECT_THAT(html, HasSubstr("2.10 – 2.90</span>; 158 in/mi")); // 2.5 * 63.36
    EXPECT_THAT(html, HasSubstr("<b>62.5 %</b>"));                 // 5 of 8 km
    EXPECT_THAT(html, HasSubstr(">Living street</th>"));
    EXPECT_THAT(html, HasSubstr("12\u202F345 passes over segments"));
    EXPECT_THAT(html, HasSubstr("OSM way 123456, chainage 100–240 m<br>"));
    EXPECT_THAT(html, HasSubstr("Residential road without a name"));
    EXPECT_THAT(html, HasSubstr(">2026-03-01 to 2026-04-02</span>."));
}

TEST(Report, HasATableRowForEachStretchThatLeadsToItsMap) {
    const auto html = page_of(town());
    for (const auto* id : {"stretch-1", "stretch-2"}) {
        EXPECT_THAT(html, HasSubstr(fmt::format("href=\"#{}\"", id)));
        EXPECT_THAT(html, HasSubstr(fmt::format("id=\"{}\"", id)));
    }
}

TEST(Report, AsksForNothingFromOutside) {
    const auto html = page_of(town());
    EXPECT_THAT(between(html, "<script>", "</script>"), ElementsAre(std::string{page_script()}));
    EXPECT_THAT(page_script(), Not(HasSubstr("://")));
    EXPECT_THAT(page_script(), Not(HasSubstr("fetch")));
    EXPECT_THAT(html, Not(HasSubstr("<link")));
    EXPECT_THAT(html, Not(HasSubstr("@import")));
    EXPECT_THAT(html, Not(HasSubstr("url(")));
    for (const auto& address : between(html, " src=\"", "\"")) {
        EXPECT_THAT(address, StartsWith("data:image/png;base64,"));
    }
    for (const auto& address : between(html, " href=\"", "\"")) {
        // Within the page, or what a reader may follow.
        EXPECT_THAT(address,
                    AnyOf(StartsWith("#stretch-"),
                          StartsWith("#section-"),
                          StartsWith("geo:45.7"),
                          StartsWith("https://www.openstreetmap.org/?mlat=45.7")));
    }
}

TEST(Report, TakesNoNameForMarkup) {
    const std::string hostile = "\"><script>alert('x')</script>&amp;\x01\xff";
    auto report = town();
    report.title = report.network_source = report.attribution = hostile;
    report.period = {hostile, hostile};
    report.worst = {stretch_named(hostile)};
    report.worst[0].heading = hostile;
    report.worst[0].seen = {hostile, hostile};
    report.vehicles[0].name = report.vehicles[0].model = report.vehicles[0].method = hostile;
    report.summary.kinds[0].kind = hostile;
    const auto html = page_of(report);
    EXPECT_THAT(between(html, "<script", "</script>"), SizeIs(1)); // the page's own
    EXPECT_THAT(html, Not(HasSubstr("\xff")));
    EXPECT_THAT(html, HasSubstr("&quot;&gt;&lt;script&gt;alert(&#39;x&#39;)"));
    EXPECT_EQ(flaw_in(html), "");
}

TEST(Report, DescribesEveryPictureAndNamesEveryTable) {
    const auto html = page_of(town());
    for (const auto& image : between(html, "<img ", ">")) {
        EXPECT_THAT(between(image, " alt=\"Map of ", "\""), SizeIs(1));
    }
    const auto tables = between(html, "<table", "</table>");
    EXPECT_THAT(tables, SizeIs(8));
    for (const auto& table : tables) {
        EXPECT_THAT(table, HasSubstr(">\n<caption>"));
        EXPECT_THAT(between(table, "<th scope=\"", "\""),
                    SizeIs(between(table, "<th ", ">").size()));
        EXPECT_THAT(table, Not(HasSubstr("<th>")));
    }
    for (const auto& figure : between(html, "<svg ", ">")) {
        EXPECT_THAT(figure, AnyOf(HasSubstr("role=\"img\""), HasSubstr("aria-hidden=\"true\"")));
    }
}

TEST(Report, BeginsWithWhatMatters) {
    auto report = town();
    const auto lead = [&] { return between(page_of(report), "<p class=\"lead\">", "</p>"); };
    // 5 of 8 km are poor.
    EXPECT_THAT(lead(),
                ElementsAre("62 % of what was driven is poor; begin with <b><a "
                            "href=\"#stretch-1\">Rue de l&#39;Épée</a></b> (140 m towards N, mean "
                            "IRI 4.56 mm/m)."));
    report.worst.clear();
    EXPECT_THAT(lead(), ElementsAre(HasSubstr("62 % of what was driven is poor, in short")));
    report.summary.all = testing::summary_of(20000, {8000, 0, 0});
    EXPECT_THAT(lead(), ElementsAre("Nothing that was driven is poor."));
    EXPECT_THAT(between(page_of(nothing_measured()), "class=\"lead\"", "</p>"), IsEmpty());
}

TEST(Report, ShowsMapAndDistributionTogetherBeforeItsSections) {
    const auto html = page_of(town());
    const auto overview = between(html, "<div class=\"overview\"", "</header>");
    ASSERT_THAT(overview, SizeIs(1));
    EXPECT_THAT(overview[0],
                AllOf(HasSubstr("<figure class=\"map\""), HasSubstr("<svg class=\"histogram\"")));
    EXPECT_LT(html.find("class=\"overview\""), html.find("<main>"));
}

TEST(Report, ListsItsSectionsAsContents) {
    const auto html = page_of(town());
    const auto entries = between(between(html, "<nav", "</nav>").at(0), "href=\"#", "\"");
    EXPECT_THAT(entries, SizeIs(between(html, "<summary><h2>", "</h2>").size()));
    for (const auto& entry : entries) {
        EXPECT_THAT(html, HasSubstr("<details open id=\"" + entry + "\">"));
    }
}

TEST(Report, LetsOnlyItsOwnScriptRun) {
    Sha256 hash;
    hash.add(page_script());
    const auto hex = hash.hex();
    std::vector<std::uint8_t> bytes;
    for (std::size_t i = 0; i < hex.size(); i += 2) {
        bytes.push_back(static_cast<std::uint8_t>(std::stoi(hex.substr(i, 2), nullptr, 16)));
    }
    EXPECT_EQ(base64(bytes), page_script_sha256) << "put this into page_assets.hpp";
    EXPECT_THAT(
        page_of(town()),
        HasSubstr("default-src 'none'; style-src 'unsafe-inline'; img-src data:; script-src "
                  "'sha256-" +
                  std::string{page_script_sha256} + "'"));
}

TEST(StripChart, DrawsEachPieceAsHighAsItIsRoughWithItsInterval) {
    auto report = town();
    report.strips = {{0,
                      100,
                      {{"along", {{0, 20, 2, 1, 3, 1}, {20, 40, 4, 3, 5, 2}}},
                       {"against", {{60, 80, 1, 0.5, 1.5, 0}}}},
                      {{40, "High Street"}},
                      {{10, 50, "Control: A"}}}};
    const auto drawing =
        strip_drawing(report, report.strips[0], strip_on_page, "IRI along the road");
    std::vector<document::Bar> columns;
    std::vector<document::Band> bands;
    std::vector<std::string> labels;
    for (const auto& shape : drawing.shapes) {
        if (const auto* const bar = std::get_if<document::Bar>(&shape)) {
            columns.push_back(*bar);
        } else if (const auto* const band = std::get_if<document::Band>(&shape)) {
            bands.push_back(*band);
        } else if (const auto* const label = std::get_if<document::Label>(&shape)) {
            labels.push_back(label->text);
        }
    }
    ASSERT_THAT(columns, SizeIs(3));
    ASSERT_THAT(bands, SizeIs(4)); // the intervals, and the control section
    EXPECT_NEAR(columns[1].height / columns[0].height, 2, 1e-9);
    EXPECT_NEAR(columns[2].height / columns[0].height, 0.5, 1e-9); // one scale for both directions
    EXPECT_NEAR(bands[0].height, columns[0].height, 1e-9);         // 1 to 3 is as much as 0 to 2
    EXPECT_EQ(columns[1].rgb, report.colours[2]);
    EXPECT_EQ(columns[1].words, "20–40 m: IRI 4.00 (3.00 – 5.00)");
    EXPECT_GT(columns[2].y, columns[1].y); // the other direction lies below
    EXPECT_THAT(labels, Contains("High Street"));
    EXPECT_THAT(labels, Contains("Control: A"));
    EXPECT_THAT(page_of(report), HasSubstr("<h2>Strip chart</h2>"));
    EXPECT_EQ(flaw_in(page_of(report)), "");
}

TEST(StripChart, OfARoadWithoutLengthEnds) {
    auto report = town();
    report.strips = {{0, 0, {{"along", {{0, 0, 2, 1, 3, 1}}}}, {}, {}}};
    const auto drawing = strip_drawing(report, report.strips[0], strip_on_page, "IRI");
    EXPECT_LT(drawing.shapes.size(), 30U);
}

TEST(StripChart, OfARoadNeverMeasuredSaysSo) {
    auto report = town();
    report.strips = {{0, 100, {{"along", {}}}, {{40, "High Street"}}, {}}};
    const auto html = page_of(report);
    EXPECT_THAT(html, HasSubstr("No measurement along this road."));
    EXPECT_THAT(html, Not(HasSubstr("Segments by chainage")));
    EXPECT_THAT(html, Not(HasSubstr("High Street")));
}

TEST(StripChart, NamesARoadWhoseLettersHaveManyBytesWhereThereIsRoom) {
    auto report = town();
    const std::string name(20, 'x');
    std::string of_two_bytes;
    for (std::size_t i = 0; i < name.size(); ++i) {
        of_two_bytes += "\u0416";
    }
    const auto is_named = [&](const std::string& by) {
        report.strips = {{0, 100, {{"along", {{0, 100, 2, 1, 3, 1}}}}, {{12, by}}, {}}};
        const auto drawing = strip_drawing(report, report.strips[0], strip_on_page, "IRI");
        return std::ranges::any_of(drawing.shapes, [&](const auto& shape) {
            const auto* const label = std::get_if<document::Label>(&shape);
            return label != nullptr && label->text == by;
        });
    };
    EXPECT_TRUE(is_named(name));
    EXPECT_TRUE(is_named(of_two_bytes));
    EXPECT_FALSE(is_named(name + name));
}

TEST(Report, SaysTheChainageInFeetInAmericanReports) {
    auto report = town();
    report.wording.unit = IriUnit::in_per_mi;
    EXPECT_THAT(page_of(report), HasSubstr("OSM way 123456, chainage 328–787 ft<br>"));
}

TEST(Report, OfNothingMeasuredSaysSo) {
    const auto html = page_of(nothing_measured());
    EXPECT_THAT(html, HasSubstr("No measurements yet."));
    EXPECT_THAT(html, HasSubstr("No trips imported yet."));
    EXPECT_THAT(html, HasSubstr("0 % of the network of 20.0 km"));
    EXPECT_THAT(html, Not(HasSubstr("Mean IRI")));
    EXPECT_THAT(html, Not(HasSubstr("nan")));
}

TEST(Report, BreaksNoNameButOneThatIsLongerThanAColumn) {
    auto report = town();
    report.worst = {stretch_named(std::string(50, 'X')), stretch_named("Rue de la République")};
    const auto html = page_of(report);
    const std::string part(24, 'X');
    EXPECT_THAT(html, HasSubstr("<td>" + part + "<wbr>" + part + "<wbr>XX</td>"));
    EXPECT_THAT(html, HasSubstr("<td>Rue de la République</td>"));
    EXPECT_EQ(flaw_in(html), "");
}

TEST(Report, HasAScaleThatGrowsWithItsMap) {
    // The longest round length within 30 % of 4 km is 1 km, a quarter of the width.
    EXPECT_THAT(page_of(town()), HasSubstr("<span style=\"width:25.00%\"></span>1 km, north up"));
}

TEST(Report, LetsOnlyLongTablesGoOverAPage) {
    auto report = town();
    EXPECT_THAT(page_of(report), Not(HasSubstr("\"wide long\"")));
    report.vehicles.assign(20, report.vehicles[0]);
    EXPECT_THAT(between(page_of(report), "<div class=\"", "\" role"), Contains("wide long"));
}

TEST(Report, SaysOnTheMapsOfStretchesWhatItsTableLeavesOutOnPhones) {
    const auto html = page_of(town());
    EXPECT_THAT(between(html, "<th scope=\"col\" class=\"n else\">", "</th>"),
                ElementsAre("in/mi", "90 % interval", "Worst segment", "Passes", "Cars"));
    EXPECT_THAT(html,
                HasSubstr("(3.74 – 5.38) over 140 m<span class=\"phone\">, at worst 7.89<br>2 – 5 "
                          "passes by 3 cars</span>"));
}

TEST(Report, NamesEachValueOfACarWherePhonesHaveNoRoomForItsTitles) {
    EXPECT_THAT(page_of(town()),
                AllOf(HasSubstr("<td data-t=\"Model used\">built-in suv</td>"),
                      HasSubstr("<td class=\"n\" data-t=\"Trips\">12</td>")));
}

TEST(Report, SetsOffTheSumsOfItsTables) {
    const auto sums = between(page_of(town()), "<tr class=\"all\"><th scope=\"row\">", "<");
    EXPECT_THAT(sums,
                SizeIs(5)); // kinds of road twice, coverage, basis, reasons; of one car none
    EXPECT_THAT(sums, Each(std::string{"All"}));
}

TEST(Report, DescribesTheMethodsThatWereUsedAndNoOthers) {
    auto report = town();
    EXPECT_THAT(page_of(report),
                AllOf(HasSubstr("(kf) with a car model"), Not(HasSubstr("(smoother)"))));
    report.vehicles[0].method = "smoother";
    EXPECT_THAT(page_of(report),
                AllOf(HasSubstr("The method (smoother) finds"), Not(HasSubstr("(kf)"))));
}

TEST(Report, SaysWhatItsValuesRestOn) {
    const auto html = page_of(town());
    EXPECT_THAT(html, HasSubstr("Both wheel tracks: MRI observed</th><td class=\"n\">100</td>"));
    EXPECT_THAT(html,
                HasSubstr("Centre of the car: MRI estimated from HRI</th><td "
                          "class=\"n\">290</td><td class=\"n\">5.80</td><td class=\"n\">72.5 "
                          "%</td>"));
    EXPECT_THAT(html, HasSubstr("MRI = HRI / 0.91"));
    EXPECT_THAT(html, HasSubstr("37 passes are from lateral acceleration only"));
}

TEST(Report, SaysWhyRowsEnteredNoEstimateTheMostFrequentReasonFirst) {
    const auto html = page_of(town());
    const auto frequent = html.find("Repeated position</th><td class=\"n\">70</td>");
    const auto rare = html.find("Too slow</th><td class=\"n\">20</td><td class=\"n\">2.0 %</td>");
    ASSERT_NE(frequent, std::string::npos);
    ASSERT_NE(rare, std::string::npos);
    EXPECT_LT(frequent, rare);
    EXPECT_THAT(html, HasSubstr("Not recorded by an earlier version</th><td class=\"n\">10</td>"));
}

TEST(Report, OfACrowdSaysHowManyCarsAnEventTakes) {
    auto report = town();
    report.events = {ReportEvent{}};
    EXPECT_THAT(page_of(report), HasSubstr("at least two passes"));
    report.publication = ReportPublication{.month = "2026-11"};
    EXPECT_THAT(page_of(report),
                AllOf(HasSubstr("passes of at least five cars"), Not(HasSubstr("two passes"))));
}

TEST(Report, OfGoodRoadsHasNoWorstStretch) {
    auto report = town();
    report.worst.clear();
    report.stretches = 0;
    EXPECT_THAT(page_of(report),
                HasSubstr("No section of 100 m or more has a mean IRI above 2.68 mm/m."));
}

TEST(Report, AddsUpTheCarsThatItDoesNotList) {
    auto report = town();
    report.vehicles.assign(100, report.vehicles[0]);
    for (std::size_t i = 0; i < report.vehicles.size(); ++i) {
        report.vehicles[i].name = fmt::format("{}", i / 2 + 1); // each car with two methods
    }
    const auto html = page_of(report);
    EXPECT_THAT(html, HasSubstr("<b>50 cars</b>"));
    EXPECT_THAT(html, HasSubstr(">70 more rows</th>"));
    EXPECT_THAT(html, HasSubstr("1200 trips"));
}

TEST(Html, EscapesWhatMarkupIsMadeOf) {
    EXPECT_EQ(escaped("a<b>&\"c'"), "a&lt;b&gt;&amp;&quot;c&#39;");
    EXPECT_EQ(escaped("Épée 漢字 😀"), "Épée 漢字 😀");
    EXPECT_EQ(escaped("a\nb\x7f"), "a b ");
    EXPECT_EQ(escaped("a\u202Eb\u2066c\u2069\u2019"), "abc\u2019"); // nothing turned round
}

TEST(Html, ReplacesWhatIsNoUtf8) {
    const std::string sign = "\xEF\xBF\xBD";
    EXPECT_EQ(escaped("a\xC0\xAF"), "a" + sign + sign);                // '/' in two bytes
    EXPECT_EQ(escaped("\xED\xA0\x80"), sign + sign + sign);            // half of a surrogate pair
    EXPECT_EQ(escaped("\xF4\x90\x80\x80"), sign + sign + sign + sign); // above U+10FFFF
    EXPECT_EQ(escaped("\xE2\x82"), sign + sign);                       // cut off
}

TEST(Html, EncodesTheVectorsOfRfc4648) {
    const auto encoded = [](std::string_view text) {
        return base64({reinterpret_cast<const std::uint8_t*>(text.data()), // NOLINT(*-cast)
                       text.size()});
    };
    EXPECT_EQ(encoded(""), "");
    EXPECT_EQ(encoded("f"), "Zg==");
    EXPECT_EQ(encoded("fo"), "Zm8=");
    EXPECT_EQ(encoded("foo"), "Zm9v");
    EXPECT_EQ(encoded("foob"), "Zm9vYg==");
    EXPECT_EQ(encoded("fooba"), "Zm9vYmE=");
    EXPECT_EQ(encoded("foobar"), "Zm9vYmFy");
}

TEST(ReportNumbers, HaveTheDecimalsThatFit) {
    const Localisation say;
    EXPECT_EQ(say.road_length(1234, 9999), "1.23");
    EXPECT_EQ(say.road_length(1234, 50000), "1.2");
    EXPECT_EQ(say.road_length(1234567, 2e6), "1235");
    EXPECT_EQ(say.count(9999), "9999");
    EXPECT_EQ(say.count(1234567), "1\u202F234\u202F567");
    EXPECT_EQ(say.percent(0, 5), "0 %");
    EXPECT_EQ(say.percent(1, 2000), "< 0.1 %");
    EXPECT_EQ(say.percent(1, 3), "33.3 %");
    EXPECT_EQ(say.percent(0, 0), "–");
    EXPECT_EQ(say.iri_change(-0.516), "\u22120.52");
    EXPECT_EQ(say.iri_change(0.004), "±0.00"); // no sign of what rounds to nothing
}

TEST(ReportNumbers, AreMilesFeetAndInchesInAmericanReports) {
    const Localisation say{.unit = IriUnit::in_per_mi};
    EXPECT_EQ(say.road_length(1609.344, 1609.344), "1.00");
    EXPECT_EQ(say.road_length(16093.44, 16093.44), "10.0"); // the longest decides, in miles
    EXPECT_EQ(say.short_length(100), "328");
    EXPECT_EQ(say.small_size(25.4), "1.00");
    EXPECT_EQ(say.long_unit(), "mi");
    EXPECT_THAT(say("limits.segments"), AllOf(HasSubstr("66 ft"), HasSubstr("a mile")));
    const Localisation metric;
    EXPECT_EQ(metric.short_length(100), "100");
    EXPECT_EQ(metric.small_size(25.4), "25");
    EXPECT_THAT(metric("limits.segments"), HasSubstr("over 20 m than over 100 m or a kilometre"));
}

TEST(ReportNumbers, SayTheBordersOfTheClassesInBothUnits) {
    const Localisation metric{.unit = IriUnit::mm_per_m};
    const Localisation inches{.unit = IriUnit::in_per_mi};
    EXPECT_EQ(inches.range(fhwa, 0), "below 95");
    EXPECT_EQ(metric.range(fhwa, 1), "1.50 – 2.68");
    EXPECT_EQ(inches.range(fhwa, 2), "above 170");
    EXPECT_EQ(metric.range(*class_table("five"), 0), "up to 1.50");
}

TEST(ReportNumbers, AreWrittenAsTheLanguageDoes) {
    const Localisation german{.language = language("de")};
    EXPECT_EQ(german.number(1234.5, 1), "1234,5");
    EXPECT_EQ(german.percent(1, 3), "33,3 %");
    EXPECT_EQ(german.day("2026-03-01"), "01.03.2026");
    EXPECT_EQ(german.period("2026-03-01", "2026-04-02"), "01.03.2026 bis 02.04.2026");
    EXPECT_EQ(german.counted("cars", 1), "1 Fahrzeug");
    EXPECT_EQ(german.counted("cars", 12), "12 Fahrzeuge");
}

/// The attribute's values of all bars, in their order.
std::vector<double> bars(const std::string& svg, const std::string& attribute) {
    std::vector<double> values;
    for (const auto& bar : between(svg, "<rect class=\"bar\"", "</rect>")) {
        values.push_back(std::stod(between(bar, " " + attribute + "=\"", "\"").at(0)));
    }
    return values;
}

TEST(Histogram, DrawsBarsAsHighAsTheRoadIsLong) {
    const auto html = page_of(town());
    const auto svg = between(html, "<svg class=\"histogram\"", "</svg>").at(0);
    const auto heights = bars(svg, "height");
    ASSERT_EQ(heights.size(), 4U); // 1000, 2000 with 500 on top, 4500 m
    EXPECT_NEAR(heights[1] / heights[0], 2, 0.01);
    EXPECT_NEAR(heights[2] / heights[0], 0.5, 0.01);
    EXPECT_NEAR(heights[3] / heights[0], 4.5, 0.01);
    const auto y = bars(svg, "y");
    EXPECT_NEAR(y[2] + heights[2], y[1], 0.02); // on top of the other
}

TEST(ShareBar, IsPartedAsTheRoadIs) {
    const auto bar = share_bar(town(), town().summary.all);
    ASSERT_THAT(bar.shares, SizeIs(3));
    EXPECT_DOUBLE_EQ(bar.shares[1].percent, 25);
    EXPECT_DOUBLE_EQ(bar.shares[2].percent, 62.5);
    EXPECT_THAT(page_of(town()), HasSubstr("x=\"37.50\" width=\"62.50\""));
    EXPECT_THAT(share_bar(town(), nothing_measured().summary.all).shares, IsEmpty());
}

} // namespace
} // namespace macadam
