#include "storage/row_reasons.hpp"

#include "storage/road_store_impl.hpp"

namespace macadam {
namespace {

bool is_kept(Database& database) {
    return database.number("SELECT count(*) FROM sqlite_schema WHERE name = 'row_reason'") > 0;
}

} // namespace

void write_row_reasons(Database& database,
                       std::int64_t trip,
                       const std::map<std::string, std::size_t>& reasons) {
    // Stores of version 0.1 were made without it.
    database.run("CREATE TABLE IF NOT EXISTS row_reason (trip INTEGER NOT NULL REFERENCES trip(id),"
                 " reason TEXT NOT NULL, rows INTEGER NOT NULL, PRIMARY KEY (trip, reason))"
                 " WITHOUT ROWID");
    auto insert = database.prepare("INSERT INTO row_reason VALUES (?, ?, ?)");
    for (const auto& [reason, rows] : reasons) {
        insert.run(trip, reason, static_cast<std::int64_t>(rows));
    }
}

std::map<std::string, std::size_t> RoadStore::row_reasons() const {
    std::map<std::string, std::size_t> reasons;
    if (is_kept(impl_->database)) {
        auto select =
            impl_->database.prepare("SELECT reason, sum(rows) FROM row_reason WHERE trip NOT IN"
                                    " (SELECT id FROM trip WHERE reference_ppm IS NOT NULL)"
                                    " GROUP BY reason");
        while (select.step()) {
            reasons[select.text(0)] = static_cast<std::size_t>(select.integer(1));
        }
    }
    return reasons;
}

} // namespace macadam
