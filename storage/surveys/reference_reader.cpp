#include "storage/surveys/reference_reader.hpp"

#include "estimator/common/error.hpp"
#include "storage/tables/csv_table.hpp"
#include "storage/tables/csv_values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <string_view>

namespace macadam {
namespace {

constexpr double shortest_row_m = 0.1; // surveys have 10 to 100 m
constexpr double longest_row_m = 2000;
constexpr double far_m = 1e9;

bool has_all(const CsvTable& table, std::initializer_list<std::string_view> columns) {
    return std::ranges::all_of(columns, [&](std::string_view name) { return table.has(name); });
}

ReferenceLocation places_of(const CsvTable& table) {
    if (has_all(table, {"way_id", "from_m", "to_m"})) {
        return ReferenceLocation::on_ways;
    }
    if (has_all(table, {"begin_lat_deg", "begin_lon_deg", "end_lat_deg", "end_lon_deg"})) {
        return ReferenceLocation::ends;
    }
    if (has_all(table, {"lat_deg", "lon_deg"})) {
        return ReferenceLocation::middles;
    }
    throw InputError{fmt::format(
        "{}: the header does not locate its rows, expected way_id, from_m and to_m; or "
        "begin_lat_deg, begin_lon_deg, end_lat_deg and end_lon_deg; or lat_deg and lon_deg",
        table.where)};
}

void expect_iri(const CsvTable& table) {
    const bool tracks = has_all(table, {"iri_left", "iri_right"});
    if (!tracks && !table.has("mri") && !table.has("iri") && !table.has("hri")) {
        throw InputError{fmt::format("{}: the header has no IRI of both tracks, expected mri, iri, "
                                     "hri, or iri_left and iri_right",
                                     table.where)};
    }
}

void expect_length(const CsvTable& table) {
    if (table.has("heading_deg") && !table.has("length_m") && !has_all(table, {"from_m", "to_m"})) {
        throw InputError{fmt::format("{}: the header has heading_deg but no length of the rows, "
                                     "expected length_m, or from_m and to_m",
                                     table.where)};
    }
}

/// Length of a row, from whichever columns state it.
std::optional<double> row_length_m(const CsvRow& row) {
    if (const auto length_m =
            row.number("length_m", shortest_row_m, longest_row_m, "0.1 to 2000 m")) {
        return length_m;
    }
    const auto from_m = row.number("from_m", -far_m, far_m, "metres");
    const auto to_m = row.number("to_m", -far_m, far_m, "metres");
    if (!from_m || !to_m) {
        return std::nullopt;
    }
    const double length_m = std::abs(*to_m - *from_m); // stations fall if driven in reverse
    if (!(length_m >= shortest_row_m && length_m <= longest_row_m)) {
        throw InputError{fmt::format("{}: from_m is '{}' and to_m '{}', expected stations 0.1 to "
                                     "2000 m apart",
                                     row.where(),
                                     row.text("from_m"),
                                     row.text("to_m"))};
    }
    return length_m;
}

std::optional<WayPart> way_part(const CsvRow& row) {
    const auto way_id = row.whole("way_id");
    const auto from_m = row.number("from_m", 0, far_m, "metres along the way, 0 or more");
    const auto to_m = row.number("to_m", 0, far_m, "metres along the way, 0 or more");
    const auto forward = direction_in(row);
    if (!way_id || !row_length_m(row)) {
        return std::nullopt;
    }
    return WayPart{*way_id,
                   forward.value_or(*from_m < *to_m),
                   std::min(*from_m, *to_m),
                   std::max(*from_m, *to_m)};
}

std::optional<GeoPoint> place_in(const CsvRow& row, std::string_view lat, std::string_view lon) {
    const auto lat_deg = row.number(lat, -90, 90, "-90 to 90");
    const auto lon_deg = row.number(lon, -180, 180, "-180 to 180");
    return lat_deg && lon_deg ? std::optional{GeoPoint{*lat_deg, *lon_deg}} : std::nullopt;
}

ReferenceRow with_ends(const CsvRow& row, ReferenceRow found) {
    found.begin = place_in(row, "begin_lat_deg", "begin_lon_deg");
    found.end = place_in(row, "end_lat_deg", "end_lon_deg");
    found.placed = found.begin && found.end;
    if (found.placed) {
        const double apart_m = distance_m(*found.begin, *found.end);
        if (!(apart_m >= shortest_row_m && apart_m <= longest_row_m)) {
            throw InputError{fmt::format("{}: begins and ends {:.2f} m apart, expected 0.1 to "
                                         "2000 m",
                                         row.where(),
                                         apart_m)};
        }
    }
    return found;
}

ReferenceRow with_middle(const CsvRow& row, ReferenceRow found, bool headings) {
    const auto at = place_in(row, "lat_deg", "lon_deg");
    found.values.at = at.value_or(GeoPoint{});
    found.values.length_m = row_length_m(row);
    found.heading_deg = row.number("heading_deg", -360, 360, "-360 to 360 degrees");
    found.placed = at && (!headings || (found.heading_deg && found.values.length_m));
    return found;
}

ReferenceRow row_of(const CsvTable& table,
                    std::size_t number,
                    ReferenceLocation places,
                    double mm_per_m_of_one) {
    const auto row = table.row(number);
    const auto iri = [&](std::string_view column) { return iri_in(row, column, mm_per_m_of_one); };
    ReferenceRow found;
    found.values.iri_mm_per_m = iri("iri");
    found.values.left_mm_per_m = iri("iri_left");
    found.values.right_mm_per_m = iri("iri_right");
    found.values.mri_mm_per_m = iri("mri");
    found.values.hri_mm_per_m = iri("hri");
    switch (places) {
    case ReferenceLocation::on_ways:
        found.way = way_part(row);
        found.placed = found.way.has_value();
        return found;
    case ReferenceLocation::ends:
        return with_ends(row, std::move(found));
    case ReferenceLocation::middles:
        break;
    }
    return with_middle(row, std::move(found), table.has("heading_deg"));
}

} // namespace

ReferenceSurvey read_reference(const std::filesystem::path& file, double mm_per_m_of_one) {
    const auto table = read_csv_table(file);
    ReferenceSurvey survey{.places = places_of(table), .rows = {}, .sha256 = table.sha256};
    expect_iri(table);
    if (survey.places == ReferenceLocation::middles) {
        expect_length(table);
    }
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
        survey.rows.push_back(row_of(table, i, survey.places, mm_per_m_of_one));
    }
    if (survey.rows.empty()) {
        throw InputError{fmt::format("{}: has no rows, expected at least one", file.string())};
    }
    return survey;
}

} // namespace macadam
