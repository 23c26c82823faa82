#pragma once

namespace macadam {

/// SQL that creates all tables of an empty road database (docs/reference/database.md).
extern const char* const store_tables;

} // namespace macadam
