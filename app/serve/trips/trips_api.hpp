#pragma once

#include "app/http/http_server.hpp"
#include "app/serve/trips/token_buckets.hpp"
#include "app/serve/trips/upload_events.hpp"
#include "app/serve/trips/upload_place.hpp"
#include "storage/uploads/access_token.hpp"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

namespace macadam {

/// Limits of uploads (docs/reference/serve.md).
struct TripsApiConfig {
    std::string base{}; ///< public address, without a slash at its end; "" = none is known
    /// Header, in lower case, by which a proxy names members of the staff, who may do all; "": none
    /// is believed. Only for a server that nobody but the proxy can reach, on a Unix socket.
    std::string staff_header{};
    std::size_t max_waiting = 10'000;                         ///< uploads in the queue
    std::uint64_t min_free_bytes = std::uint64_t{512} << 20U; ///< on the disk of the spool
    double per_s = 2;                                         ///< requests of an owner of tokens
    double burst = 240;
    double per_address_s = 4;
    double burst_of_address = 480;
    double failures_s = 0.2; ///< requests of an address with a wrong token
    double burst_of_failures = 20;
};

/// Paths below /v1/ of a server: uploads of trips and their fate, for holders of tokens
/// (docs/reference/serve.md). Where nobody has made a token, there is nothing.
class TripsApi {
public:
    /// \param place   null: the database has none, and takes no trips
    /// \param queued  called when there is something for a worker
    /// \param failed  called with the reason, for the operator, when an admitted request cannot be
    ///                answered now
    TripsApi(std::unique_ptr<UploadPlace> place,
             TripsApiConfig config,
             std::function<void()> queued,
             std::function<void(const std::string& why)> failed);

    static bool has_path(std::string_view path) { return path.starts_with("/v1/"); }

    /// Admits a request, or refuses it: without a token, with one that does not suffice, too many,
    /// or with a body that cannot be a trip. For the thread of the network.
    HttpAdmission admit(const HttpRequest& request);

    /// Holders of tokens who may read something.
    enum class Readers { with_token, operator_ };

    /// Refuses a request to read what the server shows, unless by a token for that. For the same
    /// thread.
    std::optional<HttpResponse> refused_reading(const HttpRequest& request,
                                                Readers readers = Readers::with_token);

    /// Tests whether a request has the token of an operator. Thread-safe.
    bool is_of_operator(const HttpRequest& request);

    /// Answers an admitted request; with 503 while what it needs is away. Thread-safe.
    HttpResponse answer(const HttpRequest& request);

    /// Tells whether the database is a crowd's; others take trips of operators alone.
    void set_crowd(bool is_crowd) { is_crowd_ = is_crowd; }

private:
    /// Connection that is opened when it is first needed, as tokens may be made later.
    UploadStore* opened(std::unique_ptr<UploadStore>& uploads) const;

    /// Finds what a request may do: by its token, or as its proxy says of a member of the staff.
    std::optional<AccessToken> access_of(UploadStore& uploads, const HttpRequest& request) const;

    std::optional<HttpResponse> refused_rate(const HttpRequest& request,
                                             const std::optional<AccessToken>& token);
    HttpAdmission
    admit_upload(const HttpRequest& request, const std::string& sha256, const AccessToken& token);
    HttpResponse take_upload(UploadStore& uploads, const HttpRequest& request);
    static HttpResponse accept_invitation(UploadStore& uploads, const HttpRequest& request);
    HttpResponse follow(const HttpRequest& request, const Upload& upload, const AccessToken& token);
    HttpResponse list(UploadStore& uploads, const AccessToken& token) const;
    HttpResponse one(UploadStore& uploads,
                     const HttpRequest& request,
                     const std::string& sha256,
                     const AccessToken& token);

    std::unique_ptr<UploadPlace> place_;
    TripsApiConfig config_;
    std::function<void()> queued_;
    std::function<void(const std::string& why)> failed_;
    std::atomic<bool> is_crowd_ = false;
    UploadEvents events_;
    std::unique_ptr<UploadStore> of_network_; ///< of the thread of the network, which must not wait
    TokenBuckets by_owner_;
    TokenBuckets by_address_;
    TokenBuckets failures_;
    /// Connection with the mutex that guards it.
    struct Guarded {
        std::mutex mutex;
        std::unique_ptr<UploadStore> uploads{};
    };
    Guarded of_checks_;
    Guarded of_readers_;
    Guarded of_writers_; ///< who wait for the disk, or for those who do
};

} // namespace macadam
