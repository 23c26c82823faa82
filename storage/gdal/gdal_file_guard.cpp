#include "storage/gdal/gdal_file_guard.hpp"

#include <cpl_conv.h>
#include <cpl_string.h>
#include <cpl_vsi_virtual.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <fstream>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {
namespace {

namespace fs = std::filesystem;

bool is_below(const fs::path& folder, const fs::path& file) {
    return std::ranges::mismatch(folder, file).in1 == folder.end();
}

fs::path plain(const fs::path& file) {
    std::error_code no_name; // empty path
    return fs::absolute(file, no_name).lexically_normal();
}

/// Tests for formats that refer to other files; sidecar files must not be of these kinds.
bool leads_on(const fs::path& file) {
    std::array<char, 2048> head{};
    std::ifstream in{file, std::ios::binary};
    in.read(head.data(), std::ssize(head));
    const std::string_view text{head.data(), static_cast<std::size_t>(in.gcount())};
    return text.starts_with("SQLite format 3") || text.find("<VRT") != text.npos ||
           text.find("<OGRVRT") != text.npos;
}

/// Paths that GDAL may open.
class Permissions {
public:
    static Permissions& of_process() {
        static auto* const one = new Permissions; // GDAL uses it until the process ends
        return *one;
    }

    void let_read(const fs::path& file) {
        const std::lock_guard lock{mutex_};
        const auto path = plain(file);
        std::error_code none;
        folders_.insert(path.parent_path());
        stems_[path.parent_path() / path.stem()] = {fs::canonical(path.parent_path(), none),
                                                    fs::canonical(path, none).parent_path()};
        files_.insert(path);
    }

    void let_read_folder(const fs::path& folder) {
        const std::lock_guard lock{mutex_};
        readable_.insert(fs::canonical(folder));
    }

    void let_write(const fs::path& folder) {
        const std::lock_guard lock{mutex_};
        readable_.insert(fs::canonical(folder));
        writable_.insert(fs::canonical(folder));
    }

    bool is_readable(const fs::path& path) const {
        const std::lock_guard lock{mutex_};
        std::error_code error;
        const auto found = fs::canonical(path, error);
        if (error) {
            return false;
        }
        if (lies_in(readable_, found)) {
            return fs::is_regular_file(found, error) || fs::is_directory(found, error);
        }
        const auto* const homes = homes_of(path);
        return homes != nullptr && fs::is_regular_file(found, error) &&
               std::ranges::any_of(*homes,
                                   [&](const auto& home) { return is_below(home, found); }) &&
               (files_.contains(path) || !leads_on(found));
    }

    bool is_writable(const fs::path& path) const {
        const std::lock_guard lock{mutex_};
        std::error_code error;
        const auto found = fs::weakly_canonical(path, error);
        return !error && lies_in(writable_, found);
    }

    bool is_listed(const fs::path& folder) const {
        const std::lock_guard lock{mutex_};
        std::error_code error;
        return folders_.contains(folder) || lies_in(readable_, fs::canonical(folder, error));
    }

private:
    /// Folders in which files of a stem may lie after all links are followed: that of the allowed
    /// file, or that of its link target.
    using Homes = std::array<fs::path, 2>;

    const Homes* homes_of(const fs::path& path) const {
        const auto name = path.filename().string();
        for (auto end = name.find('.', 1);; end = name.find('.', end + 1)) {
            const auto found = stems_.find(path.parent_path() / name.substr(0, end));
            if (found != stems_.end()) {
                return &found->second;
            }
            if (end == std::string::npos) {
                return nullptr;
            }
        }
    }

    static bool lies_in(const std::set<fs::path>& folders, const fs::path& found) {
        return std::ranges::any_of(folders,
                                   [&](const auto& folder) { return is_below(folder, found); });
    }

    mutable std::mutex mutex_;
    std::set<fs::path> files_, folders_, readable_, writable_;
    std::map<fs::path, Homes> stems_;
};

int refuse() {
    errno = ENOENT;
    return -1;
}

/// File system without files.
class NoFiles : public VSIFilesystemHandler {
public:
    VSIVirtualHandle* Open(const char* /*name*/,
                           const char* /*access*/,
                           bool /*says_why*/,
                           CSLConstList /*options*/) override {
        refuse();
        return nullptr;
    }
    int Stat(const char* /*name*/, VSIStatBufL* /*found*/, int /*flags*/) override {
        return refuse();
    }
};

/// Disk access restricted to the permitted paths.
class GuardedDisk : public VSIFilesystemHandler {
public:
    explicit GuardedDisk(VSIFilesystemHandler* disk) : disk_{disk} {}

    VSIVirtualHandle*
    Open(const char* name, const char* access, bool says_why, CSLConstList options) override {
        const auto path = plain(name);
        const bool writes = std::string_view{access}.find_first_of("wa+") != std::string_view::npos;
        if (writes ? !may_.is_writable(path) : !may_.is_readable(path)) {
            refuse();
            return nullptr;
        }
        return disk_->Open(path.c_str(), access, says_why, options);
    }

    int Stat(const char* name, VSIStatBufL* found, int flags) override {
        const auto path = plain(name);
        return may_.is_readable(path) || may_.is_listed(path)
                   ? disk_->Stat(path.c_str(), found, flags)
                   : refuse();
    }

    char** ReadDirEx(const char* name, int max_files) override {
        const auto path = plain(name);
        return may_.is_listed(path) ? disk_->ReadDirEx(path.c_str(), max_files) : nullptr;
    }

    int Unlink(const char* name) override {
        const auto path = plain(name);
        return may_.is_writable(path) ? disk_->Unlink(path.c_str()) : refuse();
    }

    int Rename(const char* from, const char* to) override {
        const auto source = plain(from);
        const auto target = plain(to);
        return may_.is_writable(source) && may_.is_writable(target)
                   ? disk_->Rename(source.c_str(), target.c_str())
                   : refuse();
    }

    int SupportsSparseFiles(const char* name) override { return disk_->SupportsSparseFiles(name); }
    GIntBig GetDiskFreeSpace(const char* name) override { return disk_->GetDiskFreeSpace(name); }

private:
    const Permissions& may_ = Permissions::of_process();
    std::unique_ptr<VSIFilesystemHandler> disk_;
};

void install() {
    // GDAL's own tables of coordinate systems, wherever they are installed.
    if (const char* const own = CPLFindFile("gdal", "gdalvrt.xsd")) {
        let_read_folder(fs::path{own}.parent_path());
    }
    VSIFileManager::InstallHandler("", new GuardedDisk{VSIFileManager::GetHandler("")});
    // Keeps the replaced handlers alive: GDAL forgets them, but copies of the pointers remain in
    // use.
    static auto* const before = new std::vector<VSIFilesystemHandler*>;
    const CPLStringList systems{VSIGetFileSystemsPrefixes()};
    for (int i = 0; i < systems.Count(); ++i) {
        const std::string system = systems[i];
        // Memory files, which drivers create themselves, and parts of files stay available.
        if (!system.empty() && system != "/vsimem/" && system != "/vsisubfile/") {
            before->push_back(VSIFileManager::GetHandler(system.c_str()));
            VSIFileManager::InstallHandler(system, new NoFiles);
        }
    }
}

} // namespace

void guard_files() {
    static std::once_flag once;
    std::call_once(once, install);
}

void let_read(const fs::path& file) {
    Permissions::of_process().let_read(file);
}

void let_read_folder(const fs::path& folder) {
    Permissions::of_process().let_read_folder(folder);
}

void let_write(const fs::path& folder) {
    Permissions::of_process().let_write(folder);
}

} // namespace macadam
