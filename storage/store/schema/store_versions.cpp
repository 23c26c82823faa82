#include "storage/store/schema/store_versions.hpp"

namespace macadam {
namespace {

/// Definition before version 3, which stores days in place of times.
constexpr const char* segment_state_2 = R"(CREATE TABLE segment_state (
    fid INTEGER PRIMARY KEY NOT NULL REFERENCES segment(fid),
    iri DOUBLE NOT NULL,
    iri_sd DOUBLE NOT NULL,
    iri_low DOUBLE NOT NULL,
    iri_high DOUBLE NOT NULL,
    iri_left DOUBLE,
    iri_right DOUBLE,
    "index" TEXT NOT NULL,
    class TEXT NOT NULL,
    passes INTEGER NOT NULL,
    vehicles INTEGER NOT NULL,
    first_seen DATETIME,
    last_seen DATETIME,
    trend_per_year DOUBLE,
    trend_sd DOUBLE,
    changed DATETIME,
    change DOUBLE,
    validity TEXT NOT NULL,
    first_seen_ms INTEGER,
    last_seen_ms INTEGER,
    changed_ms INTEGER,
    flags INTEGER NOT NULL
))";

} // namespace

Schema schema_of_version(int version, PrivacyProfile privacy) {
    // Before version 5, the layer of every database had all fused values.
    auto schema = own_schema(version <= 4 ? PrivacyProfile::own : privacy);
    if (version <= 2) {
        schema.at({"table", "segment_state"}).sql = segment_state_2;
    }
    return schema;
}

} // namespace macadam
