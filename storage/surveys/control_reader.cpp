#include "storage/surveys/control_reader.hpp"

#include "estimator/common/error.hpp"
#include "storage/tables/csv_table.hpp"
#include "storage/tables/csv_values.hpp"
#include "storage/text/text.hpp"
#include "storage/text/utc.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>
#include <string_view>
#include <tuple>

namespace macadam {
namespace {

constexpr std::array<std::string_view, 6> needed{
    "name", "way_id", "direction", "from_m", "to_m", "iri"};
constexpr double longest_way_m = 5e6;
constexpr double end_slack_m = 1; // of a way: rounding of its length in tables

double whole_mm(double metres) {
    return std::round(metres * 1000) / 1000;
}

void expect_columns(const CsvTable& table) {
    for (const auto column : needed) {
        if (!table.has(column)) {
            throw InputError{fmt::format("{}: the header has no column {}, expected name, way_id, "
                                         "direction, from_m, to_m and iri",
                                         table.where,
                                         column)};
        }
    }
}

template <typename Value>
Value known(const std::optional<Value>& value, const CsvRow& row, std::string_view column) {
    if (!value) {
        throw InputError{fmt::format("{}: {} is empty, expected a value", row.where(), column)};
    }
    return *value;
}

std::optional<std::int64_t> date_in(const CsvRow& row) {
    const auto text = row.text("date");
    if (text.empty()) {
        return std::nullopt;
    }
    const auto utc_s = parse_utc_s(text + "T00:00:00Z");
    if (!utc_s) {
        throw InputError{fmt::format(
            "{}: date is {}, expected a day such as 2026-03-01", row.where(), in_quotes(text))};
    }
    return std::llround(*utc_s * 1000);
}

/// Section as stated in the row, without a check against the network.
ControlSection section_in(const CsvRow& row, double mm_per_m_of_one) {
    ControlSection section{.name = row.text("name"),
                           .way_id = known(row.whole("way_id"), row, "way_id"),
                           .forward = known(direction_in(row), row, "direction"),
                           .from_m = 0,
                           .to_m = 0,
                           .iri_mm_per_m = known(iri_in(row, "iri", mm_per_m_of_one), row, "iri"),
                           .sd_mm_per_m = 0,
                           .utc_ms = date_in(row)};
    if (section.name.empty()) {
        throw InputError{fmt::format("{}: name is empty, expected a value", row.where())};
    }
    const auto station_m = [&](std::string_view column) {
        return whole_mm(known(
            row.number(column, 0, longest_way_m, "metres along the way, 0 or more"), row, column));
    };
    std::tie(section.from_m, section.to_m) = std::minmax({station_m("from_m"), station_m("to_m")});
    section.sd_mm_per_m = iri_in(row, "iri_sd", mm_per_m_of_one)
                              .value_or(usual_control_relative_sd * section.iri_mm_per_m);
    if (section.from_m >= section.to_m) {
        throw InputError{fmt::format(
            "{}: begins and ends at the same station, expected a length above 0", row.where())};
    }
    return section;
}

void expect_on_network(const ControlSection& section, const CsvRow& row, const RoadNetwork& roads) {
    const auto ways = roads.ways.first(way_count(roads));
    const auto found = std::ranges::lower_bound(ways, section.way_id, {}, &PackedWay::id);
    if (found == ways.end() || found->id != section.way_id) {
        throw InputError{
            fmt::format("{}: the database has no way '{}'", row.where(), section.way_id)};
    }
    const auto way = way_at(roads, static_cast<std::uint32_t>(found - ways.begin()));
    const double whole_m = link_at(roads, LinkId{way.past_link - 1}).to_m;
    if (section.to_m > whole_m + end_slack_m) {
        throw InputError{fmt::format("{}: extends from {:g} to {:g} m, expected a part of the "
                                     "way, which is {:.1f} m long",
                                     row.where(),
                                     section.from_m,
                                     section.to_m,
                                     whole_m)};
    }
    for (auto i = way.first_link; i < way.past_link; ++i) {
        const auto link = link_at(roads, LinkId{i});
        const bool touched = link.from_m < section.to_m && section.from_m < link.to_m;
        if (touched && !is_drivable(roads, edge_of(LinkId{i}, section.forward))) {
            throw InputError{fmt::format("{}: direction is '{}', which may not be driven there",
                                         row.where(),
                                         section.forward ? "forward" : "backward")};
        }
    }
}

} // namespace

std::vector<ControlSection> read_control_sections(const std::filesystem::path& file,
                                                  const RoadNetwork& roads,
                                                  double mm_per_m_of_one) {
    const auto table = read_csv_table(file);
    expect_columns(table);
    std::vector<ControlSection> sections;
    std::set<std::string> names;
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
        const auto row = table.row(i);
        sections.push_back(section_in(row, mm_per_m_of_one));
        expect_on_network(sections.back(), row, roads);
        if (!names.insert(sections.back().name).second) {
            throw InputError{fmt::format("{}: section {} occurs twice, expected once",
                                         row.where(),
                                         in_quotes(sections.back().name))};
        }
    }
    if (sections.empty()) {
        throw InputError{fmt::format("{}: has no rows, expected at least one", file.string())};
    }
    return sections;
}

} // namespace macadam
