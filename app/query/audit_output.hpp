#pragma once

#include "storage/store/schema/maintenance_records.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace macadam {

/// What was done to a store, oldest first.
std::string text_of(const std::vector<AuditEntry>& entries);
std::string json_of(const std::vector<AuditEntry>& entries);

/// How the number of a segment changed. \param format  table, json or csv.
std::string changes_text(const std::vector<NumberChange>& changes, std::string_view format);

} // namespace macadam
