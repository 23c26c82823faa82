#pragma once

#include "storage/files/byte_stream.hpp"
#include "storage/files/sha256.hpp"
#include "storage/objects/object_store.hpp"

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace macadam {

/// File that becomes an object, read and hashed in blocks.
class ObjectSource {
public:
    /// \throws InputError  if the file cannot be read.
    explicit ObjectSource(const std::filesystem::path& file) : from_{file_bytes(file)} {}

    /// Fills the front of `into`. \returns the number of bytes; 0 at the end.
    std::size_t read(std::span<char> into);

    /// Checks, at the end, that the bytes were those of an object.
    /// \throws InputError  if not: the file has changed.
    void expect(const LogObject& object, const std::filesystem::path& file);

private:
    std::unique_ptr<ByteStream> from_;
    Sha256 hash_;
    std::int64_t bytes_ = 0;
    std::string sha256_; ///< once it was asked for
};

/// New file that an object is fetched into, hashed as it comes. It is removed unless keep() finds
/// the expected bytes.
class FetchedFile {
public:
    /// \throws InputError  if the file exists or cannot be made.
    FetchedFile(LogObject object, std::filesystem::path file);
    FetchedFile(const FetchedFile&) = delete;
    FetchedFile& operator=(const FetchedFile&) = delete;
    ~FetchedFile();

    /// \returns false if the object is longer than expected; then the rest is not wanted.
    /// \throws InputError  if the file cannot be written.
    bool add(std::string_view bytes);

    /// \throws UnusableObject  if bytes are missing, surplus or others.
    void keep(const std::string& store);

private:
    LogObject object_;
    std::filesystem::path file_;
    std::FILE* out_ = nullptr;
    Sha256 hash_;
    std::int64_t bytes_ = 0;
    bool is_kept_ = false;
};

} // namespace macadam
