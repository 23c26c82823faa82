#include "storage/store/schema/store_marker.hpp"

#include "storage/sqlite/sqlite.hpp"
#include "storage/sqlite/sqlite_header_check.hpp"

namespace macadam {

bool is_store(const std::filesystem::path& file) {
    try {
        expect_store_file(file);
        Database database{file, Database::Access::read};
        auto select = database.prepare("SELECT value FROM meta WHERE key = 'format'");
        return select.step() && select.text(0) == store_format;
    } catch (const InputError&) {
        return false;
    }
}

} // namespace macadam
