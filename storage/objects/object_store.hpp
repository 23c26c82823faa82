#pragma once

#include "estimator/common/error.hpp"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <stop_token>
#include <string>
#include <string_view>

namespace macadam {

/// Trip log, or archive of logs, as an object: its name is the SHA-256 of its bytes.
struct LogObject {
    std::string sha256; ///< 64 lower-case hex digits
    std::int64_t bytes = 0;
};

/// An object is missing, or has other bytes than expected. Every other failure is one of the store
/// or of the way to it, whatever object was asked for.
struct UnusableObject : InputError {
    using InputError::InputError;
};

/// Store from which workers on other machines fetch trip logs: a folder, or a bucket of an
/// S3-compatible service. Used by one thread at a time.
///
/// \throws InputError  from every call that fails; the message names the store and the cause.
class ObjectStore {
public:
    ObjectStore() = default;
    ObjectStore(const ObjectStore&) = delete;
    ObjectStore& operator=(const ObjectStore&) = delete;
    virtual ~ObjectStore() = default;

    /// Stores the bytes of a file, also over an object that is there. When this returns, the object
    /// is whole and durable.
    ///
    /// \throws InputError  also if the bytes are not those of `object`; then nothing is stored.
    virtual void put(const LogObject& object, const std::filesystem::path& file) = 0;

    /// Writes an object to a new file, at most `object.bytes` of it.
    ///
    /// \throws UnusableObject  if it is missing or its bytes are others. No file is left after an
    ///                         error.
    virtual void fetch(const LogObject& object, const std::filesystem::path& file) = 0;

    /// Removes an object, if it is there.
    virtual void remove(std::string_view sha256) = 0;

    /// Tests whether the store is where it was: a folder of another machine may not be mounted.
    ///
    /// \throws InputError  if it is not.
    virtual void expect_in_place() const {}
};

enum class MissingFolder {
    make,  ///< for those who store
    refuse ///< for those who fetch: the objects are elsewhere
};

/// Opens the store of `s3://BUCKET[/PREFIX]` or of a folder.
///
/// \param stop  ends waiting for a service
/// \throws InputError  for another kind of address, a folder that is missing or was never stored
///                     to, or without credentials for a bucket.
std::unique_ptr<ObjectStore> open_object_store(const std::string& location,
                                               std::stop_token stop = {},
                                               MissingFolder missing = MissingFolder::make);

/// Returns the location as workers started in other folders find it: a folder's absolute path.
std::string absolute_location(const std::string& location);

} // namespace macadam
