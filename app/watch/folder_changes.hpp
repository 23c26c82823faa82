#pragma once

#include <chrono>
#include <filesystem>
#include <map>
#include <set>
#include <stop_token>
#include <string>

namespace macadam {

/// Waits for changes below a folder: by inotify(7), or, on network file systems, which do not
/// report what other computers write, and where inotify fails, by time alone.
class FolderChanges {
public:
    /// \param blindness  reason not to use inotify; "": it is used if possible
    explicit FolderChanges(std::filesystem::path folder, std::string blindness = {});
    FolderChanges(const FolderChanges&) = delete;
    FolderChanges& operator=(const FolderChanges&) = delete;
    ~FolderChanges();

    /// Reason why changes are not noticed; "" if they are.
    const std::string& blindness() const { return blindness_; }

    /// Waits for a change, for `limit`, or for a stop request, which may take a second to notice.
    /// Changes that follow the first one within half a second are taken together. When the folder
    /// itself is moved or removed, or changes were lost because there were too many, it returns as
    /// after a change, and watches what has the folder's name now.
    ///
    /// \returns the files that were closed after writing, or moved here, since the last call, as
    /// far as they are known.
    std::set<std::filesystem::path> wait(std::chrono::milliseconds limit,
                                         const std::stop_token& stop);

private:
    void watch_folder(const std::filesystem::path& folder);
    void watch_tree(const std::filesystem::path& folder);
    void watch_anew();
    void give_up(std::string reason);
    void read_events(std::set<std::filesystem::path>& closed);

    std::filesystem::path folder_;
    int inotify_ = -1;
    std::map<int, std::filesystem::path> folders_; ///< by watch descriptor
    std::string blindness_;
};

} // namespace macadam
