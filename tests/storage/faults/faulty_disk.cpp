#include "faulty_disk.hpp"

#include <sqlite3.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <mutex>
#include <new>
#include <optional>
#include <sstream>
#include <string_view>
#include <utility>

namespace macadam::testing {
namespace {

using Kind = DiskOperation::Kind;

std::string content_of(const std::string& name) {
    std::ostringstream text;
    text << std::ifstream{name, std::ios::binary}.rdbuf();
    return text.str();
}

} // namespace

/// What all files of the VFS share.
struct FaultyDisk::Vfs {
    sqlite3_vfs* below;
    sqlite3_vfs above;
    DiskLog log{};
    std::map<std::string, std::size_t> names{}; ///< now
    std::optional<FaultPlan> plan{};
    std::size_t accesses = 0; ///< that the fault of the plan can meet
    bool has_failed = false;
    int last_errno = 0;
    std::recursive_mutex in_use{};

    /// Whether this access fails; `needs_room` and `syncs` say what it does.
    bool fails(bool needs_room, bool syncs) {
        const std::scoped_lock lock{in_use};
        if (!plan || (plan->fault == Fault::full && !needs_room) ||
            (plan->fault == Fault::no_sync && !syncs)) {
            return false;
        }
        ++accesses;
        if (accesses < plan->number || (plan->once && accesses > plan->number)) {
            return false;
        }
        has_failed = true;
        last_errno = plan->fault == Fault::full ? ENOSPC : EIO;
        return true;
    }

    bool is_full() const { return plan && plan->fault == Fault::full; }

    void note(DiskOperation operation) {
        const std::scoped_lock lock{in_use};
        log.operations.push_back(std::move(operation));
    }

