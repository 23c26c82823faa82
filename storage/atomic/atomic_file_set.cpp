#include "storage/atomic/atomic_file_set.hpp"

#include "estimator/common/error.hpp"

#include <fmt/format.h>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <system_error>
#include <thread>
#include <utility>

namespace macadam {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& file, const std::string& cause) {
    throw InputError{fmt::format("{}: cannot be written: {}", file.string(), cause)};
}

void sync(const fs::path& name, const fs::path& file) {
    const int descriptor = ::open(name.c_str(), O_RDONLY | O_CLOEXEC);
    const bool done = descriptor >= 0 && ::fsync(descriptor) == 0;
    const int error = errno;
    if (descriptor >= 0) {
        ::close(descriptor);
    }
    if (!done) {
        fail(file, std::strerror(error));
    }
}

fs::path parent_of(const fs::path& file) {
    return file.has_parent_path() ? file.parent_path() : fs::path{"."};
}

/// Moves that can be undone in reverse order.
class Moves {
public:
    Moves() = default;
    Moves(const Moves&) = delete;
    Moves& operator=(const Moves&) = delete;
    ~Moves() {
        std::error_code ignored;
        for (auto move = moves_.rbegin(); move != moves_.rend(); ++move) {
            fs::rename(move->second, move->first, ignored);
        }
    }

    void move(const fs::path& from, const fs::path& to) {
        std::error_code error;
        fs::rename(from, to, error);
        if (error) {
            fail(to, error.message());
        }
        moves_.emplace_back(from, to);
    }

    void are_final() { moves_.clear(); }

private:
    std::vector<std::pair<fs::path, fs::path>> moves_;
};

/// Syncs the files in the folder. \returns their names, in order.
std::vector<std::string> synced_names(const fs::path& folder, const fs::path& place) {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator{folder}) {
        names.push_back(entry.path().filename().string());
    }
    std::ranges::sort(names);
    for (const auto& name : names) {
        sync(folder / name, place / name);
    }
    return names;
}

void replace(const fs::path& from, const fs::path& to) {
    if (std::rename(from.c_str(), to.c_str()) != 0) {
        fail(to, std::strerror(errno));
    }
}

void move_together(const std::vector<std::string>& names,
                   const std::vector<std::string>& stale,
                   const fs::path& folder,
                   const fs::path& place) {
    const auto before = folder / "before";
    fs::create_directory(before);
    Moves moves;
    const auto set_aside = [&](const std::string& name) {
        std::error_code none;
        const auto there = fs::symlink_status(place / name, none);
        if (fs::is_directory(there)) {
            fail(place / name, std::strerror(EISDIR));
        }
        if (fs::exists(there)) {
            moves.move(place / name, before / name);
        }
    };
    std::ranges::for_each(names, set_aside);
    std::ranges::for_each(stale, set_aside);
    for (const auto& name : names) {
        moves.move(folder / name, place / name);
    }
    moves.are_final();
}

/// Target folder of the moves. It is opened before the first move, so that it can be synced even if
/// the limit of open files is reached.
class TargetFolder {
public:
    TargetFolder(const fs::path& folder, fs::path file)
        : file_{std::move(file)}, descriptor_{
                                      ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)} {
        if (descriptor_ < 0) {
            fail(file_, std::strerror(errno));
        }
    }
    TargetFolder(const TargetFolder&) = delete;
    TargetFolder& operator=(const TargetFolder&) = delete;
    ~TargetFolder() { ::close(descriptor_); }

    /// Locks the folder for the lifetime of this object.
    void lock() {
        constexpr auto wait_policy = std::chrono::milliseconds{1500};
        constexpr auto pause = std::chrono::milliseconds{5};
        const auto give_up = std::chrono::steady_clock::now() + wait_policy;
        while (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
            if (std::chrono::steady_clock::now() > give_up) {
                fail(file_,
                     "another program has been moving files into this folder for 1.5 s; end it "
                     "and run this command again");
            }
            std::this_thread::sleep_for(pause);
        }
    }

    void sync() {
        if (::fsync(descriptor_) != 0) {
            fail(file_, std::strerror(errno));
        }
    }

private:
    fs::path file_;
    int descriptor_;
};

} // namespace

AtomicFileSet::AtomicFileSet(fs::path main_file) : main_file_{std::move(main_file)} {
    if (fs::is_directory(main_file_)) {
        fail(main_file_, std::strerror(EISDIR));
    }
    try {
        folder_.emplace(main_file_);
    } catch (const std::system_error& error) {
        fail(main_file_, error.code().message());
    }
}

void AtomicFileSet::commit(const std::vector<std::string>& stale) {
    const auto place = parent_of(main_file_);
    const auto names = synced_names(folder(), place);
    TargetFolder opened{place, main_file_};
    opened.lock();              // one program at a time
    folder_->keep_if_cut_off(); // it briefly holds the replaced files
    if (names.size() == 1 && stale.empty()) {
        replace(folder() / names.front(), place / names.front());
    } else {
        move_together(names, stale, folder(), place);
    }
    opened.sync();
}

void AtomicFileSet::commit_new() {
    const auto place = parent_of(main_file_);
    synced_names(folder(), place);
    TargetFolder opened{place, main_file_};
    if (::renameat2(
            AT_FDCWD, main_file().c_str(), AT_FDCWD, main_file_.c_str(), RENAME_NOREPLACE) != 0) {
        if (errno == EEXIST) {
            throw InputError{fmt::format("{}: was created by another program in the meantime, "
                                         "expected the name of a new file",
                                         main_file_.string())};
        }
        if (errno != EINVAL && errno != ENOSYS) { // not supported by every file system
            fail(main_file_, std::strerror(errno));
        }
        replace(main_file(), main_file_);
    }
    opened.sync();
}

} // namespace macadam
