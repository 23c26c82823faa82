#include "app/serve/filters/cql2_wkt.hpp"

#include "app/serve/filters/cql2_literals.hpp"
#include "estimator/common/ascii.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

namespace macadam {
namespace {

using Kind = Cql2Geometry::Kind;

constexpr std::array<std::pair<std::string_view, Kind>, 9> kinds{{
    {"point", Kind::point},
    {"linestring", Kind::line},
    {"polygon", Kind::polygon},
    {"multipoint", Kind::multi_point},
    {"multilinestring", Kind::multi_line},
    {"multipolygon", Kind::multi_polygon},
    {"geometrycollection", Kind::collection},
    {"bbox", Kind::box},
    {"envelope", Kind::box},
}};

const std::pair<std::string_view, Kind>* kind_of(std::string_view word) {
    const auto lower = in_lower_case(word);
    const auto* const found =
        std::ranges::find(kinds, lower, [](const auto& kind) { return kind.first; });
    return found == kinds.end() ? nullptr : found;
}

double expected_number(Cql2Words& words) {
    const auto number = words.number();
    if (!number) {
        words.refuse("a number");
    }
    return *number;
}

std::pair<double, double> position(Cql2Words& words) {
    const double first = expected_number(words);
    const double second = expected_number(words);
    words.number(); // a height says nothing of roads
    return {first, second};
}

/// Elements in brackets with commas.
template <typename Element>
auto list_of(Cql2Words& words, const Element& element) {
    std::vector<decltype(element())> elements;
    words.expect("(");
    do {
        elements.push_back(element());
    } while (words.take(","));
    words.expect(")");
    return elements;
}

Cql2Line line(Cql2Words& words) {
    return list_of(words, [&] { return position(words); });
}

/// Points of a multipoint stand in brackets of their own, or not.
Cql2Line point(Cql2Words& words) {
    return words.is_at('(') ? line(words) : Cql2Line{position(words)};
}

Cql2Line corners(Cql2Words& words) {
    const auto numbers = list_of(words, [&] { return expected_number(words); });
    constexpr std::size_t flat = 4, high = 6;
    if (numbers.size() != flat && numbers.size() != high) {
        throw Cql2Error{"BBOX is not of 4 or 6 numbers"};
    }
    const auto half = numbers.size() / 2;
    return {{numbers[0], numbers[1]}, {numbers[half], numbers[half + 1]}};
}

Cql2Geometry collected(Cql2Words& words) {
    const auto word = words.name();
    const auto* const kind = kind_of(word);
    if (kind == nullptr || kind->second == Kind::collection || kind->second == Kind::box) {
        words.refuse("a geometry such as POINT", word); // collections do not nest: depth is bounded
    }
    return parse_cql2_wkt(word, words);
}

} // namespace

bool is_cql2_geometry(std::string_view word) {
    return kind_of(word) != nullptr;
}

Cql2Geometry parse_cql2_wkt(std::string_view word, Cql2Words& words) {
    Cql2Geometry geometry{.kind = kind_of(word)->second};
    words.take_word("z");
    switch (geometry.kind) {
    case Kind::point:
    case Kind::line:
        geometry.lines = {line(words)};
        break;
    case Kind::polygon:
    case Kind::multi_line:
        geometry.lines = list_of(words, [&] { return line(words); });
        break;
    case Kind::multi_point:
        geometry.lines = list_of(words, [&] { return point(words); });
        break;
    case Kind::multi_polygon:
        geometry.parts = list_of(words, [&] {
            return Cql2Geometry{.kind = Kind::polygon,
                                .lines = list_of(words, [&] { return line(words); })};
        });
        break;
    case Kind::collection:
        geometry.parts = list_of(words, [&] { return collected(words); });
        break;
    case Kind::box:
        geometry.lines = {corners(words)};
        break;
    }
    expect_whole(geometry);
    return geometry;
}

} // namespace macadam
