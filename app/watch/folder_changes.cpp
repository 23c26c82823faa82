#include "app/watch/folder_changes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <system_error>
#include <utility>

#include <poll.h>
#include <sys/inotify.h>
#include <sys/vfs.h>
#include <unistd.h>

namespace macadam {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr std::uint32_t changes_of_interest =
    IN_CLOSE_WRITE | IN_MOVED_TO | IN_CREATE | IN_DELETE_SELF | IN_MOVE_SELF | IN_ONLYDIR;

/// Tests for file systems whose files other computers or programs change unnoticed. Source: their
/// numbers in statfs(2) and linux/magic.h.
bool is_remote(const fs::path& folder) {
    constexpr std::array<std::uint32_t, 7> remote{0x6969,      // NFS
                                                  0x517b,      // SMB
                                                  0xff534d42,  // CIFS
                                                  0xfe534d42,  // SMB2
                                                  0x65735546,  // FUSE, such as sshfs
                                                  0x01021997,  // 9P, as in WSL
                                                  0x00c36400}; // Ceph
    struct statfs system {};
    return ::statfs(folder.c_str(), &system) == 0 &&
           std::ranges::find(remote, static_cast<std::uint32_t>(system.f_type)) != remote.end();
}

} // namespace

FolderChanges::FolderChanges(fs::path folder, std::string blindness)
    : folder_{std::move(folder)}, blindness_{std::move(blindness)} {
    if (blindness_.empty() && is_remote(folder_)) {
        blindness_ = "is on a network file system";
    }
    if (blindness_.empty()) {
        watch_anew();
    }
}

FolderChanges::~FolderChanges() {
    if (inotify_ >= 0) {
        ::close(inotify_);
    }
}

void FolderChanges::give_up(std::string reason) {
    blindness_ = fmt::format("cannot be watched by inotify: {}", reason);
    if (inotify_ >= 0) {
        ::close(inotify_);
        inotify_ = -1;
    }
    folders_.clear();
}

void FolderChanges::watch_folder(const fs::path& folder) {
    if (inotify_ < 0) {
        return;
    }
    const int watch = ::inotify_add_watch(inotify_, folder.c_str(), changes_of_interest);
    if (watch >= 0) {
        folders_[watch] = folder;
    } else if (errno != ENOENT && errno != ENOTDIR) { // it may have gone meanwhile
        give_up(std::strerror(errno));
    }
}

/// Watches a folder and those below it. A folder made meanwhile is found by its parent's event.
void FolderChanges::watch_tree(const fs::path& folder) {
    watch_folder(folder);
    std::error_code gone;
    fs::recursive_directory_iterator below{
        folder, fs::directory_options::skip_permission_denied, gone};
    for (; !gone && below != fs::recursive_directory_iterator{}; below.increment(gone)) {
        if (below->is_directory(gone) && !below->is_symlink(gone)) {
            watch_folder(below->path());
        }
    }
}

/// Watches the folder from the beginning, without the events that are queued.
void FolderChanges::watch_anew() {
    if (inotify_ >= 0) {
        ::close(inotify_);
    }
    folders_.clear();
    inotify_ = ::inotify_init1(IN_CLOEXEC | IN_NONBLOCK);
    if (inotify_ < 0) {
        give_up(std::strerror(errno));
    } else {
        watch_tree(folder_);
    }
}

void FolderChanges::read_events(std::set<fs::path>& closed) {
    alignas(inotify_event) std::array<char, 65536> buffer;
    ssize_t size = 0;
    bool is_lost = false;
    while (inotify_ >= 0 && (size = ::read(inotify_, buffer.data(), buffer.size())) > 0) {
        for (std::size_t at = 0; at < static_cast<std::size_t>(size);) {
            inotify_event event{};
            std::memcpy(&event, buffer.data() + at, sizeof event);
            const char* const name = buffer.data() + at + sizeof event;
            at += sizeof event + event.len;
            const auto folder = folders_.find(event.wd);
            if (folder == folders_.end()) {
                is_lost = is_lost || (event.mask & IN_Q_OVERFLOW) != 0;
                continue;
            }
            const bool is_gone = (event.mask & (IN_IGNORED | IN_MOVE_SELF)) != 0;
            is_lost = is_lost || (is_gone && folder->second == folder_);
            if ((event.mask & IN_IGNORED) != 0) {
                folders_.erase(folder);
            } else if (event.len > 0 && (event.mask & IN_ISDIR) != 0) {
                watch_tree(fs::path{folder->second} / name);
            } else if (event.len > 0 && (event.mask & (IN_CLOSE_WRITE | IN_MOVED_TO)) != 0) {
                closed.insert(folder->second / name);
            }
        }
    }
    if (is_lost) {
        watch_anew();
    }
}

std::set<fs::path> FolderChanges::wait(std::chrono::milliseconds limit,
                                       const std::stop_token& stop) {
    constexpr auto look_every = 1000ms; // a signal ends poll() unless it came just before
    constexpr auto together = 500ms;    // a burst of files is looked at once
    std::set<fs::path> closed;
    auto end = Clock::now() + limit;
    while (!stop.stop_requested() && Clock::now() < end) {
        const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - Clock::now());
        pollfd events{.fd = inotify_, .events = POLLIN, .revents = 0}; // -1 is ignored
        const auto pause = std::clamp(left, 0ms, look_every);
        if (::poll(&events, 1, static_cast<int>(pause.count())) > 0) {
            end = std::min(end, Clock::now() + together);
            read_events(closed);
        }
    }
    return closed;
}

} // namespace macadam
