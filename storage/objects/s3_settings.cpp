#include "storage/objects/s3_settings.hpp"

#include "estimator/common/error.hpp"
#include "storage/text/text.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string_view>
#include <utility>

#include <sys/stat.h>

namespace macadam {
namespace {

constexpr std::string_view scheme_of_buckets = "s3://";
constexpr std::string_view lower_and_digits = "abcdefghijklmnopqrstuvwxyz0123456789";

std::string variable(const char* name) {
    const char* const value = std::getenv(name);
    return value != nullptr ? value : "";
}

std::string first_of(const std::string& a, const std::string& b, const std::string& otherwise) {
    return !a.empty() ? a : !b.empty() ? b : otherwise;
}

/// Rules of the names of buckets that serve in a host name, too.
bool is_bucket(std::string_view name) {
    constexpr std::size_t shortest = 3, longest = 63;
    return name.size() >= shortest && name.size() <= longest &&
           name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789.-") ==
               std::string_view::npos &&
           lower_and_digits.find(name.front()) != std::string_view::npos &&
           lower_and_digits.find(name.back()) != std::string_view::npos &&
           name.find("..") == std::string_view::npos;
}

/// "a/b/": of letters, digits and "._-", without empty or relative parts.
std::optional<std::string> prefix_in(std::string_view text) {
    std::string prefix;
    while (!text.empty()) {
        const auto slash = text.find('/');
        const auto part = text.substr(0, slash);
        if (part.empty() || part == "." || part == ".." ||
            part.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789"
                                   "._-") != std::string_view::npos) {
            return std::nullopt;
        }
        prefix += fmt::format("{}/", part);
        text.remove_prefix(slash == std::string_view::npos ? text.size() : slash + 1);
    }
    return prefix;
}

bool is_this_machine(std::string_view host) {
    for (const std::string_view name : {"localhost", "127.0.0.1", "[::1]"}) {
        if (host == name || (host.starts_with(name) && host[name.size()] == ':')) {
            return true;
        }
    }
    return false;
}

/// Splits "https://host:port" into scheme and host.
std::pair<std::string, std::string> endpoint_in(const std::string& url) {
    const auto colon = url.find("://");
    const auto scheme = colon == std::string::npos ? "" : url.substr(0, colon);
    auto host = colon == std::string::npos ? "" : url.substr(colon + 3);
    if (host.ends_with('/')) {
        host.pop_back();
    }
    if ((scheme != "https" && scheme != "http") || host.empty() ||
        host.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789.-:"
                               "[]") != std::string::npos) {
        throw InputError{"AWS_ENDPOINT_URL is no address of a service, expected https://HOST:PORT"};
    }
    if (scheme == "http" && !is_this_machine(host)) {
        throw InputError{fmt::format("AWS_ENDPOINT_URL is http://{}, expected https://: trip logs "
                                     "tell where people drive and do not travel unencrypted",
                                     host)};
    }
    return {scheme, host};
}

/// Keys of a profile in the file that other programs for S3 use.
S3Credentials credentials_in(const std::filesystem::path& file, const std::string& profile) {
    std::ifstream in{file};
    if (!in) {
        throw InputError{
            fmt::format("no keys for S3: expected AWS_ACCESS_KEY_ID and AWS_SECRET_ACCESS_KEY in "
                        "the environment, or a file {}",
                        file.string())};
    }
    struct stat status {};
    constexpr mode_t others = 077;
    if (::stat(file.c_str(), &status) == 0 && (status.st_mode & others) != 0) {
        throw InputError{fmt::format("{}: others can read these keys, expected a file of its owner "
                                     "alone (chmod 600)",
                                     file.string())};
    }
    S3Credentials keys;
    bool is_in_profile = false;
    for (std::string line; std::getline(in, line);) {
        if (line.ends_with('\r')) {
            line.pop_back();
        }
        const auto text = trimmed(line);
        if (text.starts_with('[')) {
            is_in_profile = text == fmt::format("[{}]", profile);
            continue;
        }
        const auto equals = text.find('=');
        if (!is_in_profile || equals == std::string_view::npos || text.starts_with('#')) {
            continue;
        }
        const auto name = trimmed(text.substr(0, equals));
        const auto value = std::string{trimmed(text.substr(equals + 1))};
        if (name == "aws_access_key_id") {
            keys.key_id = value;
        } else if (name == "aws_secret_access_key") {
            keys.secret = value;
        } else if (name == "aws_session_token") {
            keys.session_token = value;
        }
    }
    if (keys.key_id.empty() || keys.secret.empty()) {
        throw InputError{fmt::format("{}: has no keys of profile [{}], expected aws_access_key_id "
                                     "and aws_secret_access_key",
                                     file.string(),
                                     profile)};
    }
    return keys;
}

S3Credentials credentials() {
    S3Credentials keys{.key_id = variable("AWS_ACCESS_KEY_ID"),
                       .secret = variable("AWS_SECRET_ACCESS_KEY"),
                       .session_token = variable("AWS_SESSION_TOKEN")};
    if (!keys.key_id.empty() && !keys.secret.empty()) {
        return keys;
    }
    return credentials_in(first_of(variable("AWS_SHARED_CREDENTIALS_FILE"),
                                   "",
                                   variable("HOME") + "/.aws/credentials"),
                          first_of(variable("AWS_PROFILE"), "", "default"));
}

} // namespace

S3Settings s3_settings_of(const std::string& location) {
    const auto rest = std::string_view{location}.substr(scheme_of_buckets.size());
    const auto slash = rest.find('/');
    const auto bucket = std::string{rest.substr(0, slash)};
    const auto prefix =
        prefix_in(slash == std::string_view::npos ? std::string_view{} : rest.substr(slash + 1));
    if (!is_bucket(bucket) || !prefix) {
        throw InputError{fmt::format("{}: expected s3://BUCKET/PREFIX, a bucket of lower-case "
                                     "letters, digits, '.' and '-', and no keys",
                                     in_quotes(location))};
    }
    S3Settings settings;
    settings.location = location;
    settings.region = first_of(variable("AWS_REGION"), variable("AWS_DEFAULT_REGION"), "us-east-1");
    settings.credentials = credentials();
    const auto endpoint =
        first_of(variable("AWS_ENDPOINT_URL_S3"), variable("AWS_ENDPOINT_URL"), "");
    if (endpoint.empty()) {
        // A bucket with dots is no single label, which certificates of Amazon name.
        const bool in_host = bucket.find('.') == std::string::npos;
        settings.scheme = "https";
        settings.host = fmt::format(
            "{}s3.{}.amazonaws.com", in_host ? bucket + "." : std::string{}, settings.region);
        settings.path = in_host ? "/" + *prefix : fmt::format("/{}/{}", bucket, *prefix);
        return settings;
    }
    auto [scheme, host] = endpoint_in(endpoint);
    settings.scheme = std::move(scheme);
    settings.host = std::move(host);
    settings.path = fmt::format("/{}/{}", bucket, *prefix);
    return settings;
}

} // namespace macadam
