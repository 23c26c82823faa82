#include "storage/store/put_background.hpp"

#include "storage/store/connection/store_connection.hpp"
#include "storage/store/rows/audit.hpp"

#include <utility>

namespace macadam {

BackgroundSize put_background(const std::filesystem::path& store,
                              const GeoBox& box,
                              const BackgroundSource& source,
                              const std::string& detail,
                              LockWaitPolicy wait_policy) {
    const auto open = open_connection(
        store, Database::Access::write, std::move(wait_policy), Audience::operator_);
    Transaction all{open->database, Transaction::Kind::write};
    const auto size = replace_background(open->database, box, source);
    if (!detail.empty()) {
        add_audit(open->database, "background", detail); // by which readers know that it changed
    }
    all.commit();
    return size;
}

} // namespace macadam
