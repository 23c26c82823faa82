#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <sys/types.h>

namespace macadam::testing {

/// S3-compatible service with a bucket `roads`, for one test: npm's s3rver (server.mjs). It ends
/// with this object, or with the test. Sets AWS_ENDPOINT_URL and keys in the environment.
class S3Service {
public:
    /// \param options  of server.mjs
    /// \throws std::runtime_error  if it does not start.
    explicit S3Service(const std::filesystem::path& folder,
                       const std::vector<std::string>& options = {});
    S3Service(const S3Service&) = delete;
    S3Service& operator=(const S3Service&) = delete;
    ~S3Service();

    int port() const { return port_; }

private:
    pid_t child_ = -1;
    int input_ = -1;
    int port_ = 0;
};

} // namespace macadam::testing
