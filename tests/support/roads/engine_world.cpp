#include "support/roads/engine_world.hpp"

#include "storage/postgres/server_connection.hpp"
#include "storage/sqlite/sqlite.hpp"
#include "storage/store/server/copy/store_copy.hpp"
#include "storage/store/server/importer/server_importer.hpp"
#include "storage/store/server/reader/server_reader.hpp"
#include "storage/store/server/replica/server_replica.hpp"
#include "support/roads/store_world.hpp"

#include <algorithm>
#include <chrono>
#include <thread>

namespace macadam::testing {

std::string name_of(Engine engine) {
    return engine == Engine::geopackage ? "GeoPackage" : "PostgreSQL";
}

EngineDatabase::EngineDatabase(Engine engine, const std::filesystem::path& folder)
    : EngineDatabase{engine, folder, small_country(), settings()} {}

EngineDatabase::EngineDatabase(Engine engine,
                               const std::filesystem::path& folder,
                               const RoadNetwork& roads,
                               const StoreSettings& settings) {
    const auto file = folder / "roads.gpkg";
    static_cast<void>(RoadStore::create(file, roads, settings));
    name_ = file.string();
    if (engine == Engine::postgresql) {
        server_.emplace();
        name_ = server_->new_database("roads");
        copy_to_server(file, name_, {}, {});
    }
}

ImportStore EngineDatabase::import() const {
    if (!server_) {
        return import_store_of(RoadStore::open(name_));
    }
    const auto open = open_server_import(name_);
    return {name_, StoreReader{open.image}, open.trips};
}

StoreReader EngineDatabase::read(Audience audience) const {
    return server_ ? StoreReader{open_server_reader(name_, {}, audience, {}, {})}
                   : StoreReader::open(name_, {}, audience);
}

ServerConnection EngineDatabase::boss_alone() const {
    ServerConnection boss{server_.value().address("roads")};
    while (boss.number("SELECT count(*) FROM pg_stat_activity WHERE backend_type = 'client"
                       " backend' AND pid <> pg_backend_pid()") > 0) {
        std::this_thread::sleep_for(std::chrono::milliseconds{10}); // the time limit ends it
    }
    return boss;
}

std::int64_t EngineDatabase::rows_read_by_index_of(const std::string& names) const {
    return boss_alone().number("SELECT sum(idx_tup_read)::bigint FROM pg_stat_user_indexes WHERE"
                               " schemaname = 'macadam' AND relname ~ '" +
                               names + "'");
}

std::vector<std::string> EngineDatabase::scans_of(const std::string& names) const {
    auto boss = boss_alone();
    std::vector<std::string> scans;
    for (const auto& row : boss.rows("SELECT relname || ' ' || seq_scan FROM pg_stat_user_tables"
                                     " WHERE schemaname = 'macadam' AND relname ~ $1 ORDER BY 1",
                                     {names})) {
        scans.push_back(row[0].value());
    }
    return scans;
}

std::filesystem::path EngineDatabase::key_file() const {
    return import().trips->key_file();
}

RoadStore EngineDatabase::maintain() const {
    return server_ ? RoadStore{open_server_replica(name_, {}, {})} : RoadStore::open(name_);
}

RoadStore EngineDatabase::to_publish() const {
    return server_ ? RoadStore{open_replica_to_publish(name_, {}, {})} : maintain();
}

Forgotten EngineDatabase::forget(const ForgetRequest& request) const {
    return (server_ ? RoadStore{open_replica_to_forget(name_, request, {}, {})} : maintain())
        .maintenance.forget(request);
}

RichTrip::RichTrip(int number) : record{trip_record(number)}, passes{passes_of(number)} {
    record.row_reasons = {{"too_slow", 7U}};
    for (auto& pass : passes) {
        pass.drive = 0;
    }
    for (const bool forward : {true, false}) {
        RoughnessTrace trace{.chunk = {1, forward, 0},
                             .drive = 0,
                             .first_m = forward ? -10 : -210,
                             .iri = {},
                             .left = {},
                             .place_sd_mm = 900};
        for (int metre = 0; metre < 220; ++metre) {
            trace.iri.push_back(code_of(1.0 + 0.1 * ((metre * 7 + number) % 23)));
        }
        traces.push_back(trace);
    }
    events = {{.segment = {1, true, 3},
               .occurrence = 0,
               .kind = EventKind::pothole,
               .track = WheelTrack::left,
               .at_mm = 71'000 + 100 * number,
               .place_sd_mm = 800,
               .size_um = 40'000,
               .sd_um = 5'000,
               .length_mm = 500}};
}

NewTrip RichTrip::as_new(bool readmit) const {
    return {&record, passes, traces, readmit, events};
}

bool add_rich_trip(ImportTarget& trips, int number, bool readmit) {
    const RichTrip trip{number};
    const auto one = trip.as_new(readmit);
    return trips.add_trips({&one, 1}).front();
}

void import_rich_trips(ImportTarget& trips, int count) {
    for (int number = 0; number < count; ++number) {
        add_rich_trip(trips, number);
    }
    fuse_all(trips);
}

void fuse_all(ImportTarget& trips) {
    FusionRecord record;
    trips.refresh({}, record, BusyChunks::await);
}

std::vector<std::string> rows_of_tables(const std::filesystem::path& file) {
    Database database{file, Database::Access::read};
    std::vector<std::string> tables;
    auto names = database.prepare("SELECT name FROM sqlite_schema WHERE type = 'table' AND name"
                                  " NOT GLOB 'gpkg_*' AND name NOT GLOB 'rtree_*' AND name NOT GLOB"
                                  " 'sqlite_*' AND name NOT IN ('layer_styles', 'strip_dirty')"
                                  " ORDER BY name");
    while (names.step()) {
        tables.push_back(names.text(0));
    }
    std::vector<std::string> rows;
    for (const auto& table : tables) {
        auto count = database.prepare("SELECT count(*) FROM pragma_table_info(?)");
        count.bind(table).step();
        const auto columns = static_cast<int>(count.integer(0));
        auto select = database.prepare("SELECT * FROM " + table);
        while (select.step()) {
            std::string row = table;
            for (int column = 0; column < columns; ++column) {
                row += select.is_null(column) ? "|-" : "|" + select.text(column);
            }
            rows.push_back(row);
        }
    }
    std::ranges::sort(rows);
    return rows;
}

} // namespace macadam::testing
