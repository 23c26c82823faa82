#pragma once

#include "mapping/privacy/trip_trimming.hpp"
#include "storage/store/privacy/privacy_key.hpp"

namespace macadam {

/// How trips of a crowd are trimmed: 300 m and up to 200 m more, as the key draws it from the
/// trip's hash, so that a re-import is the same.
TrimRule crowd_trim(const PrivacyKey& key);

} // namespace macadam
