#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace macadam {

/// Key of an account of an S3-compatible service.
struct S3Credentials {
    std::string key_id;
    std::string secret;
    std::string session_token{}; ///< of temporary keys; "" = none
};

/// HTTP request to be signed.
struct S3Request {
    std::string method;
    std::string path; ///< not encoded, from '/'
    std::vector<std::pair<std::string, std::string>> query{};
    std::vector<std::pair<std::string, std::string>>
        headers{};              ///< with "host"; names in lower case
    std::string payload_sha256; ///< of the body, in hex digits
};

/// Scope in which a signature is valid: place and time.
struct SignatureScope {
    std::string region;
    std::string service = "s3";
    std::string time; ///< "20130524T000000Z"
};

/// SHA-256 of no bytes.
inline constexpr std::string_view sha256_of_nothing =
    "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855";

/// Encodes all bytes of a path but letters, digits, '-', '.', '_', '~' and '/'.
std::string encoded_path(std::string_view path);

/// Text of a request from which it is signed.
std::string canonical_request(const S3Request& request);

/// Computes the value of header Authorization by AWS Signature Version 4.
///
/// Source: Amazon S3 API Reference, "Authenticating Requests (AWS Signature Version 4)",
/// 2006-03-01.
std::string authorization_of(const S3Request& request,
                             const S3Credentials& credentials,
                             const SignatureScope& scope);

} // namespace macadam
