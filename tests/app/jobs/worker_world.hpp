#pragma once

#include "support/program/program.hpp"

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace macadam::testing {

/// Road database on the server of this process, with logs of trips over its road and an empty
/// object store.
struct WorkerWorld {
    WorkerWorld();

    /// Writes logs of different trips into folder `trips`.
    void make_trips(std::size_t count);

    std::vector<std::string> submit_words() const;
    std::vector<std::string> worker_words() const; ///< until the queue is empty

    /// Digest of the database.
    std::string digest() const;
    /// Digest of a file into which the folder of trips was imported.
    std::string digest_of_import() const;

    /// Output of `macadam status --json`.
    std::string status() const;

    std::filesystem::path folder;
    std::string address;
    std::string objects;
    std::filesystem::path trips;
};

/// Kills workers at random moments, spread over the work, and starts others in their place until
/// the queue is worked out.
struct KillPlan {
    std::size_t workers, kills;
    std::size_t trips; ///< in the queue
};
void kill_workers(const WorkerWorld& world, const KillPlan& plan);

/// Expects that the queue is worked out: every trip in the database once, none twice.
void expect_all_imported(const WorkerWorld& world, std::size_t count);

} // namespace macadam::testing
