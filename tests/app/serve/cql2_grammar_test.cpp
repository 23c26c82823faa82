// Every production of the grammar of CQL2 (OGC 21-065r2, annex B) in forms of our own, asked of the
// columns of segments: those of the conformance classes that the server states are read, the others
// refused in words.

#include "app/serve/filters/cql2_text.hpp"
#include "app/serve/filters/feature_filter.hpp"
#include "storage/exports/export.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>
#include <string_view>
#include <vector>

namespace macadam::testing {
namespace {

struct Form {
    std::string_view production;
    std::string_view text;
};

// clang-format off
constexpr std::array read{
    Form{"booleanExpression", "iri > 4 AND passes > 2 OR name = 'a'"},
    Form{"booleanExpression", "TRUE"},
    Form{"andExpression", "iri > 4 AND passes > 2"},
    Form{"andExpression", "iri > 4 and passes > 2 And vehicles > 1"},
    Form{"orExpression", "iri > 4 OR passes > 2"},
    Form{"orExpression", "iri > 4 OR passes > 2 OR vehicles > 1"},
    Form{"notExpression", "NOT iri > 4"},
    Form{"notExpression", "NOT (iri > 4 OR passes > 2)"},
    Form{"notExpression", "iri > 4 AND NOT passes > 2"},
    Form{"subExpression", "(iri > 4)"},
    Form{"subExpression", "((iri > 4) AND (passes > 2))"},
    Form{"comparisonPredicate", "iri = 4"},
    Form{"binaryComparisonPredicate", "4 < iri"},
    Form{"binaryComparisonPredicate", "iri < iri_high"},
    Form{"binaryComparisonPredicate", "name = highway"},
    Form{"scalarExpression", "name = 'Ring'"},
    Form{"scalarExpression", "last_seen > DATE('2026-01-01')"},
    Form{"scalarExpression", "passes = 3"},
    Form{"temporalInstantExpression", "first_seen <= last_seen"},
    Form{"temporalInstantExpression", "last_seen > TIMESTAMP('2026-01-01T00:00:00Z')"},
    Form{"comparisonOperator", "passes = 3"},
    Form{"comparisonOperator", "passes <> 3"},
    Form{"comparisonOperator", "passes < 3"},
    Form{"comparisonOperator", "passes > 3"},
    Form{"comparisonOperator", "passes <= 3"},
    Form{"comparisonOperator", "passes >= 3"},
    Form{"neq", "name <> 'Ring'"},
    Form{"gteq", "iri>=4"},
    Form{"lteq", "iri<=4"},
    Form{"isLikePredicate", "name LIKE 'Ring%'"},
    Form{"isLikePredicate", "name NOT LIKE '_ing'"},
    Form{"patternExpression", "name LIKE '%\\%%'"},
    Form{"patternExpression", "CASEI(name) LIKE CASEI('RING%')"},
    Form{"isBetweenPredicate", "iri BETWEEN 2 AND 4"},
    Form{"isBetweenPredicate", "iri NOT BETWEEN iri_low AND iri_high"},
    Form{"isBetweenPredicate", "iri BETWEEN 1 + 1 AND 2 * 2 AND passes > 1"},
    Form{"numericExpression", "iri * 2 > 8"},
    Form{"isInListPredicate", "class IN ('poor', 'very poor')"},
    Form{"isInListPredicate", "passes NOT IN (1, 2)"},
    Form{"isInListPredicate", "last_seen IN (DATE('2026-05-01'), DATE('2026-05-02'))"},
    Form{"inList", "passes IN (1)"},
    Form{"inList", "passes IN (1, 1 + 1, 3, vehicles)"},
    Form{"isNullPredicate", "name IS NULL"},
    Form{"isNullPredicate", "name IS NOT NULL"},
    Form{"isNullOperand", "iri IS NULL"},
    Form{"isNullOperand", "last_seen IS NOT NULL"},
    Form{"isNullOperand", "geometry IS NULL"},
    Form{"spatialPredicate", "S_INTERSECTS(geometry, POINT(16 48))"},
    Form{"spatialPredicate", "s_intersects(POINT(16 48), geometry)"},
    Form{"spatialOperator", "S_EQUALS(geometry, LINESTRING(16 48, 17 48))"},
    Form{"spatialOperator", "S_DISJOINT(geometry, POINT(16 48))"},
    Form{"spatialOperator", "S_TOUCHES(geometry, POINT(16 48))"},
    Form{"spatialOperator", "S_WITHIN(geometry, BBOX(15, 47, 17, 49))"},
    Form{"spatialOperator", "S_OVERLAPS(geometry, LINESTRING(16 48, 17 48))"},
    Form{"spatialOperator", "S_CROSSES(geometry, LINESTRING(16 48, 17 48))"},
    Form{"spatialOperator", "S_CONTAINS(geometry, POINT(16 48))"},
    Form{"geomExpression", "S_INTERSECTS(geometry, geometry)"},
    Form{"geomExpression", "S_INTERSECTS(\"geometry\", BBOX(15, 47, 17, 49))"},
    Form{"temporalPredicate", "T_AFTER(last_seen, DATE('2026-01-01'))"},
    Form{"temporalExpression", "T_EQUALS(first_seen, last_seen)"},
    Form{"temporalExpression", "T_DURING(last_seen, INTERVAL('2026-01-01', '2026-12-31'))"},
    Form{"temporalOperator", "T_BEFORE(last_seen, DATE('2026-01-01'))"},
    Form{"temporalOperator", "T_CONTAINS(INTERVAL(first_seen, last_seen), INTERVAL('2026-02-01', '2026-03-01'))"},
    Form{"temporalOperator", "T_DISJOINT(INTERVAL(first_seen, last_seen), INTERVAL('2026-02-01', '..'))"},
    Form{"temporalOperator", "T_FINISHEDBY(INTERVAL(first_seen, last_seen), INTERVAL('2026-02-01', '2026-03-01'))"},
    Form{"temporalOperator", "T_FINISHES(INTERVAL(first_seen, last_seen), INTERVAL('2026-02-01', '2026-03-01'))"},
    Form{"temporalOperator", "T_INTERSECTS(INTERVAL(first_seen, last_seen), INTERVAL('..', '2026-03-01'))"},
    Form{"temporalOperator", "T_MEETS(INTERVAL(first_seen, last_seen), INTERVAL('2026-02-01', '2026-03-01'))"},
    Form{"temporalOperator", "T_METBY(INTERVAL(first_seen, last_seen), INTERVAL('2026-02-01', '2026-03-01'))"},
    Form{"temporalOperator", "T_OVERLAPPEDBY(INTERVAL(first_seen, last_seen), INTERVAL('2026-02-01', '2026-03-01'))"},
    Form{"temporalOperator", "T_OVERLAPS(INTERVAL(first_seen, last_seen), INTERVAL('2026-02-01', '2026-03-01'))"},
    Form{"temporalOperator", "T_STARTEDBY(INTERVAL(first_seen, last_seen), INTERVAL('2026-02-01', '2026-03-01'))"},
    Form{"temporalOperator", "T_STARTS(INTERVAL(first_seen, last_seen), INTERVAL('2026-02-01', '2026-03-01'))"},
    Form{"arithmeticExpression", "iri + 1 - 2 > passes"},
    Form{"arithmeticTerm", "iri * 2 / 3 > 1"},
    Form{"arithmeticTerm", "passes % 2 = passes DIV 3"},
    Form{"powerTerm", "iri ^ 2 > 4"},
    Form{"powerTerm", "2 ^ 2 ^ 2 > iri"},
    Form{"arithmeticFactor", "(iri + 1) * 2 > 4"},
    Form{"arithmeticOperand", "iri > +1"},
    Form{"propertyName", "\"iri\" > 1"},
    Form{"identifier", "iri_high > 1"},
    Form{"identifierPart", "iri_low > 1"},
    Form{"identifierStart", "name = 'a'"},
    Form{"characterExpression", "CASEI(name) = CASEI('RING')"},
    Form{"characterClause", "name = 'Ring'"},
    Form{"characterLiteral", "name = ''"},
    Form{"characterLiteral", "name = 'Straße 東京'"},
    Form{"character", "name = 'a b.c-d/e'"},
    Form{"escapeQuote", "name = 'O''Neil'"},
    Form{"escapeQuote", "name = 'O\\'Neil'"},
    Form{"numericLiteral", "iri > 4"},
    Form{"numericLiteral", "iri > -4.5"},
    Form{"decimalNumericLiteral", "iri > 4.25"},
    Form{"decimalNumericLiteral", "iri > .25"},
    Form{"scientificNumericLiteral", "iri > 4.0E0"},
    Form{"scientificNumericLiteral", "iri > 4e-1"},
    Form{"booleanLiteral", "false OR iri > 4"},
    Form{"spatialInstance", "S_INTERSECTS(geometry, POINT(16 48))"},
    Form{"geometryLiteral", "S_INTERSECTS(geometry, LINESTRING(16 48, 17 49))"},
    Form{"pointTaggedText", "S_INTERSECTS(geometry, POINT Z (16 48 200))"},
    Form{"linestringTaggedText", "S_INTERSECTS(geometry, LINESTRING Z (16 48 1, 17 49 2))"},
    Form{"polygonTaggedText", "S_INTERSECTS(geometry, POLYGON((16 48, 17 48, 17 49, 16 48)))"},
    Form{"polygonTaggedText", "S_INTERSECTS(geometry, POLYGON((10 40, 20 40, 20 50, 10 40), (15 43, 16 43, 16 44, 15 43)))"},
    Form{"multipointTaggedText", "S_INTERSECTS(geometry, MULTIPOINT((16 48), (17 49)))"},
    Form{"multilinestringTaggedText", "S_INTERSECTS(geometry, MULTILINESTRING((16 48, 17 49), (15 48, 15 49)))"},
    Form{"multipolygonTaggedText", "S_INTERSECTS(geometry, MULTIPOLYGON(((16 48, 17 48, 17 49, 16 48)), ((1 1, 2 1, 2 2, 1 1))))"},
    Form{"geometryCollectionTaggedText", "S_INTERSECTS(geometry, GEOMETRYCOLLECTION(POINT(16 48), LINESTRING(16 48, 17 49)))"},
    Form{"bboxTaggedText", "S_INTERSECTS(geometry, BBOX(16, 48, 17, 49))"},
    Form{"bboxTaggedText", "S_INTERSECTS(geometry, BBOX(16, 48, 0, 17, 49, 900))"},
    Form{"temporalInstance", "last_seen = DATE('2026-05-01')"},
    Form{"instantInstance", "T_AFTER(last_seen, TIMESTAMP('2026-05-01T10:00:00.5Z'))"},
    Form{"dateInstant", "last_seen = DATE('2024-02-29')"},
    Form{"timestampInstant", "last_seen < TIMESTAMP('2026-05-01T23:59:59Z')"},
    Form{"intervalInstance", "T_INTERSECTS(last_seen, INTERVAL('2026-05-01', '2026-05-31'))"},
    Form{"intervalInstance", "T_INTERSECTS(last_seen, INTERVAL('2026-05-01T00:00:00Z', '..'))"},
    Form{"instantParameter", "T_INTERSECTS(DATE('2026-05-01'), INTERVAL(first_seen, '..'))"},
};

constexpr std::array refused{
    Form{"arrayPredicate", "A_CONTAINS(name, ['a', 'b'])"},
    Form{"arrayExpression", "A_EQUALS(['a'], ['a'])"},
    Form{"arrayLiteral", "A_OVERLAPS(name, [])"},
    Form{"arrayElement", "A_CONTAINEDBY([1, 2], [1])"},
    Form{"arrayOperator", "A_OVERLAPS(name, name)"},
    Form{"function", "length(name) > 3"},
    Form{"argumentList", "min(iri, passes) > 3"},
    Form{"argument", "now() > last_seen"},
    Form{"characterExpression", "ACCENTI(name) = ACCENTI('Straße')"},
    Form{"patternExpression", "ACCENTI(name) LIKE ACCENTI('a%')"},
};

constexpr std::array productions = std::to_array<std::string_view>({
    "booleanExpression", "andExpression", "orExpression", "notExpression", "subExpression", "comparisonPredicate",
    "binaryComparisonPredicate", "scalarExpression", "temporalInstantExpression", "comparisonOperator", "neq", "gteq", "lteq",
    "isLikePredicate", "patternExpression", "isBetweenPredicate", "numericExpression", "isInListPredicate", "inList", "isNullPredicate",
    "isNullOperand", "spatialPredicate", "spatialOperator", "geomExpression", "temporalPredicate", "temporalExpression",
    "temporalOperator", "arrayPredicate", "arrayExpression", "arrayLiteral", "arrayElement", "arrayOperator", "arithmeticExpression",
    "arithmeticTerm", "powerTerm", "arithmeticFactor", "arithmeticOperand", "propertyName", "identifier", "identifierPart",
    "identifierStart", "function", "argumentList", "argument", "characterExpression", "characterClause", "characterLiteral", "character",
    "escapeQuote", "numericLiteral", "decimalNumericLiteral", "scientificNumericLiteral", "booleanLiteral", "spatialInstance",
    "geometryLiteral", "pointTaggedText", "linestringTaggedText", "polygonTaggedText", "multipointTaggedText",
    "multilinestringTaggedText", "multipolygonTaggedText", "geometryCollectionTaggedText", "bboxTaggedText", "temporalInstance",
    "instantInstance", "dateInstant", "timestampInstant", "intervalInstance", "instantParameter"});
// clang-format on

const std::vector<FeatureColumn>& columns() {
    static const auto of_segments = feature_columns(segment_columns());
    return of_segments;
}

TEST(Cql2Grammar, IsReadInEveryFormOfTheStatedClasses) {
    EXPECT_GE(read.size(), 100U);
    for (const auto& [production, text] : read) {
        EXPECT_NO_THROW({
            feature_filter(parse_cql2_text(text), columns(), CoordinateReference::crs84);
        }) << production
           << ": " << text;
    }
}

TEST(Cql2Grammar, RefusesInWordsWhatIsOfOtherClasses) {
    for (const auto& [production, text] : refused) {
        try {
            feature_filter(parse_cql2_text(text), columns(), CoordinateReference::crs84);
            ADD_FAILURE() << production << ": " << text;
        } catch (const Cql2Error& error) {
            EXPECT_GT(std::string_view{error.what()}.size(), 10U) << text;
        }
    }
}

TEST(Cql2Grammar, HasAFormForEveryProduction) {
    std::set<std::string_view> covered;
    for (const auto& form : read) {
        covered.insert(form.production);
    }
    for (const auto& form : refused) {
        covered.insert(form.production);
    }
    for (const auto production : productions) {
        EXPECT_TRUE(covered.contains(production)) << production;
    }
    for (const auto production : covered) {
        EXPECT_NE(std::ranges::find(productions, production), productions.end()) << production;
    }
}

} // namespace
} // namespace macadam::testing
