#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace macadam::testing {

/// What a program asked of the disk, in order: enough to say what a power loss can leave of it.
struct DiskOperation {
    enum class Kind { write, truncate, sync, link, unlink, sync_folder };
    Kind kind;
    std::size_t file = 0;    ///< of all but unlink and sync_folder: its number
    std::string name{};      ///< of link and unlink
    std::int64_t offset = 0; ///< of write; of truncate, the new size
    std::string bytes{};     ///< of write
};

/// Files, their names and what was asked of them.
struct DiskLog {
    std::vector<std::string> at_first;        ///< by number: content before the first operation
    std::map<std::string, std::size_t> names; ///< before the first operation
    std::vector<DiskOperation> operations;
};

/// What becomes of what was not synced.
enum class Loss {
    all,  ///< nothing of it came to the disk
    some, ///< any of the writes and names did, the others not
    torn, ///< any sectors of 512 bytes did, the others not
};

/// Puts into `folder` what a disk could hold after the power went when the first `count` operations
/// had been asked for. What was synced before is there; the same seed gives the same files.
void write_after_power_loss(const DiskLog& log,
                            std::size_t count,
                            Loss loss,
                            std::uint32_t seed,
                            const std::filesystem::path& folder);

/// What goes wrong.
enum class Fault {
    full,    ///< ENOSPC from what needs room; half of a write is done
    broken,  ///< EIO from any access
    no_sync, ///< EIO from fsync
};

struct FaultPlan {
    Fault fault;
    std::size_t number; ///< the access that fails, of those that the fault can meet, from 1
    bool once;          ///< false: all after it fail as well
};

/// An SQLite VFS above the default one: while it lives, databases that are opened without naming
/// another are written through it. It logs what it is asked and fails where it is told to.
///
/// The folder is modelled as the unix VFS treats it: a journal or log that was opened to be made
/// takes its folder to the disk with its first sync, and a name that is removed is gone for sure
/// only when the folder is synced. Syncs are logged and not done, which makes tests quick.
class FaultyDisk {
public:
    FaultyDisk();
    FaultyDisk(const FaultyDisk&) = delete;
    FaultyDisk& operator=(const FaultyDisk&) = delete;
    ~FaultyDisk();

    void plan(const FaultPlan& plan);
    bool has_failed() const;

    const DiskLog& log() const;

    struct Vfs;

private:
    std::unique_ptr<Vfs> vfs_;
};

} // namespace macadam::testing
