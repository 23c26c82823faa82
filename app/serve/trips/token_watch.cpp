#include "app/serve/trips/token_watch.hpp"

#include "app/jobs/job_options.hpp"
#include "estimator/common/error.hpp"
#include "storage/jobs/sent_logs.hpp"
#include "storage/jobs/server_tokens.hpp"
#include "storage/jobs/worker_register.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace macadam {
namespace {

using namespace std::chrono_literals;

constexpr auto look_every = 250ms;
constexpr auto believed_for = 1s;
constexpr std::size_t max_counted = 20'000; // of those that wait

} // namespace

TokenWatch::TokenWatch(std::string address) : address_{std::move(address)} {
    auto server = opened_server(address_);
    look(server);
    thread_ = std::jthread{[this](const std::stop_token& stop) { work(stop); }};
}

void TokenWatch::expect_fresh() const {
    if (!as_of_ || Clock::now() - *as_of_ > believed_for) {
        throw InputError{fmt::format("{}: does not answer, so no token is believed", address_)};
    }
}

std::optional<AccessToken> TokenWatch::find(std::string_view text, std::int64_t now_ms) {
    const auto given = parse_secret(text);
    const std::lock_guard lock{mutex_};
    expect_fresh();
    const auto found = tokens_.find(given.id);
    if (found == tokens_.end() ||
        !is_same_secret(found->second.secret_sha256, given.secret_sha256) ||
        found->second.token.expires_ms <= now_ms) {
        return std::nullopt;
    }
    return found->second.token;
}

bool TokenWatch::has_any() {
    const std::lock_guard lock{mutex_};
    expect_fresh();
    return has_any_;
}

std::size_t TokenWatch::waiting() {
    const std::lock_guard lock{mutex_};
    expect_fresh();
    return waiting_;
}

std::optional<std::string> TokenWatch::objects() {
    const std::lock_guard lock{mutex_};
    expect_fresh();
    return objects_;
}

void TokenWatch::look(ServerConnection& server) {
    const auto begin = Clock::now(); // what is read is not older
    const auto version = version_of_tokens(server);
    const bool is_known = [&] {
        const std::lock_guard lock{mutex_};
        return as_of_ && version == version_;
    }();
    auto kept = is_known ? KeptTokens{} : kept_tokens(server);
    const auto waiting = count_waiting_logs(server, max_counted);
    auto objects = objects_location(server);
    const std::lock_guard lock{mutex_};
    if (!is_known && kept.version > version_) { // else another thread has read newer ones
        tokens_.clear();
        for (auto& [token, secret_sha256] : kept.tokens) {
            auto id = token.id;
            tokens_.insert_or_assign(std::move(id),
                                     Kept{std::move(token), std::move(secret_sha256)});
        }
        has_any_ = !tokens_.empty() || kept.has_invitations;
        version_ = kept.version;
    }
    waiting_ = waiting;
    objects_ = std::move(objects);
    as_of_ = std::max(as_of_.value_or(begin), begin);
}

void TokenWatch::work(const std::stop_token& stop) {
    std::optional<ServerConnection> server;
    while (!stop.stop_requested()) {
        try {
            if (!server) {
                server.emplace(opened_server(address_));
            }
            look(*server);
        } catch (const InputError&) { // requests are refused, and the copy's follower tells why
            server.reset();
        }
        std::unique_lock lock{mutex_};
        changed_.wait_for(lock, stop, look_every, [] { return false; });
    }
}

} // namespace macadam
