#include "storage/store/rows/old_changes.hpp"

#include "storage/store/rows/segment_row.hpp"

#include <chrono>

namespace macadam {
namespace {

constexpr std::chrono::days kept_for{400};

/// Imports are what makes the tables grow: without an old one, no search for changes is due.
bool is_due(Database& database, const std::string& since) {
    auto first = database.prepare("SELECT at FROM audit WHERE what = 'import' ORDER BY id LIMIT 1");
    return first.step() && first.text(0) < since;
}

} // namespace

std::string changes_kept_since() {
    const auto since = std::chrono::system_clock::now() - kept_for;
    return datetime_text(
        std::chrono::duration_cast<std::chrono::milliseconds>(since.time_since_epoch()).count());
}

std::int64_t first_kept_audit(Database& database) {
    auto select = database.prepare("SELECT coalesce(min(id), (SELECT coalesce(max(id), 0) + 1"
                                   " FROM main.audit)) FROM main.audit WHERE at >= ?");
    select.bind(changes_kept_since()).step();
    return select.integer(0);
}

void remove_old_changes(Database& database) {
    if (!is_due(database, changes_kept_since())) {
        return;
    }
    const ForeignKeysOff changes_go_first{database};
    Transaction all{database, Transaction::Kind::write};
    const auto first = first_kept_audit(database);
    database.prepare("DELETE FROM state_change WHERE audit < ?").run(first);
    database.prepare("DELETE FROM audit WHERE what = 'import' AND id < ?").run(first);
    all.commit();
}

} // namespace macadam
