#include "app/query/audit_output.hpp"

#include "app/cli/row_writer.hpp"

#include <fmt/format.h>

namespace macadam {
namespace {

/// Removes the fraction of a time such as "2026-03-01T06:00:00.000Z".
std::string second_of(const std::string& at) {
    return at.size() > 20 ? at.substr(0, 19) + "Z" : at;
}

std::string words_of(const AuditEntry& entry) {
    return fmt::format("{}: {}", entry.what, entry.detail);
}

Cell segments_of(const AuditEntry& entry) {
    return entry.segments ? Cell{static_cast<std::int64_t>(*entry.segments)} : Cell{};
}

Cell iri_of(const NumberChange& change) {
    return change.iri_um ? Cell{*change.iri_um / 1000.0} : Cell{};
}

Cell sd_of(const NumberChange& change) {
    return change.iri_um ? Cell{change.sd_um.value_or(0) / 1000.0} : Cell{};
}

// clang-format off
const Columns<AuditEntry> entry_columns{
    {"", as::text, [](auto& r) { return second_of(r.at); }, {"when", "{:<21}"}},
    {"at", as::text, [](auto& r) { return r.at; }},
    {"generation", as::integer, [](auto& r) { return r.generation; }, {"gen", " {:>3}"}},
    {"what", as::text, [](auto& r) { return r.what; }},
    {"detail", as::text, [](auto& r) { return r.detail; }},
    {"segments", as::integer, segments_of, {"segments", " {:>9}"}},
    {"", as::text, words_of, {"operation", "  {}"}},
};

const Columns<NumberChange> change_columns{
    {"", as::text, [](auto& r) { return second_of(r.cause.at); }, {"when", "{:<21}"}},
    {"at", as::text, [](auto& r) { return r.cause.at; }},
    {"generation", as::integer, [](auto& r) { return r.cause.generation; }, {"gen", " {:>3}"}},
    {"what", as::json_only(as::text), [](auto& r) { return r.cause.what; }},
    {"detail", as::json_only(as::text), [](auto& r) { return r.cause.detail; }},
    {"iri", as::iri(3), iri_of, {"IRI", " {:>7}"}},
    {"iri_sd", as::iri(3), sd_of, {"sd", " {:>7}"}},
    {"passes", as::integer, [](auto& r) { return r.passes; }, {"passes", " {:>6}"}},
    {"what", as::csv_only(as::text), [](auto& r) { return r.cause.what; }},
    {"detail", as::csv_only(as::text), [](auto& r) { return r.cause.detail; }},
    {"", as::text, [](auto& r) { return words_of(r.cause); }, {"why", "  {}"}},
};
// clang-format on

} // namespace

std::string audit_text(const std::vector<AuditEntry>& entries, std::string_view format) {
    return entries.empty() && format == "table" ? "no recorded change of any value\n"
                                                : rows_text(entry_columns, entries, format);
}

std::string
changes_text(const std::vector<NumberChange>& changes, std::string_view format, UnitSystem units) {
    return changes.empty() && format == "table"
               ? "no recorded change of this segment's value\n"
               : rows_text(in_units(change_columns, units), changes, format);
}

} // namespace macadam
