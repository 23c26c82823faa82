#pragma once

#include "storage/postgres/server_connection.hpp"
#include "storage/store/import_store.hpp"
#include "storage/store/road_store.hpp"
#include "support/program/postgres_server.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace macadam::testing {

enum class Engine { geopackage, postgresql };

/// Name of an engine, for names of tests.
std::string name_of(Engine engine);

/// Database on one of the engines, empty at first. Beside the one on a server, an empty file of the
/// same key stays in the folder: roads.gpkg.
class EngineDatabase {
public:
    /// Database of the small country (store_world.hpp).
    EngineDatabase(Engine engine, const std::filesystem::path& folder);

    /// With other roads and settings.
    EngineDatabase(Engine engine,
                   const std::filesystem::path& folder,
                   const RoadNetwork& roads,
                   const StoreSettings& settings);

    /// Opens it for imports. Each call opens a connection of its own.
    ImportStore import() const;
    StoreReader read(Audience audience = Audience::operator_) const;
    RoadStore maintain() const;
    /// Opens it for its next publication.
    RoadStore to_publish() const;
    Forgotten forget(const ForgetRequest& request) const;

    /// Tells how often tables of a server with such names were read from begin to end, as an
    /// administrator would see in EXPLAIN of each statement. Waits for all other connections to
    /// have ended: then the server has told what they counted.
    ///
    /// \param names  regular expression
    std::vector<std::string> scans_of(const std::string& names) const;

    /// Tells how many rows of such tables indexes led to, in the same way.
    std::int64_t rows_read_by_index_of(const std::string& names) const;

    /// Where its key is.
    std::filesystem::path key_file() const;

    const std::string& name() const { return name_; }
    PostgresServer& server() { return *server_; }

private:
    /// Waits for all other connections to have ended.
    ServerConnection boss_alone() const;

    std::optional<PostgresServer> server_;
    std::string name_; ///< of a file, or an address
};

/// Trip `number` over way 1 (store_world.hpp) with a trace over each chunk and a pothole.
struct RichTrip {
    explicit RichTrip(int number);
    NewTrip as_new(bool readmit = false) const;

    TripRecord record;
    std::vector<Pass> passes;
    std::vector<RoughnessTrace> traces;
    std::vector<PassEvent> events;
};

/// Adds one such trip. \returns whether it is new.
bool add_rich_trip(ImportTarget& trips, int number, bool readmit = false);

/// Adds trips 0 to `count` - 1 and fuses them.
void import_rich_trips(ImportTarget& trips, int count);

void fuse_all(ImportTarget& trips);

/// Content of all tables, but for those that SQLite and the GeoPackage keep for themselves, and for
/// marks of chunks, which on the server stand for those of their segments.
std::vector<std::string> rows_of_tables(const std::filesystem::path& file);

} // namespace macadam::testing
