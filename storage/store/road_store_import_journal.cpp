#include "storage/store/road_store.hpp"
#include "storage/store/road_store_impl.hpp"

#include <algorithm>

namespace macadam {
namespace {

std::int64_t count_of_trips(Database& database) {
    return database.number("SELECT count(*) FROM trip");
}

std::optional<OpenImport> open_import(Database& database, const std::string& name) {
    auto select = database.prepare("SELECT asked, trips_before FROM import_note WHERE name = ?");
    if (!select.bind(name).step()) {
        return {};
    }
    const auto added = std::max<std::int64_t>(0, count_of_trips(database) - select.integer(1));
    return OpenImport{static_cast<std::size_t>(select.integer(0)), static_cast<std::size_t>(added)};
}

} // namespace

std::optional<OpenImport> RoadStore::begin_import(const std::string& name,
                                                  std::size_t trips_asked) {
    auto& database = impl_->database;
    Transaction all{database, Transaction::Kind::write};
    const auto earlier = open_import(database, name);
    database.prepare("INSERT OR IGNORE INTO import_note VALUES (?, ?, ?)")
        .run(name, static_cast<std::int64_t>(trips_asked), count_of_trips(database));
    all.commit();
    return earlier;
}

void RoadStore::end_import(const std::string& name) {
    impl_->database.prepare("DELETE FROM import_note WHERE name = ?").run(name);
}

} // namespace macadam
