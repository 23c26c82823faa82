#pragma once

#include "app/http/http_stream.hpp"
#include "app/serve/trips/upload_place.hpp"
#include "storage/uploads/access_token.hpp"
#include "storage/uploads/upload_queue.hpp"

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <thread>

namespace macadam {

/// Name of an upload's state as clients see it: also "deleting".
std::string_view shown_state(const Upload& upload);

/// Tests whether the state will not change by itself.
bool is_final(const Upload& upload);

/// Tests whether a token lets its holder see an upload.
bool is_visible(const Upload& upload, const AccessToken& token);

/// Formats an upload as a JSON object.
std::string upload_json(const Upload& upload);

/// Formats the state as a server-sent event, after the end of which a client comes again in 1 s.
std::string state_event(const Upload& upload);

/// Streams of the states of uploads, for those who wait for them. One thread looks for changes, as
/// also other programs make them.
class UploadEvents {
public:
    /// \param place  of the uploads that are followed; null: there are none
    explicit UploadEvents(UploadPlace* place);
    UploadEvents(const UploadEvents&) = delete;
    UploadEvents& operator=(const UploadEvents&) = delete;
    ~UploadEvents() = default;

    /// Returns a stream of the events of an upload: its state now, and each one that follows. It
    /// ends with the last one, once the token does not suffice any longer, and after max_time.
    /// \param token  text of a token
    /// \param staff  access of who has none, for the time of the stream
    /// \returns null if there are max_streams already
    std::shared_ptr<HttpStream> follow(const std::string& sha256,
                                       const std::string& token,
                                       const std::optional<AccessToken>& staff = {});

    static constexpr std::size_t max_streams = 256;
    static constexpr std::chrono::seconds max_time{50}; ///< within that of any response

private:
    using Clock = std::chrono::steady_clock;
    struct Followed {
        std::string sha256, token;
        std::optional<AccessToken> staff;
        std::shared_ptr<HttpStream> stream;
        Clock::time_point begin = Clock::now();
        Clock::time_point sent = begin;
        std::string last{}; ///< event
    };

    void work(const std::stop_token& stop);

    /// Sends what is new. \returns false once the stream has ended.
    static bool tell(UploadStore& uploads, Followed& followed);

    UploadPlace* place_;
    std::mutex mutex_; ///< guards followed_
    std::list<Followed> followed_;
    std::condition_variable_any changed_;
    std::jthread thread_;
};

} // namespace macadam
