#include "storage/objects/s3_objects.hpp"

#include "estimator/common/error.hpp"
#include "estimator/common/plugin_library.hpp"
#include "storage/objects/http_transfer.hpp"
#include "storage/objects/object_file.hpp"
#include "storage/text/text.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace macadam {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

constexpr int max_attempts = 5;

bool is_passing(const HttpOutcome& outcome) {
    constexpr std::array passing{408L, 429L, 500L, 502L, 503L, 504L};
    return outcome.failure.empty() ? std::ranges::find(passing, outcome.status) != passing.end()
                                   : !outcome.is_final;
}

/// What a service says of an error: the text of <Message> or <Code> in its XML.
std::string words_in(const std::string& xml) {
    for (const std::string_view tag : {"Message", "Code"}) {
        const auto begin = xml.find(fmt::format("<{}>", tag));
        const auto end = xml.find(fmt::format("</{}>", tag));
        if (begin != std::string::npos && end != std::string::npos && begin < end) {
            const auto from = begin + tag.size() + 2;
            constexpr std::size_t longest = 200;
            return in_quotes(std::string_view{xml}.substr(from, end - from), longest);
        }
    }
    return {};
}

/// Tests for an answer by which an object is missing, not its bucket.
bool is_object_missing(const HttpOutcome& outcome) {
    constexpr long missing = 404;
    return outcome.failure.empty() && outcome.status == missing &&
           outcome.words.find("<Code>NoSuchBucket<") == std::string::npos;
}

class S3Objects final : public ObjectStore {
public:
    S3Objects(S3Settings settings, std::stop_token stop)
        : settings_{std::move(settings)}, stop_{std::move(stop)}, run_{plugin_function<HttpRun>(
                                                                      "macadam_http.so",
                                                                      http_run_name)} {}

    void put(const LogObject& object, const fs::path& file) override {
        std::optional<ObjectSource> from;
        const auto outcome = tried([&] {
            from.emplace(file);
            auto transfer = transfer_of("PUT", object.sha256, object.sha256);
            transfer.body = [&](std::span<char> into) {
                const auto count = from->read(into);
                if (count == 0) {
                    from->expect(object, file); // fails: the service waits for more
                }
                return count;
            };
            transfer.body_bytes = object.bytes;
            HttpOutcome answer;
            (*run_)(transfer, answer);
            return answer;
        });
        expect_success(outcome, "cannot store an object");
        try {
            from->expect(object, file);
        } catch (const InputError&) {
            remove(object.sha256);
            throw;
        }
    }

    void fetch(const LogObject& object, const fs::path& file) override {
        std::optional<FetchedFile> to;
        bool is_too_long = false;
        const auto outcome = tried([&] {
            to.reset();
            to.emplace(object, file);
            auto transfer = transfer_of("GET", object.sha256, sha256_of_nothing);
            transfer.receive = [&](std::string_view bytes) {
                is_too_long = !to->add(bytes);
                return !is_too_long;
            };
            transfer.most_bytes = object.bytes;
            HttpOutcome answer;
            (*run_)(transfer, answer);
            return answer;
        });
        if (is_object_missing(outcome)) {
            throw UnusableObject{
                fmt::format("{}: object {} is missing", settings_.location, object.sha256)};
        }
        if (!is_too_long) {
            expect_success(outcome, "cannot fetch an object");
        }
        to->keep(settings_.location);
    }

    void remove(std::string_view sha256) override {
        const auto outcome = tried([&] {
            HttpOutcome answer;
            (*run_)(transfer_of("DELETE", sha256, sha256_of_nothing), answer);
            return answer;
        });
        if (!is_object_missing(outcome)) {
            expect_success(outcome, "cannot remove an object");
        }
    }

private:
    /// Signed request about an object.
    HttpTransfer
    transfer_of(const std::string& method, std::string_view sha256, std::string_view payload) {
        const auto now = std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
        const auto time = fmt::format("{:%Y%m%dT%H%M%SZ}",
                                      fmt::gmtime(std::chrono::system_clock::to_time_t(now)));
        S3Request request{
            .method = method,
            .path = fmt::format(
                "{}{}/{}/{}", settings_.path, sha256.substr(0, 2), sha256.substr(2, 2), sha256),
            .headers = {{"host", settings_.host},
                        {"x-amz-content-sha256", std::string{payload}},
                        {"x-amz-date", time}},
            .payload_sha256 = std::string{payload}};
        if (!settings_.credentials.session_token.empty()) {
            request.headers.emplace_back("x-amz-security-token",
                                         settings_.credentials.session_token);
        }
        HttpTransfer transfer;
        transfer.method = method;
        transfer.url =
            fmt::format("{}://{}{}", settings_.scheme, settings_.host, encoded_path(request.path));
        for (const auto& [name, value] : request.headers) {
            transfer.headers.push_back(fmt::format("{}: {}", name, value));
        }
        transfer.headers.push_back("authorization: " +
                                   authorization_of(request,
                                                    settings_.credentials,
                                                    {.region = settings_.region, .time = time}));
        transfer.headers.emplace_back("expect:"); // no pause before a body
        transfer.stop = stop_;
        return transfer;
    }

    /// Tries a request again while that may help.
    HttpOutcome tried(const std::function<HttpOutcome()>& once) {
        std::chrono::milliseconds pause = 200ms;
        for (int attempt = 1;; ++attempt, pause *= 2) {
            auto outcome = once();
            if (!is_passing(outcome) || attempt == max_attempts || stop_.stop_requested()) {
                return outcome;
            }
            std::uniform_real_distribution<double> share{0.5, 1};
            std::mutex mutex;
            std::unique_lock lock{mutex};
            std::condition_variable_any stopped;
            stopped.wait_for(lock, stop_, pause * share(random_), [] { return false; });
        }
    }

    void expect_success(const HttpOutcome& outcome, std::string_view doing) const {
        if (outcome.failure.empty() && outcome.status / 100 == 2) {
            return;
        }
        const auto words = words_in(outcome.words);
        throw InputError{outcome.failure.empty() ? fmt::format("{}: {}: {} answers {}{}{}",
                                                               settings_.location,
                                                               doing,
                                                               settings_.host,
                                                               outcome.status,
                                                               words.empty() ? "" : ", ",
                                                               words)
                                                 : fmt::format("{}: {}: {}: {}",
                                                               settings_.location,
                                                               doing,
                                                               settings_.host,
                                                               outcome.failure)};
    }

    S3Settings settings_;
    std::stop_token stop_;
    HttpRun* run_;
    std::minstd_rand random_{std::random_device{}()};
};

} // namespace

std::unique_ptr<ObjectStore> open_s3_objects(S3Settings settings, std::stop_token stop) {
    return std::make_unique<S3Objects>(std::move(settings), std::move(stop));
}

} // namespace macadam
