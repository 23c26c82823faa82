#pragma once

#include "storage/sqlite/sqlite.hpp"

struct sqlite3;

namespace macadam {

/// Causes of errors, for messages.
inline constexpr const char* unfinished_cause =
    "contains an interrupted import and is read-only, so it cannot be rolled back: open it "
    "once where it can be written";
inline constexpr const char* moved_cause =
    "was removed or replaced while this command was using it; run the command again";

/// Tests for an interrupted transaction that only a program with write access can recover.
///
/// \param code  extended result code of SQLite
bool is_unfinished(int code);

/// Checks an extended result code of SQLite.
///
/// \throws InputError  "FILE: cause" if it is an error.
void expect_success(sqlite3* database, const OpenFile& file, int code);

} // namespace macadam
