#include "storage/store/rows/trip_tombstones.hpp"

#include "storage/files/sha256.hpp"

namespace macadam {
namespace {

std::string mark_of(const std::string& sha256) {
    Sha256 hash;
    hash.add("macadam forgot " + sha256);
    return hash.hex();
}

} // namespace

bool is_forgotten(Database& database, const std::string& sha256) {
    return database.prepare("SELECT 1 FROM forgotten WHERE mark = ?").bind(mark_of(sha256)).step();
}

void mark_forgotten(Database& database, const std::string& sha256) {
    database.prepare("INSERT OR IGNORE INTO forgotten VALUES (?)").run(mark_of(sha256));
}

void unmark_forgotten(Database& database, const std::string& sha256) {
    database.prepare("DELETE FROM forgotten WHERE mark = ?").run(mark_of(sha256));
}

} // namespace macadam
