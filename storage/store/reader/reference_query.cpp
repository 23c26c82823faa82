#include "storage/store/connection/store_connection.hpp"
#include "storage/store/reader/store_reader.hpp"
#include "storage/store/rows/segment_row.hpp"

#include <fmt/format.h>

#include <map>
#include <vector>

namespace macadam {
namespace {

constexpr double ppm = 1e-6;

/// Surveys in their order, and their indexes by row of table trip.
struct Surveys {
    std::vector<SurveyUse> uses;
    std::map<std::int64_t, std::size_t> places;
};

Surveys surveys_in(Database& database) {
    auto select = database.prepare(
        "SELECT id, trip_id, file_name, sha256, t0_utc_ms, reference_ppm, reference_row_mm,"
        " rows_read, rows_used FROM trip WHERE reference_ppm IS NOT NULL"
        " ORDER BY trip_id, sha256");
    Surveys surveys;
    while (select.step()) {
        surveys.places.emplace(select.integer(0), surveys.uses.size());
        surveys.uses.push_back({.name = select.text(1),
                                .file_name = select.text(2),
                                .sha256 = select.text(3),
                                .utc_ms = known_utc_ms(select, 4),
                                .relative_sd = static_cast<double>(select.integer(5)) * ppm,
                                .row_m = static_cast<double>(select.integer(6)) / 1000,
                                .rows_read = static_cast<std::size_t>(select.integer(7)),
                                .rows_used = static_cast<std::size_t>(select.integer(8))});
    }
    return surveys;
}

} // namespace

std::vector<SurveyUse> StoreReader::surveys() const {
    auto& database = store_->database;
    Transaction one_moment{database, Transaction::Kind::read};
    auto [uses, places] = surveys_in(database);
    auto select = database.prepare(
        "SELECT trip.id, count(*), sum(segment.to_m - segment.from_m) / 1000,"
        " sum(CASE WHEN state.passes = 0 THEN segment.to_m - segment.from_m ELSE 0 END) / 1000"
        " FROM trip CROSS JOIN pass ON pass.trip = trip.id"
        " CROSS JOIN segment ON segment.fid = pass.segment"
        " LEFT JOIN segment_state AS state ON state.fid = segment.fid"
        " WHERE trip.reference_ppm IS NOT NULL GROUP BY trip.id");
    while (select.step()) {
        auto& use = uses[places.at(select.integer(0))];
        use.passes = static_cast<std::size_t>(select.integer(1));
        use.km = select.real(2);
        use.alone_km = select.real(3);
    }
    return uses;
}

std::vector<ReferenceReading> StoreReader::reference_readings() const {
    auto& database = store_->database;
    Transaction one_moment{database, Transaction::Kind::read};
    const auto [uses, places] = surveys_in(database);
    auto select = database.prepare(
        fmt::format("SELECT segment.way_id, segment.direction, segment.seq, segment.from_m,"
                    " segment.to_m, way.highway, trip.id, {}"
                    " FROM trip CROSS JOIN pass ON pass.trip = trip.id"
                    " CROSS JOIN segment ON segment.fid = pass.segment"
                    " CROSS JOIN way ON way.way_id = segment.way_id"
                    " WHERE trip.reference_ppm IS NOT NULL"
                    " ORDER BY segment.way_id, segment.direction DESC, segment.seq, trip.trip_id,"
                    " trip.sha256, pass.occurrence",
                    pass_columns));
    std::vector<ReferenceReading> readings;
    while (select.step()) {
        const auto key = key_in(select, 0);
        readings.push_back({.segment = {key, select.real(3), select.real(4), {}},
                            .highway = select.text(5),
                            .pass = pass_in(select, 7, key),
                            .survey = places.at(select.integer(6))});
    }
    return readings;
}

std::vector<ControlSection> StoreReader::control_sections() const {
    auto select = store_->database.prepare(
        "SELECT name, way_id, direction, from_mm, to_mm, iri_um, sd_um, utc_ms"
        " FROM control_section ORDER BY name");
    const auto of_thousandths = [&](int column) {
        return static_cast<double>(select.integer(column)) / 1000;
    };
    std::vector<ControlSection> sections;
    while (select.step()) {
        sections.push_back({.name = select.text(0),
                            .way_id = select.integer(1),
                            .forward = select.text(2) == "forward",
                            .from_m = of_thousandths(3),
                            .to_m = of_thousandths(4),
                            .iri_mm_per_m = of_thousandths(5),
                            .sd_mm_per_m = of_thousandths(6),
                            .utc_ms = known_utc_ms(select, 7)});
    }
    return sections;
}

} // namespace macadam
