// Uploads of trips, as a client sees them. No worker runs: what is sent waits.

#include "app/cli/console.hpp"
#include "app/serve/api_server.hpp"
#include "app/serve/trips/incoming_log.hpp"
#include "app/serve/trips/trips_api.hpp"
#include "app/serve/trips/upload_place.hpp"
#include "estimator/common/error.hpp"
#include "storage/files/sha256.hpp"
#include "storage/uploads/access_token.hpp"
#include "storage/uploads/upload_database.hpp"
#include "storage/uploads/upload_queue.hpp"
#include "support/files/files.hpp"
#include "support/http/http_client.hpp"
#include "support/roads/store_world.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <future>
#include <iterator>
#include <stop_token>
#include <string>
#include <string_view>
#include <thread>
#include <tuple>
#include <utility>
#include <vector>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;

std::string sha256_of(std::string_view bytes) {
    Sha256 hash;
    hash.add(bytes);
    return hash.hex();
}

constexpr std::int64_t long_ago_ms = 1'000;
constexpr std::int64_t far_ahead_ms = 4'000'000'000'000; // in 2096

/// Server that takes trips, with a token of each kind.
struct TakingWorld {
    explicit TakingWorld(PrivacyProfile privacy = PrivacyProfile::crowd,
                         const TripReception& reception = {.workers = 0})
        : file{new_file(privacy)}, server{[this, reception] {
              serve_database(
                  file,
                  Audience::anyone,
                  {.port = 0},
                  {},
                  Console{Verbosity::quiet, stop.get_token()},
                  [this](std::uint16_t its_port) { started.set_value(its_port); },
                  reception);
          }} {}
    ~TakingWorld() { stop.request_stop(); }
    TakingWorld(const TakingWorld&) = delete;
    TakingWorld& operator=(const TakingWorld&) = delete;

    static fs::path new_file(PrivacyProfile privacy) {
        auto path = test_folder() / "roads.gpkg";
        auto of_crowd = settings();
        of_crowd.privacy = privacy;
        RoadStore::create(path, small_country(), of_crowd);
        make_uploads_folder(path);
        return path;
    }

    std::string
    token(const std::string& owner, TokenScope scope, std::int64_t expires_ms = far_ahead_ms) {
        return create_token(uploads,
                            {.id = {}, .owner = owner, .scope = scope, .expires_ms = expires_ms});
    }

    Answer ask(std::string_view method,
               std::string_view target,
               std::string_view token,
               std::string_view body = {},
               std::string_view headers = "Content-Type: text/csv\r\n") const {
        HttpClient client{port};
        client.send(fmt::format(
            "{} {} HTTP/1.1\r\nHost: localhost\r\n{}{}{}\r\n{}",
            method,
            target,
            token.empty() ? std::string{} : fmt::format("Authorization: Bearer {}\r\n", token),
            headers,
            body.empty() && method != "PUT" ? std::string{}
                                            : fmt::format("Content-Length: {}\r\n", body.size()),
            body));
        return client.answer(method != "HEAD");
    }

    Answer put(std::string_view body, std::string_view token) const {
        return ask("PUT", "/v1/trips/" + sha256_of(body), token, body);
    }

    std::size_t spooled() const {
        return static_cast<std::size_t>(
            std::distance(fs::directory_iterator{spool_of(file)}, fs::directory_iterator{}));
    }

    fs::path file;
    Database uploads = open_uploads(file);
    std::string anna = token("anna", TokenScope::upload);
    std::string ben = token("ben", TokenScope::upload);
    std::string reader = token("reader", TokenScope::read);
    std::string operator_ = token("office", TokenScope::operator_);
    std::stop_source stop;
    std::promise<std::uint16_t> started;
    std::jthread server;
    std::uint16_t port = started.get_future().get();
};

TEST(TripsApi, TakesATripOnce) {
    const TakingWorld world;
    const std::string log = "a log";
    const auto target = "/v1/trips/" + sha256_of(log);
    const auto first = world.put(log, world.anna);
    EXPECT_EQ(first.status, 202) << first.body;
    EXPECT_EQ(first.headers.at("location"), target);
    EXPECT_EQ(world.put(log, world.anna).status, 200);
    EXPECT_EQ(world.spooled(), 1U);
    const auto fate = nlohmann::json::parse(world.ask("GET", target, world.anna).body);
    EXPECT_EQ(fate.at("state"), "queued");
    EXPECT_EQ(fate.at("bytes"), 5);
}

