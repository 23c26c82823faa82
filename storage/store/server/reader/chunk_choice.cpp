#include "storage/store/server/reader/chunk_choice.hpp"

#include "mapping/geometry/antimeridian.hpp"
#include "mapping/geometry/area.hpp"
#include "storage/postgres/server_array.hpp"
#include "storage/store/server/server_schema.hpp"
#include "storage/text/case_folding.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>
#include <string>
#include <string_view>

namespace macadam {
namespace {

/// Text as an element of an array of PostgreSQL.
std::string quoted_element(std::string_view text) {
    std::string quoted = "\"";
    for (const char c : text) {
        quoted += c == '"' || c == '\\' ? std::string{'\\', c} : std::string(1, c);
    }
    return quoted + "\"";
}

/// Condition and parameters, built one by one.
class Conditions {
public:
    void add(const std::string& condition) { text_ += " AND " + condition; }

    /// \param condition  in which {} stands for the parameter
    void add(std::string_view condition, std::string value) {
        values_.emplace_back(std::move(value));
        add(fmt::format(fmt::runtime(condition), fmt::format("${}", values_.size())));
    }

    const std::string& text() const { return text_; }
    const std::vector<std::optional<std::string>>& values() const { return values_; }

private:
    std::string text_;
    std::vector<std::optional<std::string>> values_;
};

bool selects_by_passes(const SegmentFilter& filter) {
    return filter.period || filter.cars_alone || !filter.vehicle.empty();
}

std::optional<GeoBox> place_of(const SegmentFilter& filter) {
    return filter.box ? filter.box : filter.area ? std::optional{filter.area->box()} : std::nullopt;
}

/// Values of the states are those of the filter only if no passes are left out of them.
bool uses_states(const SegmentFilter& filter) {
    return filter.with_state_only && !selects_by_passes(filter);
}

/// Names of ways that contain the text in any case, by the rules of a file and not of the server.
std::string names_with(ServerConnection& server, const std::string& part) {
    const auto folded = case_folded(part);
    std::string names;
    for (const auto& row :
         server.rows("SELECT DISTINCT name FROM macadam.way WHERE name IS NOT NULL")) {
        if (case_folded(*row[0]).find(folded) != std::string::npos) {
            names += (names.empty() ? "" : ",") + quoted_element(*row[0]);
        }
    }
    return "{" + names + "}";
}

void add_place(Conditions& conditions, const GeoBox& place, const std::string& postgis) {
    std::string any;
    for (const auto& [west_deg, south_deg, east_deg, north_deg] : parts_on_globe(place)) {
        any += fmt::format("{0}segment.geom OPERATOR({1}.&&)"
                           " {1}.ST_MakeEnvelope({2}, {3}, {4}, {5}, 4326)",
                           any.empty() ? "" : " OR ",
                           postgis,
                           west_deg,
                           south_deg,
                           east_deg,
                           north_deg);
    }
    conditions.add("(" + any + ")");
}

Conditions conditions_of(ServerConnection& server, const SegmentFilter& filter) {
    Conditions conditions;
    if (const auto place = place_of(filter)) {
        add_place(conditions, *place, postgis_schema(server));
    }
    std::set<std::int64_t> ways;
    if (filter.key) {
        ways.insert(filter.key->way_id);
    }
    for (const auto& range : filter.ranges.value_or(std::vector<SegmentRange>{})) {
        ways.insert(range.way_id);
    }
    if (filter.key || filter.ranges) {
        const std::vector<std::int64_t> ids{ways.begin(), ways.end()};
        conditions.add("segment.way_id = ANY({}::bigint[])", array_of(ids));
    }
    if (filter.way_id) {
        conditions.add("segment.way_id = {}::bigint", std::to_string(*filter.way_id));
    }
    if (!filter.name_part.empty()) {
        conditions.add("segment.way_id IN (SELECT way_id FROM macadam.way WHERE name ="
                       " ANY({}::text[]))",
                       names_with(server, filter.name_part));
    }
    if (!filter.highway.empty()) {
        conditions.add("segment.way_id IN (SELECT way_id FROM macadam.way WHERE highway = {})",
                       filter.highway);
    }
    if (uses_states(filter)) {
        conditions.add(fmt::format("state.passes >= {}", filter.min_passes));
        conditions.add(fmt::format("state.vehicles >= {}", filter.min_vehicles));
        if (!filter.class_name.empty()) {
            conditions.add("state.class = {}", filter.class_name);
        }
    }
    return conditions;
}

/// All conditions are those of the filter, so that its worst segments are found here.
bool is_exact(const SegmentFilter& filter) {
    return !place_of(filter) && !filter.key && !filter.ranges && uses_states(filter);
}

} // namespace

bool chooses_chunks(const SegmentFilter& filter) {
    const bool by_values = !filter.class_name.empty() || filter.min_passes > 0 ||
                           filter.min_vehicles > 0 || (filter.worst > 0 && is_exact(filter));
    return place_of(filter) || filter.way_id || filter.key || filter.ranges ||
           !filter.name_part.empty() || !filter.highway.empty() ||
           (by_values && uses_states(filter));
}

std::vector<ServerChunk> chunks_for(ServerConnection& server, const SegmentFilter& filter) {
    const auto conditions = conditions_of(server, filter);
    auto found = fmt::format("SELECT segment.cell, segment.chunk FROM macadam.segment {} WHERE"
                             " true{}",
                             uses_states(filter) ? "JOIN macadam.segment_state AS state ON"
                                                   " state.cell = segment.cell"
                                                   " AND state.fid = segment.fid"
                                                 : "",
                             conditions.text());
    if (filter.worst > 0 && is_exact(filter)) {
        found += fmt::format(" ORDER BY state.iri_um DESC, segment.way_id,"
                             " segment.direction COLLATE \"C\" DESC, segment.seq LIMIT {}",
                             filter.worst);
    }
    const auto numbers = server.numbers(
        fmt::format("SELECT DISTINCT cell, chunk FROM ({}) AS found ORDER BY cell, chunk", found),
        conditions.values());
    std::vector<ServerChunk> chunks;
    for (std::size_t i = 0; i + 1 < numbers.size(); i += 2) {
        chunks.push_back({static_cast<std::int32_t>(numbers[i]), numbers[i + 1]});
    }
    return chunks;
}

} // namespace macadam
