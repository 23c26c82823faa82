#include "storage/sqlite/sqlite_error.hpp"

#include "estimator/common/error.hpp"

#include <fmt/format.h>
#include <sqlite3.h>

#include <cstring>
#include <string>

namespace macadam {
namespace {

std::string cause_of_io_error(sqlite3* database, int code) {
    const bool reads = code == SQLITE_IOERR_READ || code == SQLITE_IOERR_SHORT_READ;
    const int error = sqlite3_system_errno(database); // not always preserved until here
    return fmt::format("cannot be {}: {} ({})",
                       reads ? "read" : "written",
                       error != 0 ? std::strerror(error) : sqlite3_errmsg(database),
                       code);
}

std::string cause_of(sqlite3* database, const OpenFile& file, int code) {
    switch (code & 0xff) {
    case SQLITE_FULL:
        return "no space left on the disk, nothing was changed";
    case SQLITE_READONLY:
        return is_unfinished(code)               ? unfinished_cause
               : code == SQLITE_READONLY_DBMOVED ? moved_cause
                                                 : "cannot be written, it is read-only";
    case SQLITE_CANTOPEN:
        return "cannot be opened";
    case SQLITE_PERM:
    case SQLITE_AUTH:
        return "access denied";
    case SQLITE_NOTADB:
        return "is not a Macadam database, expected one made by 'macadam init'";
    case SQLITE_CORRUPT:
        return fmt::format("is damaged: {}", sqlite3_errmsg(database));
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
        return file.wait.reason();
    case SQLITE_INTERRUPT:
        return "interrupted while reading";
    case SQLITE_IOERR:
        return cause_of_io_error(database, code);
    default:
        return sqlite3_errmsg(database);
    }
}

} // namespace

bool is_unfinished(int code) {
    return code == SQLITE_READONLY_ROLLBACK || code == SQLITE_READONLY_RECOVERY;
}

void expect_success(sqlite3* database, const OpenFile& file, int code) {
    if (code != SQLITE_OK && code != SQLITE_ROW && code != SQLITE_DONE) {
        throw InputError{fmt::format("{}: {}", file.name.string(), cause_of(database, file, code))};
    }
}

} // namespace macadam
