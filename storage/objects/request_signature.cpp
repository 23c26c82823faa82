#include "storage/objects/request_signature.hpp"

#include "storage/files/sha256.hpp"
#include "storage/text/text.hpp"

#include <fmt/format.h>
#include <openssl/evp.h>
#include <openssl/hmac.h>

#include <algorithm>
#include <array>
#include <new>

namespace macadam {
namespace {

std::string encoded(std::string_view text, std::string_view kept) {
    std::string out;
    for (const unsigned char c : text) {
        const bool is_kept = (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') ||
                             (c >= '0' && c <= '9') ||
                             kept.find(static_cast<char>(c)) != std::string_view::npos;
        out += is_kept ? std::string(1, static_cast<char>(c)) : fmt::format("%{:02X}", c);
    }
    return out;
}

std::string sha256_of(std::string_view text) {
    Sha256 hash;
    hash.add(text);
    return hash.hex();
}

std::string hmac_of(std::string_view key, std::string_view text) {
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
    unsigned size = 0;
    if (HMAC(EVP_sha256(),
             key.data(),
             static_cast<int>(key.size()),
             reinterpret_cast<const unsigned char*>(text.data()), // NOLINT(*-reinterpret-cast)
             text.size(),
             digest.data(),
             &size) == nullptr) {
        throw std::bad_alloc{};
    }
    return {digest.begin(), digest.begin() + size};
}

std::string hex_of(std::string_view bytes) {
    std::string digits;
    for (const unsigned char byte : bytes) {
        digits += fmt::format("{:02x}", byte);
    }
    return digits;
}

/// "host;x-amz-date", and the lines "host:...\n".
struct CanonicalHeaders {
    std::string names;
    std::string lines;
};

CanonicalHeaders canonical_headers(const S3Request& request) {
    auto headers = request.headers;
    std::ranges::sort(headers);
    CanonicalHeaders canonical;
    for (const auto& [name, value] : headers) {
        canonical.names += (canonical.names.empty() ? "" : ";") + name;
        canonical.lines += fmt::format("{}:{}\n", name, trimmed(value));
    }
    return canonical;
}

} // namespace

std::string encoded_path(std::string_view path) {
    return encoded(path, "-._~/");
}

std::string canonical_request(const S3Request& request) {
    std::vector<std::pair<std::string, std::string>> query;
    for (const auto& [name, value] : request.query) {
        query.emplace_back(encoded(name, "-._~"), encoded(value, "-._~"));
    }
    std::ranges::sort(query);
    std::string parameters;
    for (const auto& [name, value] : query) {
        parameters += fmt::format("{}{}={}", parameters.empty() ? "" : "&", name, value);
    }
    const auto headers = canonical_headers(request);
    return fmt::format("{}\n{}\n{}\n{}\n{}\n{}",
                       request.method,
                       encoded_path(request.path),
                       parameters,
                       headers.lines,
                       headers.names,
                       request.payload_sha256);
}

std::string authorization_of(const S3Request& request,
                             const S3Credentials& credentials,
                             const SignatureScope& scope) {
    const auto day = scope.time.substr(0, 8);
    const auto where = fmt::format("{}/{}/{}/aws4_request", day, scope.region, scope.service);
    const auto to_sign = fmt::format(
        "AWS4-HMAC-SHA256\n{}\n{}\n{}", scope.time, where, sha256_of(canonical_request(request)));
    auto key = hmac_of("AWS4" + credentials.secret, day);
    for (const std::string_view part : {std::string_view{scope.region},
                                        std::string_view{scope.service},
                                        std::string_view{"aws4_request"}}) {
        key = hmac_of(key, part);
    }
    return fmt::format("AWS4-HMAC-SHA256 Credential={}/{},SignedHeaders={},Signature={}",
                       credentials.key_id,
                       where,
                       canonical_headers(request).names,
                       hex_of(hmac_of(key, to_sign)));
}

} // namespace macadam
