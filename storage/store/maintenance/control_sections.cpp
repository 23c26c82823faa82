#include "storage/store/connection/store_connection.hpp"
#include "storage/store/maintenance/store_maintenance.hpp"

#include <cmath>
#include <cstdint>

namespace macadam {
namespace {

std::int64_t whole_thousandths(double value) {
    return std::llround(value * 1000);
}

} // namespace

void StoreMaintenance::put_control_sections(std::span<const ControlSection> sections) {
    auto& database = store_->database;
    Transaction all{database, Transaction::Kind::write};
    auto insert =
        database.prepare("INSERT OR REPLACE INTO control_section VALUES (?, ?, ?, ?, ?, ?, ?, ?)");
    for (const auto& section : sections) {
        insert.run(section.name,
                   section.way_id,
                   section.forward ? "forward" : "backward",
                   whole_thousandths(section.from_m),
                   whole_thousandths(section.to_m),
                   whole_thousandths(section.iri_mm_per_m),
                   whole_thousandths(section.sd_mm_per_m),
                   section.utc_ms);
    }
    all.commit();
    store_->written({});
}

} // namespace macadam
