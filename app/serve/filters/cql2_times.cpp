#include "app/serve/filters/cql2_times.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

namespace macadam {
namespace {

constexpr std::int64_t day_ms = 86'400'000;

std::int64_t day_of(const Cql2Instant& instant) {
    const auto day = instant.ms / day_ms;
    return instant.ms % day_ms < 0 ? day - 1 : day;
}

using Order = std::weak_ordering;

// Ends that are open lie before or after everything, and at the same place.

Order begins(const Cql2Span& a, const Cql2Span& b) {
    return a.begin && b.begin ? compare(*a.begin, *b.begin)
                              : Order{a.begin.has_value() <=> b.begin.has_value()};
}

Order ends(const Cql2Span& a, const Cql2Span& b) {
    return a.end && b.end ? compare(*a.end, *b.end)
                          : Order{b.end.has_value() <=> a.end.has_value()};
}

/// Order of the end of one and the beginning of another.
Order end_to_begin(const Cql2Span& a, const Cql2Span& b) {
    return a.end && b.begin ? compare(*a.end, *b.begin) : Order::greater;
}

bool is_disjoint(const Cql2Span& a, const Cql2Span& b) {
    return end_to_begin(a, b) < 0 || end_to_begin(b, a) < 0;
}

using Span = const Cql2Span&;

constexpr std::array<std::pair<std::string_view, TimeRelation>, 15> relations{{
    {"t_after", [](Span a, Span b) { return end_to_begin(b, a) < 0; }},
    {"t_before", [](Span a, Span b) { return end_to_begin(a, b) < 0; }},
    {"t_contains", [](Span a, Span b) { return begins(a, b) < 0 && ends(a, b) > 0; }},
    {"t_disjoint", is_disjoint},
    {"t_during", [](Span a, Span b) { return begins(a, b) > 0 && ends(a, b) < 0; }},
    {"t_equals", [](Span a, Span b) { return begins(a, b) == 0 && ends(a, b) == 0; }},
    {"t_finishedBy", [](Span a, Span b) { return begins(a, b) < 0 && ends(a, b) == 0; }},
    {"t_finishes", [](Span a, Span b) { return begins(a, b) > 0 && ends(a, b) == 0; }},
    {"t_intersects", [](Span a, Span b) { return !is_disjoint(a, b); }},
    {"t_meets", [](Span a, Span b) { return end_to_begin(a, b) == 0; }},
    {"t_metBy", [](Span a, Span b) { return end_to_begin(b, a) == 0; }},
    {"t_overlappedBy",
     [](Span a, Span b) { return begins(a, b) > 0 && end_to_begin(b, a) > 0 && ends(a, b) > 0; }},
    {"t_overlaps",
     [](Span a, Span b) { return begins(a, b) < 0 && end_to_begin(a, b) > 0 && ends(a, b) < 0; }},
    {"t_startedBy", [](Span a, Span b) { return begins(a, b) == 0 && ends(a, b) > 0; }},
    {"t_starts", [](Span a, Span b) { return begins(a, b) == 0 && ends(a, b) < 0; }},
}};

} // namespace

std::weak_ordering compare(const Cql2Instant& a, const Cql2Instant& b) {
    return a.is_day || b.is_day ? day_of(a) <=> day_of(b) : a.ms <=> b.ms;
}

TimeRelation time_relation(std::string_view function) {
    const auto* const found =
        std::ranges::find(relations, function, [](const auto& relation) { return relation.first; });
    return found == relations.end() ? nullptr : found->second;
}

} // namespace macadam
