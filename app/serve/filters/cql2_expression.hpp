#pragma once

#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace macadam {

/// Limits of a filter, so that none is slow to read or to apply.
inline constexpr std::size_t max_cql2_bytes = 4096;
inline constexpr int max_cql2_depth = 20; ///< of operators, functions and brackets in one another

/// Filter that cannot be read; the words are for the client.
struct Cql2Error : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Name of a property of features.
struct Cql2Property {
    std::string name;
    friend bool operator==(const Cql2Property&, const Cql2Property&) = default;
};

/// Date, or time in UTC. Dates compare with times by the day.
struct Cql2Instant {
    std::int64_t ms; ///< since 1970; of a date its beginning
    bool is_day;
    friend bool operator==(const Cql2Instant&, const Cql2Instant&) = default;
};

/// End of an interval: open, an instant, or a property.
using Cql2Border = std::variant<std::monostate, Cql2Instant, Cql2Property>;

struct Cql2Interval {
    Cql2Border begin, end;
    friend bool operator==(const Cql2Interval&, const Cql2Interval&) = default;
};

/// Coordinates as given, in the order of the axes of the filter's coordinate reference system.
using Cql2Line = std::vector<std::pair<double, double>>;

/// Geometry. Points, and the points of a multipoint, are lines of one position.
struct Cql2Geometry {
    enum class Kind {
        point,
        line,
        polygon,
        multi_point,
        multi_line,
        multi_polygon,
        collection,
        box, ///< one line: its corners of least and greatest coordinates
    };
    Kind kind = Kind::point;
    std::vector<Cql2Line> lines{};
    std::vector<Cql2Geometry> parts{}; ///< of multi_polygon and collection
    friend bool operator==(const Cql2Geometry&, const Cql2Geometry&) = default;
};

/// Expression as a tree, the same from CQL2 text and JSON.
struct Cql2Expression {
    using Literal = std::
        variant<bool, double, std::string, Cql2Property, Cql2Instant, Cql2Interval, Cql2Geometry>;

    /// Operator as CQL2 JSON names it: "and", "<=", "isNull", "s_intersects"; "list" for the
    /// values of "in"; "" for a literal.
    std::string op{};
    std::vector<Cql2Expression> args{};
    Literal literal{};
    friend bool operator==(const Cql2Expression&, const Cql2Expression&) = default;
};

} // namespace macadam
