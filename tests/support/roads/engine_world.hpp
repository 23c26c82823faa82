#pragma once

#include "storage/store/import_store.hpp"
#include "storage/store/road_store.hpp"
#include "support/program/postgres_server.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace macadam::testing {

enum class Engine { geopackage, postgresql };

/// Database of the small country (store_world.hpp) on one of the engines, empty at first.
class EngineDatabase {
public:
    EngineDatabase(Engine engine, const std::filesystem::path& folder);

    /// Opens it for imports. Each call opens a connection of its own.
    ImportStore import() const;
    StoreReader read() const;
    RoadStore maintain() const;

    const std::string& name() const { return name_; }
    PostgresServer& server() { return *server_; }

private:
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

} // namespace macadam::testing
