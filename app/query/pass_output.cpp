#include "app/query/pass_output.hpp"

#include "app/cli/row_writer.hpp"
#include "storage/text/utc.hpp"

#include <fmt/format.h>

namespace macadam {
namespace {

using Row = HistoricPass;

Cell iri_of(const std::optional<IriUm>& um) {
    return um ? Cell{*um / 1000.0} : Cell{};
}

std::string when(const Row& row) {
    return row.utc_ms ? utc_text(*row.utc_ms / 1000 * 1000) : "undated"; // whole seconds
}

Cell utc_of(const Row& row) {
    return row.utc_ms ? Cell{utc_text(*row.utc_ms)} : Cell{};
}

std::string lag_words(const Row& row) {
    if (!row.lag_m) {
        return "-";
    }
    return row.finding == LagStatus::beyond_reach ? fmt::format(">{:g}", trace_margin_m)
                                                  : fmt::format("{:+.2f}", *row.lag_m);
}

Cell lag_finding(const Row& row) {
    if (!row.lag_m) {
        return {};
    }
    return row.finding == LagStatus::found          ? "found"
           : row.finding == LagStatus::beyond_reach ? "beyond_reach"
                                                    : "alone";
}

// clang-format off
const Columns<Row> columns{
    {"", as::text, when, {"when", "{:<22}"}},
    {"segment", as::text, [](auto& r) { return name_of(r.pass.segment); }},
    {"utc", as::text, utc_of},
    {"vehicle", as::text, [](auto& r) { return r.reference ? Cell{} : Cell{r.vehicle}; }},
    {"", as::text, [](auto& r) { return r.reference ? "reference" : r.vehicle; },
     {"vehicle", " {:<16}"}},
    {"reference", as::json_only(as::text), [](auto& r) { return r.reference; }},
    {"iri", as::iri(3), [](auto& r) { return iri_of(r.pass.iri_um); }, {"IRI", " {:>6}", 2}},
    {"iri_sd", as::iri(3), [](auto& r) { return iri_of(r.pass.sd_um); }, {"sd", " {:>6}", 2}},
    {"iri_left", as::iri(3), [](auto& r) { return iri_of(r.pass.iri_left_um); }},
    {"iri_right", as::iri(3), [](auto& r) { return iri_of(r.pass.iri_right_um); }},
    {"hri", as::iri(3), [](auto& r) { return iri_of(r.pass.iri_centre_um); }},
    {"", as::numbers_in("m"), lag_words, {"lag m", " {:>6}"}},
    {"speed_mps", as::real(3, "m/s"), [](auto& r) { return r.pass.speed_mmps / 1000.0; }},
    {"", as::real(1, "km/h"), [](auto& r) { return r.pass.speed_mmps * 3.6e-3; },
     {"km/h", " {:>7}"}},
    {"covered_m", as::metres(3), [](auto& r) { return r.pass.covered_mm / 1000.0; }},
    {"lag_m", as::metres(2), [](auto& r) { return r.lag_m; }},
    {"lag_finding", as::text, lag_finding},
    {"confidence", as::real(3), [](auto& r) { return r.pass.confidence_ppm / 1e6; },
     {"confidence", " {:>10}", 2}},
    {"validity", as::text, [](auto& r) { return name_of_validity(r.pass.validity); }},
    {"trip", as::text, [](auto& r) { return r.trip_sha256; }},
    {"", as::text, [](auto& r) { return r.reference.value_or(r.trip_sha256.substr(0, 12)); },
     {"trip", "  {}"}},
    {"reference", as::csv_only(as::text), [](auto& r) { return r.reference; }},
};
// clang-format on

} // namespace

std::string
passes_text(const std::vector<HistoricPass>& passes, std::string_view format, UnitSystem units) {
    return rows_text(in_units(columns, units), passes, format);
}

} // namespace macadam
