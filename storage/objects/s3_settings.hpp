#pragma once

#include "storage/objects/request_signature.hpp"

#include <string>

namespace macadam {

/// Bucket of an S3-compatible service, and how to reach it.
struct S3Settings {
    std::string location; ///< "s3://bucket/prefix", for messages
    std::string scheme;   ///< "https", or "http" on this machine
    std::string host;     ///< with the port: "s3.eu-central-1.amazonaws.com"
    std::string path;     ///< "/bucket/prefix/", or "/prefix/" where the bucket is part of the host
    std::string region;   ///< "us-east-1"
    S3Credentials credentials;
};

/// Reads `s3://BUCKET[/PREFIX]` and the variables of the environment that other programs for S3
/// use: AWS_ENDPOINT_URL_S3 or AWS_ENDPOINT_URL (Amazon if neither is set), AWS_REGION or
/// AWS_DEFAULT_REGION, AWS_ACCESS_KEY_ID, AWS_SECRET_ACCESS_KEY and AWS_SESSION_TOKEN or, without
/// these, profile AWS_PROFILE of the file AWS_SHARED_CREDENTIALS_FILE (~/.aws/credentials). Keys
/// are never part of an address or of a command line.
///
/// \throws InputError  for a malformed address or endpoint, one without TLS on another machine, a
///                     file of keys that others can read, or if there are no keys.
S3Settings s3_settings_of(const std::string& location);

} // namespace macadam
