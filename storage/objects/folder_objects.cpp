#include "storage/objects/folder_objects.hpp"

#include "estimator/common/error.hpp"
#include "storage/atomic/atomic_file.hpp"
#include "storage/objects/object_file.hpp"

#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace macadam {
namespace {

namespace fs = std::filesystem;

constexpr const char* mark = ".macadam-objects"; // not in an empty mount point
constexpr std::size_t block_bytes = 64 << 10;

[[noreturn]] void fail(const fs::path& path, std::string_view doing, int error) {
    throw InputError{fmt::format("{}: {}: {}", path.string(), doing, std::strerror(error))};
}

void sync(const fs::path& folder) {
    const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    const bool is_synced = descriptor >= 0 && ::fsync(descriptor) == 0;
    const int error = errno;
    if (descriptor >= 0) {
        ::close(descriptor);
    }
    if (!is_synced) {
        fail(folder, "cannot be synced", error);
    }
}

/// Gives a new file or folder all rights of the store, of which the umask may have taken some.
void give_rights(const fs::path& made, mode_t rights) {
    constexpr mode_t all_rights = 0777;
    struct stat status {};
    if (::stat(made.c_str(), &status) != 0 ||
        ((status.st_mode & all_rights) != rights &&
         ::chmod(made.c_str(), (status.st_mode & ~all_rights) | rights) != 0)) {
        fail(made, "cannot be given the rights of its folder", errno);
    }
}

class FolderObjects final : public ObjectStore {
public:
    FolderObjects(fs::path root, MissingFolder missing) : root_{std::move(root)} {
        constexpr mode_t owner_alone = 0700;
        if (missing == MissingFolder::refuse) {
            expect_in_place();
        } else if (::mkdir(root_.c_str(), owner_alone) != 0 && errno != EEXIST) {
            fail(root_, "cannot be made", errno);
        }
        struct stat status {};
        if (::stat(root_.c_str(), &status) != 0) {
            fail(root_, "cannot be read", errno);
        }
        if (!S_ISDIR(status.st_mode)) {
            throw InputError{
                fmt::format("{}: is a file, expected a folder for objects", root_.string())};
        }
        mode_ = status.st_mode & 0777U;
        if (missing == MissingFolder::make && !is_marked()) {
            make(root_ / mark);
        }
    }

    void put(const LogObject& object, const fs::path& file) override {
        const auto path = path_of(object.sha256);
        make(path.parent_path().parent_path());
        make(path.parent_path());
        AtomicFile out{path, mode_ & 0666U};
        ObjectSource from{file};
        std::array<char, block_bytes> block; // NOLINT(*-member-init)
        while (const auto count = from.read(block)) {
            out.write({block.data(), count});
        }
        from.expect(object, file);
        out.commit();
        give_rights(path, mode_ & 0666U);
    }

    void fetch(const LogObject& object, const fs::path& file) override {
        const auto path = path_of(object.sha256);
        if (std::error_code unknown; !fs::exists(path, unknown) && !unknown) {
            expect_in_place();
            throw UnusableObject{
                fmt::format("{}: object {} is missing", root_.string(), object.sha256)};
        }
        FetchedFile to{object, file};
        const auto from = file_bytes(path);
        std::array<char, block_bytes> block; // NOLINT(*-member-init)
        while (const auto count = from->read(block)) {
            if (!to.add({block.data(), count})) {
                break;
            }
        }
        to.keep(root_.string());
    }

    void remove(std::string_view sha256) override {
        const auto path = path_of(sha256);
        if (::unlink(path.c_str()) == 0) {
            return;
        }
        if (errno != ENOENT) {
            fail(path, "cannot be removed", errno);
        }
        expect_in_place();
    }

    void expect_in_place() const override {
        std::error_code unknown;
        if (!fs::exists(root_, unknown)) {
            throw InputError{
                fmt::format("{}: is no folder here, expected the objects that 'macadam "
                            "submit' stored; is it mounted?",
                            root_.string())};
        }
        if (fs::is_directory(root_, unknown) && !is_marked()) {
            throw InputError{fmt::format("{}: has no {}, expected the folder to which 'macadam "
                                         "submit' stored; is it mounted?",
                                         root_.string(),
                                         mark)};
        }
    }

private:
    bool is_marked() const {
        std::error_code unknown;
        return fs::is_directory(root_ / mark, unknown);
    }

    fs::path path_of(std::string_view sha256) const {
        return root_ / sha256.substr(0, 2) / sha256.substr(2, 2) / sha256;
    }

    /// Makes a subfolder with the rights of the store, durably.
    void make(const fs::path& folder) const {
        if (::mkdir(folder.c_str(), mode_) == 0) {
            give_rights(folder, mode_);
        } else if (errno != EEXIST) {
            fail(folder, "cannot be made", errno);
        }
        sync(folder.parent_path()); // another program may have made it just now
    }

    fs::path root_;
    unsigned mode_ = 0;
};

} // namespace

std::unique_ptr<ObjectStore> open_folder_objects(const fs::path& folder, MissingFolder missing) {
    return std::make_unique<FolderObjects>(folder, missing);
}

} // namespace macadam
