#pragma once

#include <cstdio>
#include <filesystem>
#include <string_view>

namespace macadam {

/// A file that appears when it is whole, or not at all: written under another name beside its
/// place, synced, then renamed. Without commit() nothing is left.
///
/// \throws InputError  from every call that fails; the message names the file and the cause.
class AtomicFile {
public:
    explicit AtomicFile(std::filesystem::path file);
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;
    ~AtomicFile();

    void write(std::string_view text);
    void commit();

    /// Where the content goes before commit(), for libraries that write by name.
    const std::filesystem::path& temporary() const { return temporary_; }

private:
    std::filesystem::path file_;
    std::filesystem::path temporary_;
    std::FILE* out_ = nullptr;
};

} // namespace macadam
