#pragma once

#include "app/serve/filters/cql2_expression.hpp"

#include <compare>
#include <optional>
#include <string_view>

namespace macadam {

/// Instant, or interval with ends that may be open.
struct Cql2Span {
    std::optional<Cql2Instant> begin, end;
};

/// Compares instants; where one is a date, by their days.
std::weak_ordering compare(const Cql2Instant& a, const Cql2Instant& b);

using TimeRelation = bool (*)(const Cql2Span& a, const Cql2Span& b);

/// Relation of a temporal function, "t_after"; null for another name. Instants are intervals of
/// which both ends are the same.
///
/// Source: OGC 21-065r2, 7.4 (temporal functions).
TimeRelation time_relation(std::string_view function);

} // namespace macadam
