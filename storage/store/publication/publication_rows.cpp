#include "storage/store/publication/publication_rows.hpp"

namespace macadam {
namespace {

constexpr double m_per_km = 1000;

// Tables that appear empty, or without cars, to readers `anyone`.
constexpr const char* hide_all_but_published = R"(
PRAGMA temp_store = MEMORY;
CREATE TEMP VIEW segment_state AS SELECT * FROM main.published_state;
CREATE TEMP VIEW trip AS SELECT * FROM main.trip WHERE reference_ppm IS NOT NULL;
CREATE TEMP VIEW pass AS SELECT * FROM main.pass
    WHERE trip IN (SELECT id FROM main.trip WHERE reference_ppm IS NOT NULL);
CREATE TEMP VIEW row_reason AS SELECT * FROM main.row_reason
    WHERE trip IN (SELECT id FROM main.trip WHERE reference_ppm IS NOT NULL);
CREATE TEMP VIEW vehicle AS SELECT * FROM main.vehicle WHERE 0;
CREATE TEMP VIEW trace AS SELECT * FROM main.trace WHERE 0;
CREATE TEMP VIEW event AS SELECT * FROM main.event WHERE 0;
CREATE TEMP VIEW event_search AS SELECT * FROM main.event_search WHERE 0;
CREATE TEMP VIEW strip_state AS SELECT * FROM main.strip_state WHERE 0;
CREATE TEMP VIEW segment_dirty AS SELECT * FROM main.segment_dirty WHERE 0;
CREATE TEMP VIEW strip_dirty AS SELECT * FROM main.strip_dirty WHERE 0;
CREATE TEMP VIEW state_change AS SELECT * FROM main.state_change WHERE 0;
CREATE TEMP VIEW calibration AS SELECT * FROM main.calibration WHERE 0;
CREATE TEMP VIEW calibration_period AS SELECT * FROM main.calibration_period WHERE 0;
CREATE TEMP VIEW audit AS SELECT * FROM main.audit WHERE 0;
CREATE TEMP VIEW import_note AS SELECT * FROM main.import_note WHERE 0;
CREATE TEMP VIEW forgotten AS SELECT * FROM main.forgotten WHERE 0;
CREATE TEMP VIEW published_pending AS SELECT * FROM main.published_pending WHERE 0;
CREATE TEMP VIEW published_until AS SELECT * FROM main.published_until WHERE 0;
)";

} // namespace

std::optional<Publication> latest_publication(Database& database) {
    auto select = database.prepare("SELECT number, month, segments, length_m, left_segments,"
                                   " left_m, trips, cars FROM publication"
                                   " ORDER BY number DESC LIMIT 1");
    if (!select.step()) {
        return std::nullopt;
    }
    return Publication{.number = select.integer(0),
                       .month = select.text(1),
                       .segments = static_cast<std::size_t>(select.integer(2)),
                       .km = select.real(3) / m_per_km,
                       .left_out = static_cast<std::size_t>(select.integer(4)),
                       .left_out_km = select.real(5) / m_per_km,
                       .trips = static_cast<std::int32_t>(select.integer(6)),
                       .vehicles = static_cast<std::int32_t>(select.integer(7))};
}

PublicationReach reach_of(Database& database, std::int64_t number) {
    auto select =
        database.prepare("SELECT last_trip, last_segment FROM publication WHERE number = ?");
    return select.bind(number).step()
               ? PublicationReach{select.integer(0), select.integer(1), number}
               : PublicationReach{};
}

std::vector<PublicationReach> reaches_of_all(Database& database) {
    auto select = database.prepare("SELECT last_trip, last_segment, number FROM publication");
    std::vector<PublicationReach> reaches;
    while (select.step()) {
        reaches.push_back({select.integer(0), select.integer(1), select.integer(2)});
    }
    return reaches;
}

void show_published_alone(Database& database) {
    // Creating an in-memory view counts as a write.
    database.run("PRAGMA query_only = OFF");
    database.run(hide_all_but_published);
    database.run("PRAGMA query_only = ON");
}

} // namespace macadam
