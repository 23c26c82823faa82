#pragma once

namespace macadam {

/// SQL that makes all tables of an empty store (docs/store.md).
extern const char* const store_tables;

} // namespace macadam
