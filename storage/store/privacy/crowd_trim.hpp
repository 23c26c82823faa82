#pragma once

#include "mapping/privacy/trip_trimming.hpp"
#include "storage/store/privacy/privacy_key.hpp"

namespace macadam {

/// Trim rule for trips of a crowd: 300 m plus up to 200 m, derived from the key and the trip's
/// hash, so that a repeated import gives the same result.
TrimRule crowd_trim(const PrivacyKey& key);

} // namespace macadam
