#pragma once

#include "estimator/common/progress.hpp"
#include "storage/sqlite/lock_wait_policy.hpp"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace macadam {

/// Result of an upgrade of a database.
struct StoreUpgrade {
    int from_version;
    int to_version;        ///< equal to from_version if there was nothing to do
    std::size_t cars = 0;  ///< that were renamed under the key
    std::size_t trips = 0; ///< from whose names the id of the car was removed
    bool made_key = false; ///< false: an existing key was used
    std::string digest{};  ///< equal before and after the upgrade
};

/// Progress of an upgrade, reported per part.
using UpgradeProgress = std::function<Progress(std::string_view part)>;

/// Upgrades a database to the current version in one transaction, so that it is never left half
/// upgraded. The digest is compared before and after.
///
/// \throws InputError  if it is not a road database, contains foreign objects, is damaged, does not
///                     fit on the disk, or is locked by another process.
StoreUpgrade upgrade_store(const std::filesystem::path& file,
                           const LockWaitPolicy& wait_policy,
                           const UpgradeProgress& progress);

} // namespace macadam