TEST(TripsApi, TakesALogOf8Megabytes) {
    const TakingWorld world;
    const std::string log(8'000'000, 'x');
    EXPECT_EQ(world.put(log, world.anna).status, 202);
    EXPECT_EQ(fs::file_size(spool_of(world.file) / (sha256_of(log) + ".csv")), log.size());
}

TEST(TripsApi, RefusesABodyThatIsNotTheOneOfItsHash) {
    const TakingWorld world;
    const auto answer = world.ask("PUT", "/v1/trips/" + sha256_of("another"), world.anna, "a log");
    EXPECT_EQ(answer.status, 422);
    EXPECT_THAT(answer.body, HasSubstr(sha256_of("a log")));
    EXPECT_EQ(world.spooled(), 0U);
}

TEST(TripsApi, KeepsNothingOfACutUpload) {
    const TakingWorld world;
    {
        HttpClient client{world.port};
        client.send(fmt::format("PUT /v1/trips/{} HTTP/1.1\r\nHost: localhost\r\n"
                                "Authorization: Bearer {}\r\nContent-Type: text/csv\r\n"
                                "Content-Length: 1000000\r\n\r\n{}",
                                sha256_of("a"),
                                world.anna,
                                std::string(100'000, 'a')));
    }
    EXPECT_EQ(world.ask("GET", "/v1/trips/" + sha256_of("a"), world.anna).status, 404);
    EXPECT_EQ(world.spooled(), 0U);
}

TEST(TripsApi, RefusesWhatCannotBeATrip) {
    const TakingWorld world;
    const auto target = "/v1/trips/" + sha256_of("a log");
    EXPECT_EQ(world.ask("PUT", target, world.anna, "a log", "Content-Type: image/png\r\n").status,
              415);
    EXPECT_EQ(world.ask("PUT", target, world.anna, "a log", "").status, 415);
    EXPECT_EQ(world.ask("PUT", target, world.anna, "").status, 422);
    HttpClient client{world.port};
    client.send(fmt::format("PUT {} HTTP/1.1\r\nHost: localhost\r\nAuthorization: Bearer {}\r\n"
                            "Content-Type: text/csv\r\nContent-Length: 67108865\r\n\r\n",
                            target,
                            world.anna));
    EXPECT_EQ(client.answer().status, 413);
    EXPECT_EQ(world.spooled(), 0U);
}

TEST(TripsApi, UsesOfAFileNameItsSuffixAlone) {
    const TakingWorld world;
    const std::string log = "a log";
    const auto answer = world.ask(
        "PUT",
        "/v1/trips/" + sha256_of(log),
        world.anna,
        log,
        "Content-Disposition: attachment; filename=\"../../../../tmp/x/../a.trip.csv.gz\"\r\n");
    EXPECT_EQ(answer.status, 202);
    EXPECT_TRUE(fs::exists(spool_of(world.file) / (sha256_of(log) + ".trip.csv.gz")));
}

TEST(TripsApi, KnowsNoOtherPaths) {
    const TakingWorld world;
    const auto hash = sha256_of("a log");
    auto upper = hash;
    upper[0] = 'A';
    for (const auto& target : std::vector<std::string>{"/v1/",
                                                       "/v1/trips/",
                                                       "/v1/trips/..",
                                                       "/v1/trips/%2e%2e/%2e%2e/etc/passwd",
                                                       "/v1/trips/" + hash.substr(1),
                                                       "/v1/trips/" + hash + "0",
                                                       "/v1/trips/" + upper,
                                                       "/v1/trips/" + hash + "/x",
                                                       "/v1/trips/../trips/" + hash,
                                                       "/v1/Trips/" + hash,
                                                       "/v1/trips/" + hash.substr(3) + "%00"}) {
        const auto status = world.ask("PUT", target, world.anna, "a log").status;
        EXPECT_TRUE(status == 404 || status == 400) << target << status;
    }
    EXPECT_EQ(world.spooled(), 0U);
}

TEST(TripsApi, ShowsAndDeletesToAContributorHisOwnTripsAlone) {
    const TakingWorld world;
    const std::string log = "a log of anna";
    const auto target = "/v1/trips/" + sha256_of(log);
    ASSERT_EQ(world.put(log, world.anna).status, 202);
    EXPECT_EQ(world.put(log, world.ben).status, 200); // he has the log, and learns no more
    EXPECT_EQ(world.ask("GET", target, world.ben).status, 404);
    EXPECT_EQ(world.ask("DELETE", target, world.ben).status, 404);
    const auto count = [&](const std::string& token) {
        return nlohmann::json::parse(world.ask("GET", "/v1/trips", token).body).at("trips").size();
    };
    EXPECT_EQ(count(world.anna), 1U);
    EXPECT_EQ(count(world.ben), 0U);
    EXPECT_EQ(count(world.operator_), 1U);
    EXPECT_EQ(world.ask("DELETE", target, world.anna).status, 204);
    EXPECT_EQ(world.ask("GET", target, world.anna).status, 404);
    EXPECT_EQ(world.spooled(), 0U);
}

TEST(TripsApi, AnswersForTheTripOfAnotherAsForOneThatNobodySent) {
    const TakingWorld world;
    ASSERT_EQ(world.put("a log of anna", world.anna).status, 202);
    const auto told = [&](std::string_view method, std::string_view log, std::string_view accept) {
        auto answer = world.ask(method,
                                "/v1/trips/" + sha256_of(log),
                                world.ben,
                                {},
                                fmt::format("Accept: {}\r\n", accept));
        answer.headers.erase("date");
        return std::tuple{answer.status, answer.headers, answer.body};
    };
    for (const auto* const method : {"GET", "HEAD", "DELETE"}) {
        for (const auto* const accept : {"*/*", "text/event-stream"}) {
            EXPECT_EQ(told(method, "a log of anna", accept), told(method, "a log", accept))
                << method << ' ' << accept;
        }
    }
}

TEST(TripsApi, TakesNoTokenFromAnAddress) {
    const TakingWorld world;
    for (const auto* const name : {"token", "access_token", "api_key"}) {
        const auto target = fmt::format("/v1/trips?{}={}", name, world.operator_);
        EXPECT_EQ(world.ask("GET", target, {}).status, 401) << name;
    }
}

TEST(TripsApi, TakesTripsOfItsOperatorAloneUnlessItIsACrowds) {
    const TakingWorld world{PrivacyProfile::own};
    const auto answer = world.put("a log", world.anna);
    EXPECT_EQ(answer.status, 403);
    EXPECT_THAT(answer.body, HasSubstr("this database takes trips of its operator alone"));
    EXPECT_EQ(world.put("a log", world.operator_).status, 202);
}

TEST(TripsApi, ShowsWhatACrowdHasNotPublishedToItsOperatorAlone) {
    const TakingWorld world;
    auto store = RoadStore::open(world.file);
    import_trips(store, 2);
    const auto count = [&](const std::string& token) {
        const auto answer = world.ask("GET", "/collections/segments/items?limit=1", token);
        EXPECT_EQ(answer.status, 200);
        return nlohmann::json::parse(answer.body).at("numberMatched").get<int>();
    };
    while (count(world.operator_) == 0) { // the server looks every second; the test's limit ends it
        std::this_thread::sleep_for(std::chrono::milliseconds{50});
    }
    for (const auto& token : {world.anna, world.reader, std::string{}}) {
        EXPECT_EQ(count(token), 0);
    }
    const auto answer = world.ask("GET", "/collections/segments/items?limit=1", world.operator_);
    EXPECT_EQ(answer.headers.at("cache-control"), "no-store");
}

TEST(TripsApi, FollowsARevokedTokenAtOnce) {
    TakingWorld world;
    EXPECT_EQ(world.ask("GET", "/v1/trips", world.anna).status, 200);
    revoke_tokens(world.uploads, "anna");
    const auto answer = world.ask("GET", "/v1/trips", world.anna);
    EXPECT_EQ(answer.status, 401);
    EXPECT_EQ(answer.headers.at("www-authenticate"), "Bearer realm=\"Macadam\"");
}

TEST(TripsApi, GivesATokenForAnInvitationAndAnotherInItsPlaceIfItGotLost) {
    TakingWorld world;
    const auto invitation = create_invitation(
        world.uploads,
        {.owner = "cleo", .expires_ms = far_ahead_ms, .token_expires_ms = far_ahead_ms});
    EXPECT_EQ(world.ask("GET", "/v1/trips", invitation).status, 401);
    const auto given = world.ask("POST", "/v1/tokens", invitation);
    ASSERT_EQ(given.status, 201) << given.body;
    const auto token = nlohmann::json::parse(given.body).at("token").get<std::string>();
    EXPECT_EQ(world.put("a log", token).status, 202);
    const auto again = world.ask("POST", "/v1/tokens", invitation);
    ASSERT_EQ(again.status, 201) << again.body;
    EXPECT_EQ(world.ask("GET", "/v1/trips", token).status, 401);
    const auto trips = world.ask(
        "GET", "/v1/trips", nlohmann::json::parse(again.body).at("token").get<std::string>());
    EXPECT_EQ(nlohmann::json::parse(trips.body).at("trips").size(), 1U);
    EXPECT_EQ(world.ask("POST", "/v1/tokens", world.anna).status, 401); // a token is none
}

TEST(TripsApi, SaysWhyAnInvitationGivesNoToken) {
    TakingWorld world;
    const auto invitation = create_invitation(
        world.uploads,
        {.owner = "dora", .expires_ms = far_ahead_ms, .token_expires_ms = far_ahead_ms});
    world.token("dora", TokenScope::read);
    const auto answer = world.ask("POST", "/v1/tokens", invitation);
    EXPECT_EQ(answer.status, 409);
    EXPECT_THAT(answer.body, HasSubstr("another scope"));
}

TEST(TripsApi, AnswersWhileAnUploadWaitsForTheDisk) {
    TakingWorld world;
    std::future<Answer> waiting;
    {
        const Transaction held{world.uploads, Transaction::Kind::write}; // as a slow sync holds it
        waiting = std::async(std::launch::async, [&] { return world.put("a log", world.anna); });
        for (int i = 0; i < 20; ++i) {
            EXPECT_EQ(world.ask("GET", "/health", "").status, 200);
            EXPECT_EQ(world.ask("GET", "/v1/trips", world.ben).status, 200);
            EXPECT_EQ(world.ask("GET", "/collections/segments/items", "").status, 200);
        }
        EXPECT_EQ(waiting.wait_for(std::chrono::seconds{0}), std::future_status::timeout);
    }
    EXPECT_EQ(waiting.get().status, 202);
}

TEST(TripsApi, AsksToComeAgainWhileUploadsCannotBeRead) {
    TakingWorld world;
    ASSERT_EQ(world.put("a log", world.anna).status, 202);
    const auto target = "/v1/trips/" + sha256_of("a log");
    world.uploads.run("ALTER TABLE upload RENAME TO gone");
    for (const auto& [method, its_target] :
         {std::pair{"GET", std::string{"/v1/trips"}}, {"GET", target}, {"DELETE", target}}) {
        const auto answer = world.ask(method, its_target, world.anna);
        EXPECT_EQ(answer.status, 503) << method << its_target;
        EXPECT_EQ(answer.headers.at("retry-after"), "60");
        EXPECT_THAT(answer.body, HasSubstr("again later"));
        EXPECT_THAT(answer.body, Not(HasSubstr("uploads.db"))); // for its operator alone
    }
    world.uploads.run("ALTER TABLE gone RENAME TO upload");
    EXPECT_EQ(world.ask("GET", target, world.anna).status, 200);
}

/// Client that waits for the events of an upload.
HttpClient& follow(HttpClient& client, const std::string& target, const std::string& token) {
    client.send(fmt::format("GET {} HTTP/1.1\r\nHost: localhost\r\nAuthorization: Bearer {}\r\n"
                            "Accept: text/event-stream\r\n\r\n",
                            target,
                            token));
    return client;
}

TEST(TripsApi, StreamsTheFateAsItChanges) {
    const TakingWorld world;
    const std::string log = "a log";
    const auto target = "/v1/trips/" + sha256_of(log);
    world.put(log, world.anna);
    HttpClient client{world.port};
    const auto first = follow(client, target, world.anna).read_until("\n\n");
    EXPECT_THAT(first, HasSubstr("text/event-stream"));
    EXPECT_THAT(first, HasSubstr("retry: 1000\nid: queued\nevent: state\ndata: {\"sha256\":"));
    auto uploads = open_uploads(world.file);
    const auto taken = take_uploads(uploads, spool_of(world.file), 1);
    EXPECT_THAT(client.read_until("id: working\n"), HasSubstr("id: working\n"));
    finish_upload(uploads, spool_of(world.file), taken.at(0).upload(), UploadState::refused, "why");
    const auto last = client.read_until("\r\n0\r\n\r\n");
    EXPECT_THAT(last, HasSubstr("id: refused\n"));
    EXPECT_TRUE(last.ends_with("\r\n0\r\n\r\n"));                   // the stream has ended
    client.send("GET /health HTTP/1.1\r\nHost: localhost\r\n\r\n"); // on the same connection
    EXPECT_EQ(client.answer().status, 200);
    EXPECT_EQ(world
                  .ask("GET",
                       target,
                       world.anna,
                       "",
                       "Accept: text/event-stream\r\nLast-Event-ID: refused\r\n")
                  .status,
              204);
}

TEST(TripsApi, EndsTheStreamOfARevokedToken) {
    TakingWorld world;
    world.put("a log", world.anna);
    HttpClient client{world.port};
    follow(client, "/v1/trips/" + sha256_of("a log"), world.anna).read_until("id: queued");
    revoke_tokens(world.uploads, "anna");
    EXPECT_TRUE(client.read_until("\r\n0\r\n\r\n").ends_with("\r\n0\r\n\r\n"));
}

TEST(TripsApi, EndsStreamsWhenItStops) {
    TakingWorld world;
    world.put("a log", world.anna);
    std::deque<HttpClient> clients;
    for (int i = 0; i < 20; ++i) { // some of which have gone
        auto& client = clients.emplace_back(world.port);
        follow(client, "/v1/trips/" + sha256_of("a log"), world.anna).read_until("id: queued");
        if (i % 2 == 0) {
            clients.pop_back();
        }
    }
    EXPECT_EQ(world.ask("GET", "/health", "").status, 200);
    world.stop.request_stop();
    for (auto& client : clients) {
        EXPECT_TRUE(client.read_until("\r\n0\r\n\r\n").ends_with("\r\n0\r\n\r\n"));
    }
}

TEST(TripsApi, ShowsNothingWithoutATokenIfAsked) {
    const TakingWorld world{PrivacyProfile::crowd, {.workers = 0, .only_with_token = true}};
    const auto paths =
        nlohmann::json::parse(world.ask("GET", "/api", world.reader).body).at("paths");
    std::size_t closed = 0;
    for (const auto& [path, operations] : paths.items()) {
        if (!path.starts_with("/v1/") && path != "/health" && path != "/metrics") {
            const auto answer = world.ask("GET", path, "");
            EXPECT_EQ(answer.status, 401) << path;
            EXPECT_EQ(answer.headers.at("www-authenticate"), "Basic realm=\"Macadam\"");
            EXPECT_EQ(world.ask("GET", path, world.anna).status, 403) << path;
            ++closed;
        }
    }
    EXPECT_GE(closed, 10U);
    EXPECT_EQ(world.ask("GET", "/collections", world.reader).status, 200);
    EXPECT_EQ(world.ask("GET", "/collections", world.operator_).status, 200);
    EXPECT_EQ(world.ask("GET", "/health", "").status, 200);
}

TEST(TripsApi, LetsNoSharedCacheKeepWhatOnlyTokensShow) {
    const TakingWorld world{PrivacyProfile::own, {.workers = 0, .only_with_token = true}};
    auto page = world.ask("GET", "/tiles.json", world.reader);
    for (; page.status == 503; page = world.ask("GET", "/tiles.json", world.reader)) {
        std::this_thread::sleep_for(std::chrono::milliseconds{20}); // the test's limit ends it
    }
    const auto address = nlohmann::json::parse(page.body).at("tiles")[0].get<std::string>();
    const auto tile = world.ask(
        "GET", "/tiles/WebMercatorQuad/0/0/0" + address.substr(address.find('?')), world.reader);
    EXPECT_EQ(tile.headers.at("cache-control"), "private, max-age=31536000, immutable");
}

TEST(TripsApi, TakesNoTripThatTheDiskCannotHold) {
    TakingWorld world;
    TripsApi trips{uploads_beside(world.file), {.min_free_bytes = 0}, [] {}, {}};
    trips.set_crowd(true);
    HttpRequest request;
    request.method = "PUT";
    request.path = "/v1/trips/" + std::string(64, 'a');
    request.headers = {{"authorization", "Bearer " + world.anna},
                       {"content-type", "text/csv"},
                       {"content-length", "1000000000000000000"}};
    const auto refused = trips.admit(request).refusal;
    ASSERT_TRUE(refused);
    EXPECT_EQ(refused->status, 503);
    request.headers["content-length"] = "5";
    EXPECT_FALSE(trips.admit(request).refusal);

    constexpr std::uint64_t more_than_any_disk = std::uint64_t{1} << 60U;
    Upload upload;
    upload.sha256 = std::string(64, 'a');
    IncomingLog log{spool_of(world.file), upload, more_than_any_disk};
    EXPECT_THROW(log.add(std::string(300'000, 'x')), InputError); // others filled it meanwhile
}

TEST(TripsApi, CountsTheRequestsOfAnOwnerNotOfHisTokens) {
    TakingWorld world;
    TripsApi trips{uploads_beside(world.file), {.burst = 2}, [] {}, {}};
    const auto is_refused = [&](const std::string& token) {
        HttpRequest request;
        request.method = "GET";
        request.path = "/v1/trips";
        request.headers = {{"authorization", "Bearer " + token}};
        return trips.admit(request).refusal.has_value();
    };
    EXPECT_FALSE(is_refused(world.anna));
    EXPECT_FALSE(is_refused(world.token("anna", TokenScope::upload)));
    EXPECT_TRUE(is_refused(world.token("anna", TokenScope::upload)));
    EXPECT_FALSE(is_refused(world.ben));
}

TEST(TripsApi, LetsNobodyGuessTokens) {
    const TakingWorld world;
    int refused = 0;
    for (int i = 0; i < 25; ++i) {
        const auto answer = world.ask("GET", "/v1/trips", fmt::format("mac_{:08x}_", i));
        refused += answer.status == 429 ? 1 : 0;
        EXPECT_TRUE(answer.status == 401 || answer.headers.contains("retry-after"));
    }
    EXPECT_GE(refused, 4);
    EXPECT_EQ(world.ask("GET", "/v1/trips", world.anna).status, 200);
}

TEST(TripsApi, IsNotThereUntilSomebodyMadeAToken) {
    const auto path = test_folder() / "roads.gpkg";
    RoadStore::create(path, small_country(), settings());
    std::stop_source stop;
    std::promise<std::uint16_t> started;
    std::jthread server{[&] {
        serve_database(path,
                       Audience::anyone,
                       {.port = 0},
                       {},
                       Console{Verbosity::quiet, stop.get_token()},
                       [&](std::uint16_t port) { started.set_value(port); });
    }};
    const auto port = started.get_future().get();
    EXPECT_EQ(get(port, "/v1/trips").status, 404);
    make_uploads_folder(path);
    EXPECT_EQ(get(port, "/v1/trips").status, 401);
    stop.request_stop();
}

TEST(TripsApi, AllowsEachRoleWhatTheDefinitionSays) {
    TakingWorld world;
    const auto expired = world.token("old", TokenScope::upload, long_ago_ms);
    const auto unauthorised = [](int status) { return status == 401; };
    const auto forbidden = [](int status) { return status == 403; };
    const auto missing = [](int status) { return status == 404; };
    const auto done = [](int status) { return status >= 200 && status < 300; };
    const std::string log = "a log of anna";
    const auto paths = nlohmann::json::parse(get(world.port, "/api").body).at("paths");
    std::size_t looked_at = 0, of_operator = 0;
    for (const auto& [path, operations] : paths.items()) {
        for (const std::string method : {"get", "put", "post", "delete", "patch", "options"}) {
            auto target = path;
            if (const auto at = target.find("{sha256}"); at != std::string::npos) {
                target.replace(at, 8, sha256_of(log));
            }
            if (!path.starts_with("/v1/")) { // for all or the operator, to read
                const bool is_of_operator = path.starts_with("/collections/trips");
                EXPECT_EQ(operations.contains(method), method == "get") << path;
                EXPECT_EQ(method == "get" && operations.at("get").contains("security"),
                          method == "get" && is_of_operator)
                    << path;
                for (const auto& [token, status] : std::vector<std::pair<std::string, int>>{
                         {"", 401},
                         {expired, 401},
                         {world.reader, 403},
                         {world.anna, 403},
                         {world.operator_, path.ends_with("}") ? 404 : 200}}) {
                    if (method == "get" && is_of_operator) {
                        EXPECT_EQ(world.ask("GET", target, token).status, status) << path << token;
                        ++of_operator;
                    }
                }
                EXPECT_TRUE(
                    method == "get" ||
                    world.ask(method == "put" ? "PUT" : "POST", target, world.operator_, "x")
                            .status == 405)
                    << path;
                continue;
            }
            std::string verb = method;
            std::ranges::transform(
                verb, verb.begin(), [](char c) { return static_cast<char>(c - 'a' + 'A'); });
            if (!operations.contains(method)) {
                EXPECT_EQ(world.ask(verb, target, world.operator_, verb == "PUT" ? "x" : "").status,
                          405)
                    << verb << path;
                continue;
            }
            EXPECT_EQ(operations.at(method).at("security").size(), 2U);
            if (path == "/v1/tokens") { // for holders of an invitation, whose test is above
                continue;
            }
            ++looked_at;
            const bool is_list = path == "/v1/trips";
            const bool is_put = method == "put";
            const std::vector<std::pair<std::string, std::function<bool(int)>>> roles{
                {"", unauthorised},
                {"mac_00000000_" + std::string(64, '0'), unauthorised},
                {expired, unauthorised},
                {world.reader, forbidden},
                {world.ben, is_list || is_put ? std::function<bool(int)>{done} : missing},
                {world.anna, done},
                {world.operator_, done}};
            for (const auto& [token, expected] : roles) {
                ASSERT_TRUE(world.put(log, world.anna).status < 300);
                const auto status =
                    world.ask(verb, target, token, is_put ? std::string_view{log} : "").status;
                EXPECT_TRUE(expected(status)) << verb << path << token << status;
            }
        }
    }
    EXPECT_EQ(looked_at, 4U);
    EXPECT_EQ(of_operator, 4U * 5U);
}

TEST(TripsApi, ListsTheTripsOfTheDatabaseForItsOperatorAlone) {
    const TakingWorld world{PrivacyProfile::own};
    auto store = RoadStore::open(world.file);
    import_trips(store, 3);
    const auto ids = [&](const std::string& token) {
        std::vector<std::string> found;
        const auto page = nlohmann::json::parse(world.ask("GET", "/collections", token).body);
        for (const auto& collection : page.at("collections")) {
            found.push_back(collection.at("id"));
        }
        return found;
    };
    const std::vector<std::string> open{"segments", "worst", "events"};
    EXPECT_EQ(ids(""), open);
    EXPECT_EQ(ids(world.reader), open);
    EXPECT_EQ(ids(world.operator_),
              (std::vector<std::string>{"segments", "worst", "events", "trips"}));
    const auto items = [&](const std::string& query) {
        return nlohmann::json::parse(
            world.ask("GET", "/collections/trips/items" + query, world.operator_).body);
    };
    while (items("").at("numberMatched") != 3) {                    // the server looks each second
        std::this_thread::sleep_for(std::chrono::milliseconds{50}); // the test's limit ends it
    }
    EXPECT_EQ(items("?filter=passes%20%3E%200%20AND%20geometry%20IS%20NULL").at("numberMatched"),
              3);
    EXPECT_EQ(items("?filter=passes%20%3C%200").at("numberMatched"), 0);
    EXPECT_EQ(items("?bbox=-180,-90,180,90").at("numberMatched"), 0);
    EXPECT_EQ(items("?filter=S_INTERSECTS(geometry,BBOX(-180,-90,180,90))").at("numberMatched"), 0);
    const auto page = items("?limit=2");
    EXPECT_EQ(page.at("numberReturned"), 2);
    const auto trip = page.at("features")[0];
    EXPECT_TRUE(trip.at("geometry").is_null());
    std::vector<std::string> fields;
    for (const auto& [name, value] : trip.at("properties").items()) {
        fields.push_back(name);
    }
    EXPECT_EQ(fields, // nothing that tells where, or when within a day
              (std::vector<std::string>{"day",
                                        "driven_m",
                                        "matched_m",
                                        "method",
                                        "passes",
                                        "rows_read",
                                        "rows_used",
                                        "vehicle",
                                        "vehicle_model"}));
    const auto one = world.ask(
        "GET", "/collections/trips/items/" + trip.at("id").get<std::string>(), world.operator_);
    EXPECT_EQ(one.status, 200);
    EXPECT_EQ(one.headers.at("cache-control"), "no-store");
}

} // namespace
} // namespace macadam::testing
