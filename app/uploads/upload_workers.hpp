#pragma once

#include "app/cli/console.hpp"
#include "app/uploads/upload_work.hpp"

#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <stop_token>
#include <thread>
#include <vector>

namespace macadam {

/// Threads that work out uploads (work_out_uploads) for as long as the object lives. They look for
/// uploads every second, also for those that other programs queue, and go on after errors, such as
/// of a locked database.
class UploadWorkers {
public:
    /// \param console  for warnings; each is given once until something else happens
    UploadWorkers(const UploadWork& work, std::size_t count, const Console& console);
    UploadWorkers(const UploadWorkers&) = delete;
    UploadWorkers& operator=(const UploadWorkers&) = delete;
    ~UploadWorkers();

    /// Tells of an upload, so that nobody waits for a second.
    void wake();

    /// Lets the threads end; what they did not finish waits for the next program.
    void request_stop();

private:
    void work(const UploadWork& work, const Console& console, const std::stop_token& stop);

    std::stop_source stop_;
    std::mutex mutex_; ///< guards woken_
    std::size_t woken_ = 0;
    std::condition_variable_any changed_;
    std::vector<std::jthread> threads_;
};

} // namespace macadam
