#pragma once

#include "app/http/http_message.hpp"

#include <cstddef>
#include <list>
#include <memory>
#include <mutex>
#include <string>

namespace macadam {

/// Files of pages in gzip, compressed when they are first asked for, and kept in memory: the
/// folder belongs to its owner. Thread-safe.
class CompressedFiles {
public:
    /// \param max_bytes  of all that are kept, compressed
    explicit CompressedFiles(std::size_t max_bytes = std::size_t{32} << 20U)
        : max_bytes_{max_bytes} {}

    /// Returns the content of a file in gzip; null if the file is larger than max_file_bytes, is
    /// being written to, or cannot be read.
    /// \param name  changes with the content, such as its ETag
    std::shared_ptr<const std::string> get(const std::string& name, const HttpFile& file);

    static constexpr std::size_t max_file_bytes = std::size_t{8} << 20U;

private:
    struct Kept {
        std::string name;
        std::shared_ptr<const std::string> bytes;
    };
    std::shared_ptr<const std::string> find(const std::string& name);
    void keep(const std::string& name, std::shared_ptr<const std::string> bytes);

    std::size_t max_bytes_;
    std::mutex mutex_;       ///< guards the two below
    std::list<Kept> recent_; ///< latest first
    std::size_t bytes_ = 0;
};

} // namespace macadam