    /// Its number; the name is made if there is none yet.
    std::size_t file_of(const std::string& name, bool was_there, std::string content) {
        const std::scoped_lock lock{in_use};
        const auto known = names.find(name);
        if (known != names.end()) {
            return known->second;
        }
        const auto file = log.at_first.size();
        log.at_first.push_back(std::move(content));
        names[name] = file;
        if (was_there) {
            log.names[name] = file;
        } else {
            log.operations.push_back({.kind = Kind::link, .file = file, .name = name});
        }
        return file;
    }
};

namespace {

using Vfs = FaultyDisk::Vfs;

struct File {
    sqlite3_file base;
    Vfs* vfs;
    std::size_t number;
    bool is_logged;    ///< temporary files are not
    bool syncs_folder; ///< with its next sync
    sqlite3_file* below() { return reinterpret_cast<sqlite3_file*>(this + 1); }
};

File& file_in(sqlite3_file* file) {
    return *reinterpret_cast<File*>(file);
}

template <auto method, typename... Values>
int pass_on(sqlite3_file* file, Values... values) {
    auto* const below = file_in(file).below();
    return (below->pMethods->*method)(below, values...);
}

int close_file(sqlite3_file* file) {
    return pass_on<&sqlite3_io_methods::xClose>(file);
}

int read_file(sqlite3_file* file, void* to, int size, sqlite3_int64 offset) {
    if (file_in(file).vfs->fails(false, false)) {
        return SQLITE_IOERR_READ;
    }
    return pass_on<&sqlite3_io_methods::xRead>(file, to, size, offset);
}

int write_bytes(sqlite3_file* file, const void* from, int size, sqlite3_int64 offset) {
    const int code = pass_on<&sqlite3_io_methods::xWrite>(file, from, size, offset);
    if (auto& self = file_in(file); code == SQLITE_OK && self.is_logged) {
        self.vfs->note({.kind = Kind::write,
                        .file = self.number,
                        .offset = offset,
                        .bytes = {static_cast<const char*>(from), static_cast<std::size_t>(size)}});
    }
    return code;
}

int write_file(sqlite3_file* file, const void* from, int size, sqlite3_int64 offset) {
    auto& vfs = *file_in(file).vfs;
    if (vfs.fails(true, false)) {
        write_bytes(file, from, size / 2, offset);
        return vfs.is_full() ? SQLITE_FULL : SQLITE_IOERR_WRITE;
    }
    return write_bytes(file, from, size, offset);
}

int truncate_file(sqlite3_file* file, sqlite3_int64 size) {
    auto& self = file_in(file);
    if (self.vfs->fails(false, false)) {
        return SQLITE_IOERR_TRUNCATE;
    }
    const int code = pass_on<&sqlite3_io_methods::xTruncate>(file, size);
    if (code == SQLITE_OK && self.is_logged) {
        self.vfs->note({.kind = Kind::truncate, .file = self.number, .offset = size});
    }
    return code;
}

int sync_file(sqlite3_file* file, int /*flags*/) {
    auto& self = file_in(file);
    if (self.vfs->fails(false, true)) {
        return SQLITE_IOERR_FSYNC;
    }
    if (self.is_logged) {
        self.vfs->note({.kind = Kind::sync, .file = self.number});
        if (std::exchange(self.syncs_folder, false)) {
            self.vfs->note({.kind = Kind::sync_folder});
        }
    }
    return SQLITE_OK;
}

int map_shared(sqlite3_file* file, int page, int size, int extends, void volatile** to) {
    if (file_in(file).vfs->fails(extends != 0, false)) {
        return SQLITE_IOERR_SHMSIZE;
    }
    return pass_on<&sqlite3_io_methods::xShmMap>(file, page, size, extends, to);
}

void barrier(sqlite3_file* file) {
    auto* const below = file_in(file).below();
    below->pMethods->xShmBarrier(below);
}

/// Without xFetch: what is read or written passes through here.
const sqlite3_io_methods methods{
    .iVersion = 2,
    .xClose = close_file,
    .xRead = read_file,
    .xWrite = write_file,
    .xTruncate = truncate_file,
    .xSync = sync_file,
    .xFileSize = pass_on<&sqlite3_io_methods::xFileSize>,
    .xLock = pass_on<&sqlite3_io_methods::xLock>,
    .xUnlock = pass_on<&sqlite3_io_methods::xUnlock>,
    .xCheckReservedLock = pass_on<&sqlite3_io_methods::xCheckReservedLock>,
    .xFileControl = pass_on<&sqlite3_io_methods::xFileControl>,
    .xSectorSize = pass_on<&sqlite3_io_methods::xSectorSize>,
    .xDeviceCharacteristics = pass_on<&sqlite3_io_methods::xDeviceCharacteristics>,
    .xShmMap = map_shared,
    .xShmLock = pass_on<&sqlite3_io_methods::xShmLock>,
    .xShmBarrier = barrier,
    .xShmUnmap = pass_on<&sqlite3_io_methods::xShmUnmap>,
    .xFetch = nullptr,
    .xUnfetch = nullptr,
};

Vfs& vfs_in(sqlite3_vfs* vfs) {
    return *static_cast<Vfs*>(vfs->pAppData);
}

int open_file(sqlite3_vfs* vfs, const char* name, sqlite3_file* file, int flags, int* flags_out) {
    auto& disk = vfs_in(vfs);
    auto* const self = new (file) File{};
    self->vfs = &disk;
    if (disk.fails((flags & SQLITE_OPEN_CREATE) != 0, false)) {
        return SQLITE_CANTOPEN;
    }
    const bool was_there = name != nullptr && std::filesystem::exists(name);
    auto content = was_there ? content_of(name) : std::string{};
    const int code = disk.below->xOpen(disk.below, name, self->below(), flags, flags_out);
    if (code != SQLITE_OK) {
        return code;
    }
    self->is_logged = name != nullptr && (flags & SQLITE_OPEN_DELETEONCLOSE) == 0;
    if (self->is_logged) {
        self->number = disk.file_of(name, was_there, std::move(content));
    }
    self->syncs_folder =
        (flags & SQLITE_OPEN_CREATE) != 0 &&
        (flags & (SQLITE_OPEN_MAIN_JOURNAL | SQLITE_OPEN_SUPER_JOURNAL | SQLITE_OPEN_WAL)) != 0;
    self->base.pMethods = &methods;
    return SQLITE_OK;
}

int delete_file(sqlite3_vfs* vfs, const char* name, int syncs_folder) {
    auto& disk = vfs_in(vfs);
    if (disk.fails(false, syncs_folder != 0)) {
        return SQLITE_IOERR_DELETE;
    }
    const int code = disk.below->xDelete(disk.below, name, 0);
    if (code == SQLITE_OK) {
        const std::scoped_lock lock{disk.in_use};
        disk.names.erase(name);
        disk.note({.kind = Kind::unlink, .name = name});
        if (syncs_folder != 0) {
            disk.note({.kind = Kind::sync_folder});
        }
    }
    return code;
}

int last_error(sqlite3_vfs* vfs, int size, char* to) {
    auto& disk = vfs_in(vfs);
    const int below = disk.below->xGetLastError(disk.below, size, to);
    return disk.has_failed ? disk.last_errno : below;
}

sqlite3_vfs vfs_above(sqlite3_vfs& below, Vfs& disk) {
    auto above = below; // what is not replaced looks at no file, or changes none
    above.szOsFile = static_cast<int>(sizeof(File)) + below.szOsFile;
    above.zName = "macadam-faults";
    above.pNext = nullptr;
    above.pAppData = &disk;
    above.xOpen = open_file;
    above.xDelete = delete_file;
    above.xGetLastError = last_error;
    return above;
}

} // namespace

FaultyDisk::FaultyDisk() : vfs_{std::make_unique<Vfs>()} {
    vfs_->below = sqlite3_vfs_find(nullptr);
    vfs_->above = vfs_above(*vfs_->below, *vfs_);
    sqlite3_vfs_register(&vfs_->above, 1);
}

FaultyDisk::~FaultyDisk() {
    sqlite3_vfs_unregister(&vfs_->above);
    sqlite3_vfs_register(vfs_->below, 1);
}

void FaultyDisk::plan(const FaultPlan& plan) {
    vfs_->plan = plan;
}

bool FaultyDisk::has_failed() const {
    return vfs_->has_failed;
}

const DiskLog& FaultyDisk::log() const {
    return vfs_->log;
}

} // namespace macadam::testing
