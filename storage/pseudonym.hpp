#pragma once

#include <string>

namespace macadam {

/// A name that tells cars apart without naming them: "v-" and 12 hex digits of the SHA-256 of the
/// id; "unknown" for "".
std::string pseudonym_of(const std::string& vehicle_id);

} // namespace macadam
