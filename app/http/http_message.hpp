#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace macadam {

/// Receiver of the body of a request, block by block, so that no body is kept in memory. It is
/// destroyed with the request, also if the client goes away.
class HttpBody {
public:
    HttpBody() = default;
    HttpBody(const HttpBody&) = delete;
    HttpBody& operator=(const HttpBody&) = delete;
    virtual ~HttpBody() = default;

    /// Called by a worker, one after the other. Exceptions become a response of status 503.
    virtual void add(std::string_view bytes) = 0;
};

/// Request, decoded.
struct HttpRequest {
    std::string method;
    std::string path; ///< percent-decoded, without a NUL: "/collections/segments"
    std::vector<std::pair<std::string, std::string>> parameters; ///< of the query, in its order
    std::map<std::string, std::string, std::less<>> headers;     ///< by name in lower case
    std::string client; ///< client_network(); behind a proxy, of the address that the proxy states
    std::shared_ptr<HttpBody> body{}; ///< received whole; null: there is none

    /// Value of a parameter; `std::nullopt` if it is missing. Of several the first.
    std::optional<std::string> parameter(std::string_view name) const;

    /// Value of a header, "" if it is missing.
    std::string_view header(std::string_view name) const;
};

/// File open for reading, which can be sent also when it has been removed.
class HttpOpenFile {
public:
    /// Opens no symbolic link.
    explicit HttpOpenFile(const std::filesystem::path& path);
    HttpOpenFile(const HttpOpenFile&) = delete;
    HttpOpenFile& operator=(const HttpOpenFile&) = delete;
    ~HttpOpenFile();

    int number() const { return number_; } ///< < 0: it could not be opened

    /// Tells whether nothing was written to it since it was opened. (A file that is put in its
    /// place does not count.)
    bool is_unchanged() const;

private:
    int number_;
    std::int64_t size_ = 0;
    std::int64_t modified_ns_ = 0;
};

/// File that a response sends in part or whole.
struct HttpFile {
    std::shared_ptr<const HttpOpenFile> open;
    std::uint64_t size;
};

class HttpStream;

struct HttpResponse {
    int status = 200;
    std::string type = "application/json";
    std::string body{};
    std::optional<HttpFile> file{};       ///< instead of the body
    std::shared_ptr<HttpStream> stream{}; ///< instead of the body
    bool is_gzipped = false;              ///< the body is compressed already
    std::string etag{};                   ///< without quotes; "" = none
    std::string cache_control = "no-cache";
    std::vector<std::pair<std::string, std::string>> headers{}; ///< further ones
    std::string_view route = "other"; ///< pattern of the path, for logs; of static lifetime
};

/// Error response with a problem as its body (RFC 9457).
HttpResponse http_problem(int status, std::string_view detail);

/// Reason phrase of a status, "Not Found".
std::string_view http_reason(int status);

/// Decodes %XX, and + as a blank in queries. \returns `std::nullopt` for what is no code, and for
/// NUL.
std::optional<std::string> percent_decoded(std::string_view text, bool plus_is_blank);

/// Encodes what is not unreserved (RFC 3986, 2.3).
std::string percent_encoded(std::string_view text);

/// Splits the target of a request, "/path?a=1&b", into path and parameters.
/// \returns false for a target that cannot be decoded.
bool parse_target(std::string_view target, HttpRequest& request);

} // namespace macadam
