#pragma once

namespace macadam {

/// SQL that makes all tables of an empty store (docs/reference/database.md).
extern const char* const store_tables;

} // namespace macadam
