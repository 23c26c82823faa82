#pragma once

#include "storage/store/records/maintenance_records.hpp"
#include "storage/text/unit_system.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace macadam {

/// Formats the audit log of a database, oldest entry first.
/// \param format  table, json or csv
std::string audit_text(const std::vector<AuditEntry>& entries, std::string_view format);

/// Formats the changes of a segment's value.
/// \param format  table, json or csv
std::string changes_text(const std::vector<NumberChange>& changes,
                         std::string_view format,
                         UnitSystem units = UnitSystem::si);

} // namespace macadam
