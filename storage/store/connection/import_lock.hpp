#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace macadam {

/// Tells other processes that an import of a database is running, for as long as the object lives:
/// a lock on the file NAME.gpkg-import beside it. The kernel releases the lock when the process
/// ends in whatever way, so that a running import differs from a killed one, also between
/// containers that share the file system.
///
/// It excludes nobody: several imports may run. Without effect where the file can neither be
/// created nor read, or the file system has no locks. The file of a killed import, or of another
/// user who lets nobody else write it, stays until the next import of its owner ends.
///
/// Source: open file description locks, fcntl(2). SQLite's own files cannot be used: closing one
/// drops SQLite's locks on it.
class ImportLock {
public:
    /// \param import  name of the import, as of TripImporter::begin_import()
    ImportLock(const std::filesystem::path& store, const std::string& import);
    ImportLock(const ImportLock&) = delete;
    ImportLock& operator=(const ImportLock&) = delete;
    ~ImportLock();

    /// Tests whether another import of the database is running, in any process; with a name,
    /// whether one of that name is. Of two imports that start together at least one learns of the
    /// other.
    bool is_other_running(const std::optional<std::string>& import = {}) const;

private:
    std::filesystem::path file_;
    int descriptor_ = -1;
};

/// Tests whether an import of a database is running, in any process; with a name, whether that one
/// is. Returns false if the lock file cannot be read.
bool is_import_running(const std::filesystem::path& store,
                       const std::optional<std::string>& import = {});

} // namespace macadam
