#pragma once

#include <string>

namespace macadam {

/// Statements of migration 12: tokens by which others send logs to a server, and who sent which.
std::string upload_schema();

} // namespace macadam
