// CQL2 (OGC 21-065r2): the same condition in text and JSON is one expression, and holds for the
// features for which it should. The conditions are those of the standard's clauses 6 to 8, asked of
// a road.

#include "app/serve/filters/cql2_json.hpp"
#include "app/serve/filters/cql2_like.hpp"
#include "app/serve/filters/cql2_text.hpp"
#include "app/serve/filters/feature_filter.hpp"
#include "storage/text/columns.hpp"

#include <gmock/gmock.h>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace macadam::testing {
namespace {

using ::testing::HasSubstr;

struct Road {
    std::optional<std::string> name;
    double iri;
    int passes;
    bool paved;
    std::optional<std::string> first_seen, last_seen;
};

const std::vector<FeatureColumn>& road_columns() {
    static const Columns<Road> columns{
        {"name", as::text, [](auto& r) { return r.name; }},
        {"iri", as::iri(3), [](auto& r) { return r.iri; }},
        {"passes", as::integer, [](auto& r) { return r.passes; }},
        {"paved", as::truth, [](auto& r) { return r.paved; }},
        {"first_seen", as::day, [](auto& r) { return r.first_seen; }},
        {"last_seen", as::day, [](auto& r) { return r.last_seen; }},
        {"history", as::raw, [](auto& r) { return r.name; }},
    };
    static const auto erased = feature_columns(columns);
    return erased;
}

/// A road of 1 km eastwards from 50 N 10 E.
const Road road{"Hauptstraße", 4.2504, 7, true, "2026-03-10", "2026-05-20"};
const Road unknown_road{std::nullopt, 2, 1, false, std::nullopt, std::nullopt};
const std::vector<GeoPoint> line{{50, 10}, {50, 10.014}};

bool holds(const Cql2Expression& expression, const Road& of = road) {
    return feature_filter(expression, road_columns(), CoordinateReference::crs84)
        .test({.id = "1", .line = line, .row = &of});
}

bool holds(std::string_view text, const Road& of = road) {
    return holds(parse_cql2_text(text), of);
}

struct Example {
    std::string_view text, json;
    bool holds = true;
};

class Cql2Examples : public ::testing::TestWithParam<Example> {};

TEST_P(Cql2Examples, AreOneExpressionInTextAndJson) {
    const auto& [text, json, expected] = GetParam();
    const auto expression = parse_cql2_text(text);
    EXPECT_TRUE(expression == parse_cql2_json(json)) << text << "\n" << json;
    EXPECT_EQ(holds(expression), expected) << text;
}

// clang-format off
INSTANTIATE_TEST_SUITE_P(Basic, Cql2Examples, ::testing::Values( // 6, basic-cql2
    Example{"iri > 4", R"({"op":">","args":[{"property":"iri"},4]})"},
    Example{"\"iri\" <= 4.25", R"({"op":"<=","args":[{"property":"iri"},4.25]})"},
    Example{"iri <> -1.5e1", R"({"op":"<>","args":[{"property":"iri"},-15]})"},
    Example{"iri >= +.5", R"({"op":">=","args":[{"property":"iri"},0.5]})"},
    Example{"passes < 7", R"({"op":"<","args":[{"property":"passes"},7]})", false},
    Example{"name = 'Hauptstraße'", R"({"op":"=","args":[{"property":"name"},"Hauptstraße"]})"},
    Example{"name = 'O''Neil'", R"({"op":"=","args":[{"property":"name"},"O'Neil"]})", false},
    Example{R"(name <> 'it\'s')", R"({"op":"<>","args":[{"property":"name"},"it's"]})"},
    Example{"paved = TRUE", R"({"op":"=","args":[{"property":"paved"},true]})"},
    Example{"true", "true"},
    Example{"last_seen >= DATE('2026-05-20')", R"({"op":">=","args":[{"property":"last_seen"},{"date":"2026-05-20"}]})"},
    Example{"first_seen = TIMESTAMP('2026-03-10T06:00:00Z')", R"({"op":"=","args":[{"property":"first_seen"},{"timestamp":"2026-03-10T06:00:00Z"}]})"},
    Example{"first_seen < '2026-03-10'", R"({"op":"<","args":[{"property":"first_seen"},"2026-03-10"]})", false},
    Example{"name IS NULL", R"({"op":"isNull","args":[{"property":"name"}]})", false},
    Example{"name IS NOT NULL", R"({"op":"not","args":[{"op":"isNull","args":[{"property":"name"}]}]})"},
    Example{"iri > 4 AND passes >= 3 AND paved = true", R"({"op":"and","args":[{"op":">","args":[{"property":"iri"},4]},{"op":">=","args":[{"property":"passes"},3]},{"op":"=","args":[{"property":"paved"},true]}]})"},
    Example{"iri > 9 OR passes = 7 AND NOT (paved = false)", R"({"op":"or","args":[{"op":">","args":[{"property":"iri"},9]},{"op":"and","args":[{"op":"=","args":[{"property":"passes"},7]},{"op":"not","args":[{"op":"=","args":[{"property":"paved"},false]}]}]}]})"},
    Example{"(iri > 9 or passes = 7) and paved = false", R"({"op":"and","args":[{"op":"or","args":[{"op":">","args":[{"property":"iri"},9]},{"op":"=","args":[{"property":"passes"},7]}]},{"op":"=","args":[{"property":"paved"},false]}]})", false}));

INSTANTIATE_TEST_SUITE_P(Comparisons, Cql2Examples, ::testing::Values( // 7.1 to 7.3
    Example{"name LIKE 'Haupt%'", R"({"op":"like","args":[{"property":"name"},"Haupt%"]})"},
    Example{"name NOT LIKE '%weg'", R"({"op":"not","args":[{"op":"like","args":[{"property":"name"},"%weg"]}]})"},
    Example{"CASEI(name) LIKE casei('HAUPTSTRASSE')", R"({"op":"like","args":[{"op":"casei","args":[{"property":"name"}]},{"op":"casei","args":["HAUPTSTRASSE"]}]})"},
    Example{"CASEI(name) IN (CASEI('hauptSTRASSE'), CASEI('Weg'))", R"({"op":"in","args":[{"op":"casei","args":[{"property":"name"}]},[{"op":"casei","args":["hauptSTRASSE"]},{"op":"casei","args":["Weg"]}]]})"},
    Example{"iri BETWEEN 4 AND 4.25", R"({"op":"between","args":[{"property":"iri"},4,4.25]})"},
    Example{"iri NOT BETWEEN 4.2 AND 9 OR false", R"({"op":"or","args":[{"op":"not","args":[{"op":"between","args":[{"property":"iri"},4.2,9]}]},false]})", false},
    Example{"passes IN (1, 2, 7)", R"({"op":"in","args":[{"property":"passes"},[1,2,7]]})"},
    Example{"passes NOT IN (1, 2)", R"({"op":"not","args":[{"op":"in","args":[{"property":"passes"},[1,2]]}]})"},
    Example{"iri < passes", R"({"op":"<","args":[{"property":"iri"},{"property":"passes"}]})"},
    Example{"iri + 2 * passes - 1 > 17", R"({"op":">","args":[{"op":"-","args":[{"op":"+","args":[{"property":"iri"},{"op":"*","args":[2,{"property":"passes"}]}]},1]},17]})"},
    Example{"(passes + 1) / 2 = 2 ^ 2", R"({"op":"=","args":[{"op":"/","args":[{"op":"+","args":[{"property":"passes"},1]},2]},{"op":"^","args":[2,2]}]})"},
    Example{"passes % 4 = passes DIV 2", R"({"op":"=","args":[{"op":"%","args":[{"property":"passes"},4]},{"op":"div","args":[{"property":"passes"},2]}]})"},
    Example{"passes / 0 > 1", R"({"op":">","args":[{"op":"/","args":[{"property":"passes"},0]},1]})", false}));

INSTANTIATE_TEST_SUITE_P(Places, Cql2Examples, ::testing::Values( // 7.4, spatial-functions
    Example{"S_INTERSECTS(geometry, BBOX(10.01, 49, 11, 51))", R"({"op":"s_intersects","args":[{"property":"geometry"},{"bbox":[10.01,49,11,51]}]})"},
    Example{"S_INTERSECTS(geometry, BBOX(10.02, 49, 0, 11, 51, 9))", R"({"op":"s_intersects","args":[{"property":"geometry"},{"bbox":[10.02,49,0,11,51,9]}]})", false},
    Example{"S_INTERSECTS(geometry, BBOX(179, 49, 10.001, 51))", R"({"op":"s_intersects","args":[{"property":"geometry"},{"bbox":[179,49,10.001,51]}]})"},
    Example{"S_INTERSECTS(geometry, POINT(10.007 50))", R"({"op":"s_intersects","args":[{"property":"geometry"},{"type":"Point","coordinates":[10.007,50]}]})"},
    Example{"S_INTERSECTS(geometry, POINT Z (10.007 50 400))", R"({"op":"s_intersects","args":[{"property":"geometry"},{"type":"Point","coordinates":[10.007,50,400]}]})"},
    Example{"S_WITHIN(geometry, POLYGON((9 49, 11 49, 11 51, 9 51, 9 49)))", R"({"op":"s_within","args":[{"property":"geometry"},{"type":"Polygon","coordinates":[[[9,49],[11,49],[11,51],[9,51],[9,49]]]}]})"},
    Example{"S_CONTAINS(POLYGON((9 49, 11 49, 11 51, 9 51, 9 49)), geometry)", R"({"op":"s_contains","args":[{"type":"Polygon","coordinates":[[[9,49],[11,49],[11,51],[9,51],[9,49]]]},{"property":"geometry"}]})"},
    Example{"S_INTERSECTS(geometry, POLYGON((9 49, 11 49, 11 51, 9 51, 9 49), (9.9 49.9, 10.1 49.9, 10.1 50.1, 9.9 50.1, 9.9 49.9)))", R"({"op":"s_intersects","args":[{"property":"geometry"},{"type":"Polygon","coordinates":[[[9,49],[11,49],[11,51],[9,51],[9,49]],[[9.9,49.9],[10.1,49.9],[10.1,50.1],[9.9,50.1],[9.9,49.9]]]}]})", false},
    Example{"S_DISJOINT(geometry, MULTIPOINT((10 51), (10 49)))", R"({"op":"s_disjoint","args":[{"property":"geometry"},{"type":"MultiPoint","coordinates":[[10,51],[10,49]]}]})"},
    Example{"S_CROSSES(geometry, LINESTRING(10.007 49.9, 10.007 50.1))", R"({"op":"s_crosses","args":[{"property":"geometry"},{"type":"LineString","coordinates":[[10.007,49.9],[10.007,50.1]]}]})"},
    Example{"S_TOUCHES(geometry, LINESTRING(10 50, 10 50.1))", R"({"op":"s_touches","args":[{"property":"geometry"},{"type":"LineString","coordinates":[[10,50],[10,50.1]]}]})"},
    Example{"S_OVERLAPS(geometry, MULTILINESTRING((9.9 50, 10.007 50), (8 8, 9 9)))", R"({"op":"s_overlaps","args":[{"property":"geometry"},{"type":"MultiLineString","coordinates":[[[9.9,50],[10.007,50]],[[8,8],[9,9]]]}]})"},
    Example{"S_EQUALS(geometry, LINESTRING(10.014 50, 10 50))", R"({"op":"s_equals","args":[{"property":"geometry"},{"type":"LineString","coordinates":[[10.014,50],[10,50]]}]})"},
    Example{"S_INTERSECTS(geometry, MULTIPOLYGON(((0 0, 1 0, 1 1, 0 0)), ((9 49, 11 49, 11 51, 9 49))))", R"({"op":"s_intersects","args":[{"property":"geometry"},{"type":"MultiPolygon","coordinates":[[[[0,0],[1,0],[1,1],[0,0]]],[[[9,49],[11,49],[11,51],[9,49]]]]}]})"},
    Example{"S_INTERSECTS(geometry, GEOMETRYCOLLECTION(POINT(1 1), LINESTRING(10 50, 10 51)))", R"({"op":"s_intersects","args":[{"property":"geometry"},{"type":"GeometryCollection","geometries":[{"type":"Point","coordinates":[1,1]},{"type":"LineString","coordinates":[[10,50],[10,51]]}]}]})"}));

INSTANTIATE_TEST_SUITE_P(Times, Cql2Examples, ::testing::Values( // 7.5, temporal-functions; seen from 10 March to 20 May
    Example{"T_AFTER(last_seen, DATE('2026-05-19'))", R"({"op":"t_after","args":[{"property":"last_seen"},{"date":"2026-05-19"}]})"},
    Example{"T_BEFORE(last_seen, TIMESTAMP('2026-05-20T23:00:00Z'))", R"({"op":"t_before","args":[{"property":"last_seen"},{"timestamp":"2026-05-20T23:00:00Z"}]})", false},
    Example{"T_EQUALS(first_seen, DATE('2026-03-10'))", R"({"op":"t_equals","args":[{"property":"first_seen"},{"date":"2026-03-10"}]})"},
    Example{"T_INTERSECTS(INTERVAL(first_seen, last_seen), INTERVAL('2026-05-20', '..'))", R"({"op":"t_intersects","args":[{"interval":[{"property":"first_seen"},{"property":"last_seen"}]},{"interval":["2026-05-20",".."]}]})"},
    Example{"T_DISJOINT(INTERVAL(first_seen, last_seen), INTERVAL('..', '2026-03-09T23:59:59Z'))", R"({"op":"t_disjoint","args":[{"interval":[{"property":"first_seen"},{"property":"last_seen"}]},{"interval":["..","2026-03-09T23:59:59Z"]}]})"},
    Example{"T_DURING(INTERVAL(first_seen, last_seen), INTERVAL('2026-01-01', '2026-12-31'))", R"({"op":"t_during","args":[{"interval":[{"property":"first_seen"},{"property":"last_seen"}]},{"interval":["2026-01-01","2026-12-31"]}]})"},
    Example{"T_DURING(INTERVAL(first_seen, last_seen), INTERVAL('2026-03-10', '2026-12-31'))", R"({"op":"t_during","args":[{"interval":[{"property":"first_seen"},{"property":"last_seen"}]},{"interval":["2026-03-10","2026-12-31"]}]})", false},
    Example{"T_CONTAINS(INTERVAL('..', '..'), INTERVAL(first_seen, last_seen))", R"({"op":"t_contains","args":[{"interval":["..",".."]},{"interval":[{"property":"first_seen"},{"property":"last_seen"}]}]})"},
    Example{"T_STARTS(INTERVAL(first_seen, last_seen), INTERVAL('2026-03-10', '2026-12-31'))", R"({"op":"t_starts","args":[{"interval":[{"property":"first_seen"},{"property":"last_seen"}]},{"interval":["2026-03-10","2026-12-31"]}]})"},
    Example{"T_STARTEDBY(INTERVAL(first_seen, last_seen), INTERVAL('2026-03-10', '2026-04-01'))", R"({"op":"t_startedBy","args":[{"interval":[{"property":"first_seen"},{"property":"last_seen"}]},{"interval":["2026-03-10","2026-04-01"]}]})"},
    Example{"T_FINISHES(INTERVAL(first_seen, last_seen), INTERVAL('2026-01-01', '2026-05-20'))", R"({"op":"t_finishes","args":[{"interval":[{"property":"first_seen"},{"property":"last_seen"}]},{"interval":["2026-01-01","2026-05-20"]}]})"},
    Example{"T_FINISHEDBY(INTERVAL(first_seen, last_seen), INTERVAL('2026-04-01', '2026-05-20'))", R"({"op":"t_finishedBy","args":[{"interval":[{"property":"first_seen"},{"property":"last_seen"}]},{"interval":["2026-04-01","2026-05-20"]}]})"},
    Example{"T_MEETS(INTERVAL(first_seen, last_seen), INTERVAL('2026-05-20', '2026-06-20'))", R"({"op":"t_meets","args":[{"interval":[{"property":"first_seen"},{"property":"last_seen"}]},{"interval":["2026-05-20","2026-06-20"]}]})"},
    Example{"T_METBY(INTERVAL(first_seen, last_seen), INTERVAL('2026-01-01', '2026-03-10'))", R"({"op":"t_metBy","args":[{"interval":[{"property":"first_seen"},{"property":"last_seen"}]},{"interval":["2026-01-01","2026-03-10"]}]})"},
    Example{"T_OVERLAPS(INTERVAL(first_seen, last_seen), INTERVAL('2026-04-01', '2026-06-20'))", R"({"op":"t_overlaps","args":[{"interval":[{"property":"first_seen"},{"property":"last_seen"}]},{"interval":["2026-04-01","2026-06-20"]}]})"},
    Example{"T_OVERLAPPEDBY(INTERVAL(first_seen, last_seen), INTERVAL('2026-01-01', '2026-04-01'))", R"({"op":"t_overlappedBy","args":[{"interval":[{"property":"first_seen"},{"property":"last_seen"}]},{"interval":["2026-01-01","2026-04-01"]}]})"}));
// clang-format on

TEST(Cql2, LeavesOutFeaturesWhoseValueIsUnknown) {
    for (const std::string_view text :
         {"name = 'a'",
          "NOT name = 'a'",
          "name LIKE '%'",
          "name IN ('a', 'b')",
          "name NOT IN ('a')",
          "T_AFTER(last_seen, DATE('1970-01-01'))",
          "T_INTERSECTS(INTERVAL(first_seen, '..'), INTERVAL('..', '..'))"}) {
        EXPECT_FALSE(holds(text, unknown_road)) << text;
    }
    EXPECT_TRUE(holds("name IS NULL AND last_seen IS NULL", unknown_road));
    EXPECT_TRUE(holds("name = 'a' OR passes = 1", unknown_road));
}

TEST(Cql2, ComputesAValueOnceForAllOfAListOrRange) {
    // Computed for each of them, the innermost condition would be made 8 to the 18th times.
    std::string lists = R"({"op":"=","args":[{"property":"paved"},true]})";
    std::string ranges = lists;
    for (int depth = 0; depth < 18; ++depth) {
        lists = R"({"op":"in","args":[)" + lists + ",[false,true,true,true,true,true,true,false]]}";
        ranges = R"({"op":"between","args":[)" + ranges + ",true,true]}";
    }
    EXPECT_TRUE(holds(parse_cql2_json(lists)));
    EXPECT_TRUE(holds(parse_cql2_json(lists), unknown_road)); // true and false are in each list
    EXPECT_TRUE(holds(parse_cql2_json(ranges)));
    EXPECT_FALSE(holds(parse_cql2_json(ranges), unknown_road));
}

TEST(Cql2, ComparesNumbersAsTheyAreShown) {
    EXPECT_TRUE(holds("iri = 4.25"));
}

TEST(Cql2, ComparesPlacesAsTheyAreShown) {
    const std::vector<GeoPoint> exact{{50.12345678, 10.12345674}, {50.22222222, 10.33333333}};
    for (const auto* const text :
         {"S_INTERSECTS(geometry, POINT(10.1234567 50.1234568))",
          "S_TOUCHES(geometry, POINT(10.3333333 50.2222222))",
          "S_EQUALS(geometry, LINESTRING(10.1234567 50.1234568, 10.3333333 50.2222222))"}) {
        EXPECT_TRUE(
            feature_filter(parse_cql2_text(text), road_columns(), CoordinateReference::crs84)
                .test({.id = "1", .line = exact, .row = &road}))
            << text;
    }
}

TEST(Cql2, FindsTheBoxThatAFilterNeeds) {
    const auto box_of = [](std::string_view text) {
        return feature_filter(parse_cql2_text(text), road_columns(), CoordinateReference::epsg_4326)
            .box;
    };
    EXPECT_EQ(box_of("iri > 2 AND S_WITHIN(geometry, BBOX(49, 9, 51, 11))"),
              (GeoBox{9, 49, 11, 51}));
    EXPECT_FALSE(box_of("iri > 2 OR S_WITHIN(geometry, BBOX(49, 9, 51, 11))"));
    EXPECT_FALSE(box_of("S_DISJOINT(geometry, BBOX(49, 9, 51, 11))"));
    EXPECT_FALSE(box_of("NOT S_INTERSECTS(geometry, BBOX(49, 9, 51, 11))"));
}

struct BadFilter {
    std::string text;
    std::string_view words;
};

TEST(Cql2, RefusesInWordsWhatIsNoFilter) {
    for (const auto& [text, words] : {
             BadFilter{"", "after 0 letters there is the end, expected a property"},
             BadFilter{"iri >", "after 5 letters there is the end"},
             BadFilter{"iri > 4 passes", "there is 'passes', expected AND, OR or the end"},
             BadFilter{"iri ! 4", "expected AND, OR or the end"},
             BadFilter{"iri", "there is a number, expected a condition"},
             BadFilter{"rri > 4", "there is no property 'rri'"},
             BadFilter{"history = 'a'", "there is no property 'history'"},
             BadFilter{"iri = 'a'", "a number cannot be compared with a text"},
             BadFilter{"name LIKE 4", "there is a number, expected a text"},
             BadFilter{"name NOT 4", "expected LIKE, BETWEEN or IN"},
             BadFilter{"iri IN ()", "expected a property"},
             BadFilter{"name = 'a", "does not end"},
             BadFilter{"\"iri > 4", "does not end"},
             BadFilter{"iri > 1e999", "expected a number within 1e308"},
             BadFilter{"buffer(geometry, 1) = 2", "there is no function 'buffer'"},
             BadFilter{"last_seen > DATE('2026-02-30')", "is no time"},
             BadFilter{"last_seen > DATE('2026-02-01T00:00:00Z')", "expected DATE("},
             BadFilter{"last_seen > INTERVAL('..', '..')", "T_INTERSECTS"},
             BadFilter{"T_AFTER(iri, DATE('2026-01-01'))", "there is a number, expected a time"},
             BadFilter{"S_INTERSECTS(geometry, POINT(200 1))", "is not on the globe"},
             BadFilter{"S_INTERSECTS(geometry, POINT(1 2, 3 4))", "not of one position"},
             BadFilter{"S_INTERSECTS(geometry, BBOX(1, 2, 3))", "4 or 6 numbers"},
             BadFilter{"S_INTERSECTS(geometry, BBOX(1, 3, 2, 2))", "south"},
             BadFilter{"S_INTERSECTS(geometry, iri)", "there is a number, expected a geometry"},
             BadFilter{"S_INTERSECTS(geometry)", "takes 2 operands, not 1"},
             BadFilter{"S_INTERSECTS(geometry, POLYGON((0 0, 1 1, 2 2)))", "has 3 positions"},
             BadFilter{"S_INTERSECTS(geometry, POLYGON((0 0, 1 1, 2 2, 3 3)))",
                       "does not end where"},
             BadFilter{"S_INTERSECTS(geometry, POLYGON((0 0, 2 2, 2 0, 0 2, 0 0)))", "not valid"},
             BadFilter{"S_WITHIN(geometry, GEOMETRYCOLLECTION(POINT(0 0)))", "no collection"},
             BadFilter{std::string(5000, '('), "5000 bytes"},
             BadFilter{std::string(4000, '('), "more than 20 deep"},
             BadFilter{"NOT" + std::string(300, ' ') +
                           [] {
                               std::string nots;
                               for (int i = 0; i < 500; ++i) {
                                   nots += "NOT ";
                               }
                               return nots;
                           }(),
                       "more than 20 deep"},
             BadFilter{"iri > 1" +
                           [] {
                               std::string sum;
                               for (int i = 0; i < 1000; ++i) {
                                   sum += "+1";
                               }
                               return sum;
                           }(),
                       "more than 20 operators"},
         }) {
        try {
            holds(text);
            ADD_FAILURE() << text;
        } catch (const Cql2Error& error) {
            EXPECT_THAT(error.what(), HasSubstr(words)) << text.substr(0, 80);
        }
    }
}

TEST(Cql2, RefusesInWordsWhatIsNoFilterInJson) {
    for (const auto& [text, words] : {
             BadFilter{"{", "is not JSON"},
             BadFilter{"null", "expected an expression"},
             BadFilter{"{}", "a member type"},
             BadFilter{R"({"op":"<"})", "a member args"},
             BadFilter{R"({"op":"<","args":[1]})", "2 operands"},
             BadFilter{R"({"op":"and","args":[true]})", "two operands or more"},
             BadFilter{R"({"op":"in","args":[1,2]})", "a list of values"},
             BadFilter{R"({"op":"=","args":[1,[2]]})", "operands that are no lists"},
             BadFilter{R"({"op":"list","args":[]})", "there is no operator"},
             BadFilter{R"({"op":"T_AFTER","args":[1,2]})", "there is no operator"},
             BadFilter{R"({"property":1})", "a member property"},
             BadFilter{R"({"bbox":[1,2,"3",4]})", "4 or 6 numbers"},
             BadFilter{R"({"interval":["2026-01-01"]})", "a beginning and an end"},
             BadFilter{R"({"date":"2026-01-01T00:00:00Z"})", "a date without"},
             BadFilter{R"({"type":"Point","coordinates":["a",2]})", "a position"},
             BadFilter{R"({"type":"Circle","coordinates":[]})", "a geometry of GeoJSON"},
             BadFilter{"[[[", "is not JSON"},
             BadFilter{std::string(4000, '['), "more than 20 deep"},
             BadFilter{std::string(2000, '[') + std::string(2000, ']'), "more than 20 deep"},
         }) {
        try {
            holds(parse_cql2_json(text));
            ADD_FAILURE() << text;
        } catch (const Cql2Error& error) {
            EXPECT_THAT(error.what(), HasSubstr(words)) << text.substr(0, 80);
        }
    }
}

TEST(Cql2, MatchesPatterns) {
    EXPECT_TRUE(is_like("", ""));
    EXPECT_TRUE(is_like("", "%%"));
    EXPECT_FALSE(is_like("", "_"));
    EXPECT_TRUE(is_like("abcabd", "%ab_"));
    EXPECT_FALSE(is_like("abcabd", "ab_"));
    EXPECT_TRUE(is_like("Straße", "Stra_e"));
    EXPECT_TRUE(is_like("50%", "50\\%"));
    EXPECT_FALSE(is_like("500", "50\\%"));
    EXPECT_TRUE(is_like("a\\", "a\\\\"));
    EXPECT_TRUE(is_like("aXbXc", "a%b%c"));
    EXPECT_FALSE(is_like(std::string(4000, 'a'), std::string(100, '%') + "b")); // at once
}

} // namespace
} // namespace macadam::testing
