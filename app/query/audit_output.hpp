#pragma once

#include "storage/store/records/maintenance_records.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace macadam {

/// Formats the audit log of a database, oldest entry first.
std::string text_of(const std::vector<AuditEntry>& entries);
std::string json_of(const std::vector<AuditEntry>& entries);

/// Formats the changes of a segment's value.
/// \param format  table, json or csv
std::string changes_text(const std::vector<NumberChange>& changes, std::string_view format);

} // namespace macadam
