#pragma once

#include "estimator/common/progress.hpp"
#include "storage/sqlite/lock_wait.hpp"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace macadam {

/// What was done to bring a store to the version of today.
struct StoreUpgrade {
    int from_version;
    int to_version;        ///< the same: there was nothing to do
    std::size_t cars = 0;  ///< that got a name under the key
    std::size_t trips = 0; ///< from whose names the id of the car was taken
    bool made_key = false; ///< false: one lay there, and was taken
    std::string digest{};  ///< before and after
};

/// How the work goes on: a bar for each part of it.
using UpgradeProgress = std::function<Progress(std::string_view part)>;

/// Brings a store from an earlier version to that of today, in one transaction: it is the old one
/// until it is the new one, whatever happens. The digest is taken before and after, and must be the
/// same.
///
/// \throws InputError  if it is no store, holds what is not ours, is damaged, if the disk has no
///                     room for it, or another process keeps it locked.
StoreUpgrade upgrade_store(const std::filesystem::path& file,
                           const LockWaitPolicy& wait_policy,
                           const UpgradeProgress& progress);

} // namespace macadam
