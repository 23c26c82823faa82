#include "app/serve/trips/trips_api.hpp"

#include "app/http/request_check.hpp"
#include "app/serve/trips/incoming_log.hpp"
#include "estimator/common/error.hpp"
#include "storage/text/json.hpp"
#include "storage/text/text.hpp"
#include "storage/uploads/upload_queue.hpp"

#include <fmt/format.h>

#include <chrono>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

namespace macadam {
namespace {

constexpr std::string_view trips_path = "/v1/trips";
constexpr std::string_view trip_route = "/v1/trips/{sha256}";
constexpr std::string_view tokens_path = "/v1/tokens";
constexpr std::size_t max_listed = 1000;

std::int64_t now_ms() {
    return std::chrono::duration_cast<std::chrono::milliseconds>(
               std::chrono::system_clock::now().time_since_epoch())
        .count();
}

/// Returns the hash in "/v1/trips/{sha256}"; "" for another path.
std::string hash_in(std::string_view path) {
    constexpr std::size_t digits = 64;
    if (!path.starts_with(trips_path) || path.size() != trips_path.size() + 1 + digits) {
        return {};
    }
    const auto hash = path.substr(trips_path.size() + 1);
    const bool is_hash = path[trips_path.size()] == '/' &&
                         hash.find_first_not_of("0123456789abcdef") == std::string_view::npos;
    return is_hash ? std::string{hash} : std::string{};
}

/// Pattern of a path of this API.
std::string_view route_of(std::string_view path) {
    return path == tokens_path ? tokens_path : path == trips_path ? trips_path : trip_route;
}

HttpResponse routed(HttpResponse response, std::string_view route) {
    response.route = route;
    return response;
}

HttpResponse later(int status, std::string_view words, std::chrono::seconds after) {
    auto response = http_problem(status, words);
    response.headers.emplace_back("Retry-After", std::to_string(after.count()));
    return response;
}

HttpResponse not_allowed(std::string_view methods) {
    auto response = http_problem(405, fmt::format("expected {}", methods));
    response.headers.emplace_back("Allow", std::string{methods});
    return response;
}

HttpResponse no_token() {
    auto response = http_problem(401, "expected a token: Authorization: Bearer mac_...");
    response.headers.emplace_back("WWW-Authenticate", "Bearer realm=\"Macadam\"");
    return response;
}

/// Methods of a path, "" if there is no such path.
std::string_view methods_of(std::string_view path) {
    return path == tokens_path      ? "POST"
           : path == trips_path     ? "GET, HEAD"
           : !hash_in(path).empty() ? "GET, HEAD, PUT, DELETE"
                                    : "";
}

bool is_among(std::string_view method, std::string_view methods) {
    const auto at = methods.find(method);
    return at != std::string_view::npos &&
           (at + method.size() == methods.size() || methods[at + method.size()] == ',') &&
           (at == 0 || methods[at - 1] == ' ');
}

constexpr std::string_view staff_id = "staff"; // of no token, which has hex digits

/// Name of a member of the staff as the proxy states it; "" if it states none, or more than one,
/// of which the client may have sent one.
std::string staff_named(const HttpRequest& request, const std::string& header) {
    constexpr std::size_t longest = 200;
    const auto name = header.empty() ? std::string_view{} : trimmed(request.header(header));
    return name.size() <= longest && name.find(',') == std::string_view::npos ? std::string{name}
                                                                              : std::string{};
}

HttpResponse json_response(int status, const std::string& text) {
    return {.status = status, .body = text + "\n", .cache_control = "no-store"};
}

} // namespace

TripsApi::TripsApi(std::unique_ptr<UploadPlace> place,
                   TripsApiConfig config,
                   std::function<void()> queued,
                   std::function<void(const std::string& why)> failed)
    : place_{std::move(place)}, config_{std::move(config)}, queued_{std::move(queued)},
      failed_{std::move(failed)}, events_{place_.get()}, by_owner_{config_.per_s, config_.burst},
      by_address_{config_.per_address_s, config_.burst_of_address},
      failures_{config_.failures_s, config_.burst_of_failures} {}

UploadStore* TripsApi::opened(std::unique_ptr<UploadStore>& uploads) const {
    if (!uploads && place_) {
        uploads = place_->open();
    }
    return uploads.get();
}

std::optional<AccessToken> TripsApi::access_of(UploadStore& uploads,
                                               const HttpRequest& request) const {
    const auto name = staff_named(request, config_.staff_header);
    return name.empty()
               ? uploads.find_token(token_in(request.header("authorization")), now_ms())
               : std::optional{AccessToken{
                     .id = std::string{staff_id}, .owner = name, .scope = TokenScope::operator_}};
}

// ---------------------------------------------------------------------- thread of the network

std::optional<HttpResponse> TripsApi::refused_rate(const HttpRequest& request,
                                                   const std::optional<AccessToken>& token) {
    auto wait = by_address_.take(request.client);
    if (!wait) {
        wait = token ? by_owner_.take(token->owner) : failures_.take(request.client);
    }
    return wait ? std::optional{later(429, "too many requests", *wait)} : std::nullopt;
}

std::optional<HttpResponse> TripsApi::refused_reading(const HttpRequest& request, Readers readers) {
    try {
        auto* const uploads = opened(of_network_);
        if (uploads == nullptr && readers == Readers::operator_) {
            return http_problem(404, "there is no such page");
        }
        const auto text = token_in(request.header("authorization"));
        const auto token = uploads == nullptr ? std::nullopt : access_of(*uploads, request);
        if (token && readers == Readers::operator_ && token->scope != TokenScope::operator_) {
            return http_problem(403, "this is for tokens of scope operator");
        }
        if (token) {
            return token->scope != TokenScope::upload
                       ? std::nullopt
                       : std::optional{http_problem(403, "this token is for uploads")};
        }
        if (const auto wait = text.empty() ? std::nullopt : failures_.take(request.client)) {
            return later(429, "too many requests", *wait);
        }
        auto refusal = http_problem(401, "expected a token, as the password of any user");
        refusal.headers.emplace_back("WWW-Authenticate", "Basic realm=\"Macadam\"");
        return refusal;
    } catch (const InputError&) {
        of_network_.reset();
        return later(503, "tokens cannot be read now", std::chrono::minutes{1});
    }
}

HttpAdmission TripsApi::admit(const HttpRequest& request) {
    const auto methods = methods_of(request.path);
    const auto sha256 = hash_in(request.path);
    const auto route = route_of(request.path);
    try {
        auto* const uploads = opened(of_network_);
        if (uploads == nullptr || methods.empty()) {
            return {.refusal = http_problem(404,
                                            uploads == nullptr ? "no trips are taken here"
                                                               : "there is no such page")};
        }
        if (!is_among(request.method, methods)) {
            return {.refusal = routed(not_allowed(methods), route)};
        }
        const auto token = access_of(*uploads, request);
        if (auto refusal = refused_rate(request, token)) {
            return {.refusal = routed(*std::move(refusal), route)};
        }
        if (request.path == tokens_path) {
            return {};
        }
        if (!token) {
            return {.refusal = routed(no_token(), route)};
        }
        if (token->scope == TokenScope::read) {
            return {.refusal = routed(http_problem(403, "this token is for reading"), route)};
        }
        return request.method == "PUT" ? admit_upload(request, sha256, *token) : HttpAdmission{};
    } catch (const InputError&) { // the folder was moved away
        of_network_.reset();
        return {.refusal = routed(
                    later(503, "uploads cannot be taken now", std::chrono::minutes{1}), route)};
    }
}

HttpAdmission TripsApi::admit_upload(const HttpRequest& request,
                                     const std::string& sha256,
                                     const AccessToken& token) {
    const auto refused = [](HttpResponse response) {
        return HttpAdmission{.refusal = routed(std::move(response), trip_route)};
    };
    if (!is_crowd_ && token.scope != TokenScope::operator_) {
        return refused(http_problem(403, "this database takes trips of its operator alone"));
    }
    const auto suffix = suffix_of_upload(request);
    if (!suffix) {
        return refused(
            http_problem(415,
                         "expected a trip log: text/csv, application/gzip, application/zstd or "
                         "application/zip, or its name in Content-Disposition"));
    }
    if (request.header("content-length") == "0") {
        return refused(http_problem(422, "the body is empty, expected a trip log"));
    }
    if (const auto words = of_network_->refusal(); !words.empty()) {
        return refused(later(503, words, std::chrono::minutes{5}));
    }
    const auto spool = place_->spool();
    if (!has_free(spool, config_.min_free_bytes + body_bytes_of(request)) ||
        of_network_->count_waiting() >= config_.max_waiting) {
        return refused(
            later(503, "too many trips wait, or the disk is full", std::chrono::minutes{5}));
    }
    return {.body = std::make_shared<IncomingLog>(spool,
                                                  Upload{.sha256 = sha256,
                                                         .owner = token.owner,
                                                         .suffix = *suffix,
                                                         .received_ms = now_ms()},
                                                  config_.min_free_bytes)};
}

// ------------------------------------------------------------------------------------ workers

bool TripsApi::is_of_operator(const HttpRequest& request) {
    if (token_in(request.header("authorization")).empty() && config_.staff_header.empty()) {
        return false;
    }
    auto& [mutex, connection] = of_checks_; // who wait for no other machine
    const std::scoped_lock lock{mutex};
    try {
        auto* const uploads = opened(connection);
        const auto token = uploads == nullptr ? std::nullopt : access_of(*uploads, request);
        return token && token->scope == TokenScope::operator_;
    } catch (const InputError&) {
        connection.reset();
        return false;
    }
}

HttpResponse TripsApi::answer(const HttpRequest& request) {
    const auto sha256 = hash_in(request.path);
    const auto route = route_of(request.path);
    const bool reads = request.method == "GET" || request.method == "HEAD";
    auto& [mutex, connection] = reads ? of_readers_ : of_writers_;
    const std::scoped_lock lock{mutex};
    try {
        auto* const uploads = opened(connection);
        if (uploads != nullptr && request.path == tokens_path) {
            return routed(accept_invitation(*uploads, request), route);
        }
        const auto token = uploads == nullptr ? std::nullopt : access_of(*uploads, request);
        if (!token) { // revoked meanwhile
            return routed(no_token(), route);
        }
        return routed(request.method == "PUT" ? take_upload(*uploads, request)
                      : sha256.empty()        ? list(*uploads, *token)
                                              : one(*uploads, request, sha256, *token),
                      route);
    } catch (const InputError& error) { // the database or the object store is away
        connection.reset();
        failed_(error.what());
        return routed(later(503,
                            reads ? "uploads cannot be read now, try again later"
                                  : "this cannot be stored now, send it again later",
                            std::chrono::minutes{1}),
                      route);
    }
}

HttpResponse TripsApi::take_upload(UploadStore& uploads, const HttpRequest& request) {
    auto* const log = dynamic_cast<IncomingLog*>(request.body.get());
    if (log == nullptr) {
        return http_problem(422, "the body is empty, expected a trip log");
    }
    const auto& upload = log->upload();
    if (const auto found = log->sha256(); found != upload.sha256) {
        return http_problem(
            422, fmt::format("the body's SHA-256 is {}, expected that of the path", found));
    }
    const bool is_new = uploads.enqueue(log->file(), upload);
    if (is_new) {
        queued_();
    }
    const auto kept = uploads.find_upload(upload.sha256);
    const bool is_own = kept && kept->owner == upload.owner;
    auto response =
        json_response(is_new ? 202 : 200,
                      is_own ? upload_json(*kept)
                             : fmt::format(R"({{"sha256":"{}","state":"known"}})", upload.sha256));
    response.headers.emplace_back("Location", config_.base + request.path);
    return response;
}

HttpResponse TripsApi::accept_invitation(UploadStore& uploads, const HttpRequest& request) {
    try {
        const auto token =
            uploads.take_invitation(token_in(request.header("authorization")), now_ms());
        return token ? json_response(201, fmt::format(R"({{"token":"{}"}})", *token))
                     : http_problem(401,
                                    "the invitation was accepted before, has expired or is none");
    } catch (const OtherScope&) { // its name got tokens of another scope meanwhile
        return http_problem(409,
                            "the name of this invitation now has tokens of another scope; ask the "
                            "operator for an invitation by another name");
    }
}

/// Returns the events of an upload; 204, which ends a client's visits, once it has the last one.
HttpResponse
TripsApi::follow(const HttpRequest& request, const Upload& upload, const AccessToken& token) {
    if (is_final(upload) && request.header("last-event-id") == shown_state(upload)) {
        return {.status = 204, .cache_control = "no-store"};
    }
    HttpResponse response{.type = "text/event-stream", .cache_control = "no-store"};
    response.headers.emplace_back("X-Accel-Buffering", "no"); // nginx hands each on at once
    response.stream = events_.follow(upload.sha256,
                                     token_in(request.header("authorization")),
                                     token.id == staff_id ? std::optional{token} : std::nullopt);
    if (!response.stream) { // too many: one event, and the client comes again
        response.body = state_event(upload);
    }
    return response;
}

HttpResponse TripsApi::list(UploadStore& uploads, const AccessToken& token) const {
    const auto owner = token.scope == TokenScope::operator_ ? "" : token.owner;
    std::vector<std::string> items;
    for (const auto& upload : uploads.latest_uploads(owner, max_listed)) {
        items.push_back(upload_json(upload));
    }
    return json_response(200, fmt::format(R"({{"trips":{}}})", json_array(items)));
}

HttpResponse TripsApi::one(UploadStore& uploads,
                           const HttpRequest& request,
                           const std::string& sha256,
                           const AccessToken& token) {
    const auto upload = uploads.find_upload(sha256);
    if (!upload || !is_visible(*upload, token)) {
        return http_problem(404, "there is no such trip of this token's owner");
    }
    if (request.method != "DELETE") {
        return request.header("accept").find("text/event-stream") == std::string_view::npos
                   ? json_response(200, upload_json(*upload))
                   : follow(request, *upload, token);
    }
    if (uploads.delete_upload(sha256)) {
        return {.status = 204, .cache_control = "no-store"};
    }
    queued_();
    const auto left = uploads.find_upload(sha256);
    return left ? json_response(202, upload_json(*left))
                : HttpResponse{.status = 204, .cache_control = "no-store"};
}

} // namespace macadam
