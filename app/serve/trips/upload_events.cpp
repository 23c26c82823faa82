#include "app/serve/trips/upload_events.hpp"

#include "estimator/common/error.hpp"
#include "storage/text/json.hpp"
#include "storage/text/utc.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <optional>
#include <utility>

namespace macadam {
namespace {

using namespace std::chrono_literals;

std::int64_t now_ms() {
    return std::chrono::duration_cast<std::chrono::milliseconds>(
               std::chrono::system_clock::now().time_since_epoch())
        .count();
}

} // namespace

std::string_view shown_state(const Upload& upload) {
    return upload.deleting ? "deleting" : name_of(upload.state);
}

bool is_final(const Upload& upload) {
    return !upload.deleting && upload.state != UploadState::queued &&
           upload.state != UploadState::working;
}

bool is_visible(const Upload& upload, const AccessToken& token) {
    return token.scope == TokenScope::operator_ || upload.owner == token.owner;
}

std::string upload_json(const Upload& upload) {
    JsonObject object;
    object.add("sha256", upload.sha256)
        .add("state", std::string{shown_state(upload)})
        .add("received", utc_text(upload.received_ms))
        .add("bytes", upload.bytes)
        .add("trips", static_cast<std::int64_t>(upload.trips))
        .add("passes", upload.passes);
    if (!upload.reason.empty()) {
        object.add("reason", upload.reason);
    }
    return object.text();
}

std::string state_event(const Upload& upload) {
    return fmt::format("retry: 1000\nid: {}\nevent: state\ndata: {}\n\n",
                       shown_state(upload),
                       upload_json(upload));
}

UploadEvents::UploadEvents(UploadPlace* place)
    : place_{place}, thread_{[this](const std::stop_token& stop) { work(stop); }} {}

std::shared_ptr<HttpStream> UploadEvents::follow(const std::string& sha256,
                                                 const std::string& token,
                                                 const std::optional<AccessToken>& staff) {
    auto stream = std::make_shared<HttpStream>();
    {
        const std::lock_guard lock{mutex_};
        if (followed_.size() >= max_streams) {
            return nullptr;
        }
        followed_.push_back({.sha256 = sha256, .token = token, .staff = staff, .stream = stream});
    }
    changed_.notify_all();
    return stream;
}

bool UploadEvents::tell(UploadStore& uploads, Followed& followed) {
    const auto token =
        followed.staff ? followed.staff : uploads.find_token(followed.token, now_ms());
    const auto upload = token ? uploads.find_upload(followed.sha256) : std::nullopt;
    if (!upload || !is_visible(*upload, *token)) {
        return false;
    }
    const auto now = Clock::now();
    constexpr auto silence = 3s; // after which a byte shows whether the client is there
    if (auto event = state_event(*upload); event != followed.last) {
        followed.stream->send(event);
        followed.last = std::move(event);
        followed.sent = now;
    } else if (now - followed.sent > silence) {
        followed.stream->send(":\n\n");
        followed.sent = now;
    }
    return !is_final(*upload) && now - followed.begin < max_time;
}

void UploadEvents::work(const std::stop_token& stop) {
    constexpr auto pause = 300ms; // a token is revoked within 1 s
    std::unique_ptr<UploadStore> uploads;
    std::unique_lock lock{mutex_};
    while (changed_.wait(lock, stop, [this] { return !followed_.empty(); }) &&
           !stop.stop_requested()) {
        try {
            if (!uploads) {
                uploads = place_->open();
            }
            if (!uploads) {
                throw InputError{"the last token was revoked"};
            }
            followed_.remove_if([&](Followed& each) {
                const bool goes_on = !each.stream->is_closed() && tell(*uploads, each);
                if (!goes_on) {
                    each.stream->end();
                }
                return !goes_on;
            });
        } catch (const InputError&) { // moved away; clients come again
            uploads.reset();
            for (const auto& each : followed_) {
                each.stream->end();
            }
            followed_.clear();
        }
        changed_.wait_for(lock, stop, pause, [] { return false; });
    }
    for (const auto& each : followed_) {
        each.stream->end();
    }
}

} // namespace macadam
