#include "storage/store/rows/audit.hpp"

#include "storage/store/rows/segment_row.hpp"
#include "storage/store/schema/store_schema.hpp"

#include <chrono>

namespace macadam {
namespace {

std::int64_t now_ms() {
    const auto since_1970 = std::chrono::system_clock::now().time_since_epoch();
    return std::chrono::duration_cast<std::chrono::milliseconds>(since_1970).count();
}

} // namespace

std::string audit_time_now() {
    return datetime_text(now_ms());
}

std::int64_t add_audit(Database& database, std::string_view what, std::string_view detail) {
    database.prepare("INSERT INTO audit (at, generation, what, detail) VALUES (?, ?, ?, ?)")
        .run(audit_time_now(), std::int64_t{read_generation(database)}, what, detail);
    return database.number("SELECT last_insert_rowid()");
}

bool renew_audit(Database& database, std::int64_t entry) {
    database.prepare("UPDATE audit SET at = ?1 WHERE id = ?2 AND id = (SELECT max(id) FROM audit)")
        .run(audit_time_now(), entry);
    return database.changes() > 0;
}

} // namespace macadam
