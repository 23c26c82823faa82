#pragma once

#include "storage/store/schema/schema_check.hpp"

namespace macadam {

/// Objects that a database of an earlier version may contain: today's objects in their former
/// wording, without later additions.
Schema schema_of_version(int version, PrivacyProfile privacy);

} // namespace macadam
