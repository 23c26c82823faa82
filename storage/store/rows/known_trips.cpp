#include "storage/store/rows/known_trips.hpp"

#include "storage/files/sha256.hpp"

namespace macadam {

std::string forgotten_mark(const std::string& sha256) {
    Sha256 hash;
    hash.add("macadam forgot " + sha256);
    return hash.hex();
}

std::optional<std::int64_t> row_of_trip(Database& database, const std::string& sha256) {
    auto select = database.prepare("SELECT id FROM trip WHERE sha256 = ?");
    return select.bind(sha256).step() ? std::optional{select.integer(0)} : std::nullopt;
}

bool is_forgotten(Database& database, const std::string& sha256) {
    return database.prepare("SELECT 1 FROM forgotten WHERE mark = ?")
        .bind(forgotten_mark(sha256))
        .step();
}

void mark_forgotten(Database& database, const std::string& sha256) {
    database.prepare("INSERT OR IGNORE INTO forgotten VALUES (?)").run(forgotten_mark(sha256));
}

void unmark_forgotten(Database& database, const std::string& sha256) {
    database.prepare("DELETE FROM forgotten WHERE mark = ?").run(forgotten_mark(sha256));
}

} // namespace macadam
