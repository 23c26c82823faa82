#include "storage/store/rejection_reasons.hpp"

#include "storage/store/road_store_impl.hpp"

namespace macadam {
void write_row_reasons(Database& database,
                       std::int64_t trip,
                       const std::map<std::string, std::size_t>& reasons) {
    auto insert = database.prepare("INSERT INTO row_reason VALUES (?, ?, ?)");
    for (const auto& [reason, rows] : reasons) {
        insert.run(trip, reason, static_cast<std::int64_t>(rows));
    }
}

std::map<std::string, std::size_t> RoadStore::row_reasons() const {
    auto select =
        impl_->database.prepare("SELECT reason, sum(rows) FROM row_reason WHERE trip NOT IN"
                                " (SELECT id FROM trip WHERE reference_ppm IS NOT NULL)"
                                " GROUP BY reason");
    std::map<std::string, std::size_t> reasons;
    while (select.step()) {
        reasons[select.text(0)] = static_cast<std::size_t>(select.integer(1));
    }
    return reasons;
}

} // namespace macadam
