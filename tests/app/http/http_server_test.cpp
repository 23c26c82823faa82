#include "app/http/http_server.hpp"

#include "app/http/response_finish.hpp"
#include "app/http/static_folder.hpp"
#include "storage/files/gzip.hpp"
#include "support/files/files.hpp"
#include "support/http/http_client.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <deque>
#include <filesystem>
#include <future>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace macadam::testing {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
using ::testing::Not;

HttpServerConfig config() {
    return {.port = 0, .workers = 2};
}

/// Answers every path with a text; "/slow" and "/fails" as they say.
HttpHandlers handlers() {
    HttpHandlers made;
    made.answer = [](const HttpRequest& request, std::size_t) -> HttpResponse {
        if (request.path == "/slow") {
            std::this_thread::sleep_for(500ms);
        }
        if (request.path == "/fails") {
            throw std::runtime_error{"secret.gpkg is broken"};
        }
        if (request.path == "/own") {
            return {
                .type = "text/plain", .body = std::string(5000, 'a'), .cache_control = "no-store"};
        }
        return {.type = "text/plain", .body = std::string(5000, 'a'), .etag = "v1"};
    };
    made.answer_at_once = [](const HttpRequest& request) -> std::optional<HttpResponse> {
        return request.path == "/health" ? std::optional{HttpResponse{.body = "well"}}
                                         : std::nullopt;
    };
    return made;
}

TEST(HttpServer, AnswersSeveralRequestsOnOneConnection) {
    const HttpServer server{config(), handlers()};
    HttpClient client{server.port()};
    for (int i = 0; i < 3; ++i) {
        client.send("GET /a HTTP/1.1\r\nHost: localhost\r\n\r\n");
        const auto answer = client.answer();
        EXPECT_EQ(answer.status, 200);
        EXPECT_EQ(answer.body.size(), 5000U);
    }
}

TEST(HttpServer, TellsBrowsersToRunNothingOfOthers) {
    const HttpServer server{config(), handlers()};
    const auto answer = get(server.port(), "/a");
    EXPECT_EQ(answer.headers.at("x-content-type-options"), "nosniff");
    EXPECT_THAT(answer.headers.at("content-security-policy"), HasSubstr("frame-ancestors 'none'"));
    EXPECT_FALSE(answer.headers.contains("access-control-allow-origin"));
}

TEST(HttpServer, LetsPagesOfAListedSiteReadAnswers) {
    auto open = config();
    open.allowed_origin = "*";
    const HttpServer server{open, handlers()};
    EXPECT_EQ(get(server.port(), "/a").headers.at("access-control-allow-origin"), "*");
}

TEST(HttpServer, SendsHeadsWithoutBodies) {
    const HttpServer server{config(), handlers()};
    HttpClient client{server.port()};
    client.send("HEAD /a HTTP/1.1\r\nHost: localhost\r\n\r\nGET /health HTTP/1.1\r\nHost: "
                "localhost\r\n\r\n");
    const auto head = client.answer(false);
    EXPECT_EQ(head.headers.at("content-length"), "5000");
    EXPECT_EQ(client.answer().body, "well");
}

TEST(HttpServer, CompressesForThoseWhoTakeIt) {
    const HttpServer server{config(), handlers()};
    const auto packed = get(server.port(), "/a", "Accept-Encoding: br, gzip;q=0.5\r\n");
    EXPECT_EQ(packed.headers.at("content-encoding"), "gzip");
    EXPECT_EQ(gunzipped(packed.body), std::string(5000, 'a'));
    EXPECT_FALSE(get(server.port(), "/a", "Accept-Encoding: gzip;q=0\r\n")
                     .headers.contains("content-encoding"));
    EXPECT_FALSE(get(server.port(), "/own", "Accept-Encoding: gzip\r\n")
                     .headers.contains("content-encoding")); // BREACH
}

TEST(HttpServer, SendsNothingThatTheClientHas) {
    const HttpServer server{config(), handlers()};
    const auto etag = get(server.port(), "/a").headers.at("etag");
    const auto again = get(server.port(), "/a", "If-None-Match: \"x\", W/" + etag + "\r\n");
    EXPECT_EQ(again.status, 304);
    EXPECT_TRUE(again.body.empty());
}

struct Refusal {
    std::string_view head; ///< of the request
    int status;
};

TEST(HttpServer, RefusesHostileHeads) {
    const HttpServer server{config(), handlers()};
    const std::string long_target =
        "GET /" + std::string(9000, 'a') + " HTTP/1.1\r\nHost: localhost\r\n";
    const std::string long_head =
        "GET / HTTP/1.1\r\nHost: localhost\r\nCookie: " + std::string(17000, 'a') + "\r\n";
    const std::string longest =
        "GET / HTTP/1.1\r\nHost: localhost\r\nCookie: " + std::string(60000, 'a') + "\r\n";
    for (const auto& [head, status] : {
             Refusal{long_target, 414},
             Refusal{long_head, 431},
             Refusal{longest, 431},
             Refusal{"POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 0\r\n", 405},
             Refusal{"DELETE / HTTP/1.1\r\nHost: localhost\r\n", 405},
             Refusal{"GET / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 5\r\n", 413},
             Refusal{"GET / HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: chunked\r\n", 413},
             Refusal{"GET / HTTP/1.1\r\n", 400},
             Refusal{"GET / HTTP/1.1\r\nHost: localhost\r\nHost: b\r\n", 400},
             Refusal{"GET / HTTP/1.1\r\nHost: evil.example\r\n", 421},
             Refusal{"GET / HTTP/1.1\r\nHost: 127.evil.example\r\n", 421},
             Refusal{"GET / HTTP/1.1\r\nHost: [::1].evil.example\r\n", 421},
             Refusal{"GET / HTTP/1.1\r\nHost: localhost\"><script>\r\n", 421},
             Refusal{"GET /%zz HTTP/1.1\r\nHost: localhost\r\n", 400},
             Refusal{"GET /a%00b HTTP/1.1\r\nHost: localhost\r\n", 400},
             Refusal{"GET /?a=%0 HTTP/1.1\r\nHost: localhost\r\n", 400},
         }) {
        HttpClient client{server.port()};
        client.send(std::string{head} + "\r\n");
        EXPECT_EQ(client.answer().status, status) << head.substr(0, 80);
    }
    EXPECT_EQ(get(server.port(), "/health").status, 200);
}

TEST(HttpServer, AnswersTargetsInAbsoluteForm) {
    const HttpServer server{config(), handlers()};
    EXPECT_EQ(get(server.port(), "http://localhost/health").body, "well");
    EXPECT_EQ(get(server.port(), "HTTP://[::1]:80/health?f=json").body, "well");
    EXPECT_EQ(get(server.port(), "https://localhost").status, 200);
    EXPECT_EQ(get(server.port(), "http://evil.example/health").status, 421);
}

TEST(HttpServer, AnswersWhateverTheNumberOfParameters) {
    auto made = handlers();
    made.answer = [](const HttpRequest& request, std::size_t) {
        return HttpResponse{.body = fmt::format("{}", request.parameters.size())};
    };
    const HttpServer server{config(), made};
    std::string query;
    for (int i = 0; i < 4000; ++i) {
        query += "a&";
    }
    EXPECT_EQ(get(server.port(), "/?" + query).body, "4000");
    EXPECT_EQ(get(server.port(), "/?a=1&b=2").body, "2");
}

TEST(HttpServer, SurvivesWhatIsNoHttp) {
    const HttpServer server{config(), handlers()};
    for (const std::string_view bytes :
         {"\0\0\0\0\r\n\r\n", "GET\r\n\r\n", "\x16\x03\x01\x02\r\n\r\n", "A B C D\r\n\r\n"}) {
        HttpClient client{server.port()};
        client.send(bytes);
    }
    EXPECT_EQ(get(server.port(), "/health").status, 200);
}

TEST(HttpServer, TellsStrangersNothingOfItsFailures) {
    std::string logged;
    auto made = handlers();
    made.failed = [&](const std::string&, const std::string& what) { logged = what; };
    const HttpServer server{config(), made};
    const auto answer = get(server.port(), "/fails");
    EXPECT_EQ(answer.status, 500);
    EXPECT_THAT(answer.body, Not(HasSubstr("secret")));
    EXPECT_THAT(logged, HasSubstr("secret"));
}

TEST(HttpServer, AnswersAtOnceWhileAllWorkersAreBusy) {
    const HttpServer server{config(), handlers()};
    std::deque<HttpClient> slow;
    for (int i = 0; i < 4; ++i) {
        slow.emplace_back(server.port()).send("GET /slow HTTP/1.1\r\nHost: localhost\r\n\r\n");
    }
    EXPECT_EQ(get(server.port(), "/health").body, "well");
    for (auto& client : slow) {
        EXPECT_EQ(client.answer().status, 200);
    }
}

TEST(HttpServer, ClosesConnectionsWhoseHeadIsLate) {
    auto quick = config();
    quick.head_time = 300ms;
    const HttpServer server{quick, handlers()};
    HttpClient slow{server.port()};
    std::atomic<bool> ends = false;
    std::thread drip{[&] { // a byte now and then never is inactive
        slow.send("GET / HTTP/1.1\r\n");
        while (!ends) {
            slow.send("X");
            std::this_thread::sleep_for(20ms);
        }
    }};
    EXPECT_TRUE(slow.is_closed());
    ends = true;
    drip.join();
}

TEST(HttpServer, LetsOneLaneWaitForNoOther) {
    auto lanes = config();
    lanes.workers = 1;
    lanes.lanes = {{.workers = 1, .max_waiting = 2}};
    auto made = handlers();
    std::promise<void> go;
    const auto may_go = go.get_future().share();
    std::atomic<int> asked = 0, begun = 0;
    made.lane = [&](const HttpRequest& request) -> std::size_t {
        const bool hangs = request.path == "/hung";
        asked += hangs ? 1 : 0;
        return hangs ? 1 : 0;
    };
    made.answer = [&](const HttpRequest& request, std::size_t worker) -> HttpResponse {
        if (request.path == "/hung") {
            ++begun;
            may_go.wait();
        }
        return {.body = std::to_string(worker)};
    };
    const HttpServer server{lanes, made};
    std::deque<HttpClient> hung;
    const auto wait_for = [](const std::atomic<int>& count, int wanted) {
        while (count < wanted) { // the test's time limit ends it
            std::this_thread::sleep_for(1ms);
        }
    };
    for (int i = 0; i < 4; ++i) { // one at work, two that wait, one too many
        hung.emplace_back(server.port()).send("GET /hung HTTP/1.1\r\nHost: localhost\r\n\r\n");
        wait_for(begun, 1);
    }
    wait_for(asked, 4);
    EXPECT_EQ(get(server.port(), "/a").body, "0");
    go.set_value();
    int answered = 0, refused = 0;
    for (auto& client : hung) {
        const auto answer = client.answer();
        answered += answer.body == "1" ? 1 : 0;
        refused += answer.status == 503 && answer.headers.at("retry-after") == "1" ? 1 : 0;
    }
    EXPECT_EQ(answered, 3);
    EXPECT_EQ(refused, 1);
}

/// Body on a disk that hangs until it is told to go on.
struct HungBody final : HttpBody {
    HungBody(std::shared_future<void> when,
             std::atomic<std::size_t>& its_bytes,
             std::atomic<std::size_t>& its_largest)
        : may_go{std::move(when)}, bytes{its_bytes}, largest{its_largest} {}
    void add(std::string_view block) override {
        may_go.wait();
        bytes += block.size();
        largest = std::max<std::size_t>(largest, block.size());
    }
    std::shared_future<void> may_go;
    std::atomic<std::size_t>& bytes;
    std::atomic<std::size_t>& largest;
};

TEST(HttpServer, AnswersWhileADiskHangs) {
    auto taking = config();
    taking.max_body_bytes = 2'000'000;
    taking.lanes = {{.workers = 1}};
    auto made = handlers();
    std::promise<void> go;
    std::atomic<std::size_t> bytes = 0, largest = 0;
    made.lane = [](const HttpRequest& request) -> std::size_t { return request.method == "PUT"; };
    made.admit = [&, may_go = go.get_future().share()](const HttpRequest&) -> HttpAdmission {
        return {.body = std::make_shared<HungBody>(may_go, bytes, largest)};
    };
    const HttpServer server{taking, made};
    const std::string log(1'500'000, 'x');
    std::deque<HttpClient> clients;
    std::vector<std::thread> sending;
    for (int i = 0; i < 4; ++i) {
        sending.emplace_back([&log, &client = clients.emplace_back(server.port())] {
            client.send("PUT /a HTTP/1.1\r\nHost: localhost\r\nContent-Length: 1500000\r\n\r\n");
            client.send(log);
        });
    }
    for (int i = 0; i < 20; ++i) {
        EXPECT_EQ(get(server.port(), "/health").body, "well");
        EXPECT_EQ(get(server.port(), "/a").status, 200);
    }
    EXPECT_EQ(bytes, 0U);
    go.set_value();
    for (auto& thread : sending) {
        thread.join();
    }
    for (auto& client : clients) {
        EXPECT_EQ(client.answer().status, 200);
    }
    EXPECT_EQ(bytes, 4 * log.size());
    EXPECT_LE(largest, 100'000U); // what one connection keeps in memory
}

struct CountedBody final : HttpBody {
    explicit CountedBody(std::atomic<std::size_t>& its_bytes) : bytes{its_bytes} {}
    void add(std::string_view block) override {
        if (block.find("full disk") != std::string_view::npos) {
            throw std::runtime_error{"no space left"};
        }
        bytes += block.size();
    }
    std::atomic<std::size_t>& bytes;
};

/// Takes bodies of at most 1 MB, but refuses the path "/no".
struct TakingServer {
    static HttpServerConfig limits(std::chrono::milliseconds body_time) {
        auto made = config();
        made.max_body_bytes = 1'000'000;
        made.body_time = body_time;
        return made;
    }
    explicit TakingServer(std::chrono::milliseconds body_time = 60s)
        : server{limits(body_time), [this] {
                     auto made = handlers();
                     made.admit = [this](const HttpRequest& request) -> HttpAdmission {
                         if (request.path == "/no") {
                             return {.refusal = http_problem(403, "no")};
                         }
                         return {.body = std::make_shared<CountedBody>(bytes)};
                     };
                     return made;
                 }()} {}

    std::atomic<std::size_t> bytes = 0;
    HttpServer server;
};

TEST(HttpServer, HandsBodiesOnBlockByBlock) {
    TakingServer taking;
    HttpClient client{taking.server.port()};
    for (int i = 0; i < 2; ++i) { // on one connection
        client.send("PUT /a HTTP/1.1\r\nHost: localhost\r\nContent-Length: 500000\r\n\r\n");
        client.send(std::string(500'000, 'x'));
        EXPECT_EQ(client.answer().status, 200);
    }
    EXPECT_EQ(taking.bytes, 1'000'000U);
}

TEST(HttpServer, AnswersARefusedBodyOnceItIsSent) {
    TakingServer taking;
    HttpClient client{taking.server.port()};
    for (int i = 0; i < 2; ++i) {
        client.send("PUT /no HTTP/1.1\r\nHost: localhost\r\nContent-Length: 900000\r\n\r\n");
        client.send(std::string(900'000, 'x'));
        EXPECT_EQ(client.answer().status, 403);
    }
    HttpClient patient{taking.server.port()};
    patient.send("PUT /no HTTP/1.1\r\nHost: localhost\r\nContent-Length: 900000\r\n"
                 "Expect: 100-continue\r\n\r\n");
    EXPECT_EQ(patient.answer().status, 403); // who asks first need not send it
    EXPECT_EQ(taking.bytes, 0U);
}

TEST(HttpServer, RefusesBodiesByTheirHeads) {
    TakingServer taking;
    for (const auto& [head, status] :
         {Refusal{"PUT / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 1000001\r\n", 413},
          Refusal{"PUT / HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: chunked\r\n", 411},
          Refusal{"PUT / HTTP/1.1\r\nHost: localhost\r\n", 411},
          Refusal{"GET / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 5\r\n", 413},
          Refusal{"PATCH / HTTP/1.1\r\nHost: localhost\r\n", 405},
          Refusal{"PUT / HTTP/1.1\r\nHost: evil.example\r\nContent-Length: 5\r\n", 421}}) {
        HttpClient client{taking.server.port()};
        client.send(std::string{head} + "\r\n");
        EXPECT_EQ(client.answer().status, status) << head;
    }
}

TEST(HttpServer, TakesNoBodyForARequest) {
    TakingServer taking;
    for (const auto* header : {"Content-Length : 42", "Transfer-Encoding\t: chunked"}) {
        HttpClient client{taking.server.port()};
        client.send(fmt::format("PUT /a HTTP/1.1\r\nHost: localhost\r\n{}\r\n\r\n"
                                "GET /health HTTP/1.1\r\nHost: localhost\r\n\r\n",
                                header));
        EXPECT_EQ(client.answer().status, 400) << header;
        EXPECT_EQ(client.answer().status, 0) << header; // the connection is closed
    }
}

TEST(HttpServer, TellsThatABodyCannotBeStored) {
    TakingServer taking;
    HttpClient client{taking.server.port()};
    client.send("PUT / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 9\r\n\r\nfull disk");
    const auto answer = client.answer();
    EXPECT_EQ(answer.status, 503);
    EXPECT_TRUE(answer.headers.contains("retry-after"));
}

TEST(HttpServer, ClosesConnectionsWhoseBodyIsLate) {
    TakingServer taking{300ms};
    HttpClient slow{taking.server.port()};
    slow.send("PUT / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 900\r\n\r\n");
    std::atomic<bool> ends = false;
    std::thread drip{[&] {
        while (!ends) {
            slow.send("x");
            std::this_thread::sleep_for(20ms);
        }
    }};
    EXPECT_TRUE(slow.is_closed());
    ends = true;
    drip.join();
}

TEST(HttpServer, ClosesConnectionsOfThoseWhoDoNotRead) {
    auto quick = config();
    quick.response_time = 300ms;
    auto made = handlers();
    made.answer = [](const HttpRequest&, std::size_t) {
        return HttpResponse{.type = "image/png", .body = std::string(20'000'000, 'a')};
    };
    quick.slowest_bytes = 1'000'000'000;
    const HttpServer server{quick, made};
    HttpClient lazy{server.port()};
    lazy.send("GET /a HTTP/1.1\r\nHost: localhost\r\n\r\n");
    while (server.connections() == 0) { // the test's time limit ends it
        std::this_thread::sleep_for(1ms);
    }
    while (server.connections() > 0) {
        std::this_thread::sleep_for(10ms);
    }
    SUCCEED();
}

TEST(HttpServer, RefusesAddressesWithTooManyConnections) {
    auto few = config();
    few.max_per_address = 3;
    const HttpServer server{few, handlers()};
    std::deque<HttpClient> clients;
    for (int i = 0; i < 3; ++i) {
        clients.emplace_back(server.port()).send("GET /health HTTP/1.1\r\nHost: localhost\r\n\r\n");
        EXPECT_EQ(clients.back().answer().status, 200);
    }
    EXPECT_EQ(get(server.port(), "/health").status, 0);
}

TEST(HttpServer, RefusesClientsOfAProxyWithTooManyRequests) {
    auto few = config();
    few.behind_proxy = true;
    few.max_per_address = 1;
    few.hosts = {"roads.example"};
    const HttpServer server{few, handlers()};
    HttpClient first{server.port()};
    first.send(
        "GET /slow HTTP/1.1\r\nHost: roads.example\r\nX-Forwarded-For: 6.6.6.6, 1.2.3.4\r\n\r\n");
    std::this_thread::sleep_for(100ms); // until it is at work
    const auto second = get(server.port(), "/a", "X-Forwarded-For: 1.2.3.4\r\n");
    EXPECT_EQ(second.status, 429);
    EXPECT_EQ(second.headers.at("retry-after"), "1");
    EXPECT_EQ(get(server.port(), "/a", "X-Forwarded-For: 1.2.3.5\r\n").status, 200);
    EXPECT_EQ(first.answer().status, 200);
}

TEST(HttpServer, AnswersWhatIsAtWorkBeforeItEnds) {
    std::optional<HttpServer> server;
    server.emplace(config(), handlers());
    HttpClient client{server->port()};
    client.send("GET /slow HTTP/1.1\r\nHost: localhost\r\n\r\n");
    std::this_thread::sleep_for(100ms);
    server->drain(10s);
    EXPECT_EQ(client.answer().status, 200);
    server.reset();
}

TEST(HttpServer, SaysThatAnAddressIsTaken) {
    const HttpServer server{config(), handlers()};
    auto taken = config();
    taken.port = server.port();
    EXPECT_THAT(refusal_of([&] {
                    const HttpServer second{taken, handlers()};
                }),
                HasSubstr("choose another with --listen"));
    taken.host = "localhost";
    EXPECT_THAT(refusal_of([&] {
                    const HttpServer second{taken, handlers()};
                }),
                HasSubstr("is no address"));
}

// -------------------------------------------------------------------------------------- files

/// Server of a folder with a file beside it that nobody may read.
struct FileWorld {
    FileWorld() {
        written(folder, "site/index.html", "<html>");
        written(folder, "site/a/roads.pmtiles", "0123456789");
        written(folder, "site/.hidden", "no");
        written(folder, "secret.txt", "no");
        std::filesystem::create_symlink(folder / "secret.txt", folder / "site/link.txt");
        HttpHandlers made;
        made.answer = [site = folder / "site"](const HttpRequest& request, std::size_t) {
            return file_response(site, request.path).value_or(http_problem(404, "none"));
        };
        server.emplace(config(), made);
    }
    std::filesystem::path folder = test_folder();
    std::optional<HttpServer> server;
};

TEST(StaticFolder, ServesFilesWithTheirTypes) {
    const FileWorld world;
    const auto page = get(world.server->port(), "/");
    EXPECT_EQ(page.body, "<html>");
    EXPECT_EQ(page.headers.at("content-type"), "text/html; charset=utf-8");
    EXPECT_EQ(page.headers.at("accept-ranges"), "bytes");
}

TEST(StaticFolder, SendsAFileThatIsRemovedMeanwhile) {
    const auto folder = test_folder();
    HttpHandlers made;
    made.answer = [&](const HttpRequest& request, std::size_t) {
        written(folder, "page.html", "<html>");
        auto response = file_response(folder, request.path).value_or(http_problem(404, "none"));
        std::filesystem::remove(folder / "page.html");
        return response;
    };
    const HttpServer server{config(), made};
    EXPECT_EQ(get(server.port(), "/page.html").body, "<html>");
}

TEST(StaticFolder, ServesRangesOfFiles) {
    const FileWorld world;
    const auto range = [&](const std::string& of) {
        return get(world.server->port(), "/a/roads.pmtiles", "Range: bytes=" + of + "\r\n");
    };
    EXPECT_EQ(range("2-4").status, 206);
    EXPECT_EQ(range("2-4").body, "234");
    EXPECT_EQ(range("2-4").headers.at("content-range"), "bytes 2-4/10");
    EXPECT_EQ(range("7-").body, "789");
    EXPECT_EQ(range("-2").body, "89");
    EXPECT_EQ(range("8-99").body, "89");
    EXPECT_EQ(range("10-").status, 416);
    EXPECT_EQ(range("10-").headers.at("content-range"), "bytes */10");
    EXPECT_EQ(range("4-2").status, 200);
    EXPECT_EQ(range("0-1,3-4").status, 200);
    EXPECT_EQ(range("18446744073709551616-").status, 200);
}

TEST(StaticFolder, SendsRangesOfTheSameFileAlone) {
    const FileWorld world;
    const auto port = world.server->port();
    const auto etag = get(port, "/a/roads.pmtiles").headers.at("etag");
    EXPECT_EQ(
        get(port, "/a/roads.pmtiles", "Range: bytes=0-1\r\nIf-Range: " + etag + "\r\n").status,
        206);
    EXPECT_EQ(get(port, "/a/roads.pmtiles", "Range: bytes=0-1\r\nIf-Range: \"old\"\r\n").status,
              200);
}

TEST(StaticFolder, LeadsFromFoldersToTheirPages) {
    const FileWorld world;
    const auto moved = get(world.server->port(), "/a");
    EXPECT_EQ(moved.status, 308);
    EXPECT_EQ(moved.headers.at("location"), "a/");
}

TEST(StaticFolder, ServesNothingOutside) {
    const FileWorld world;
    for (const std::string_view path : {"/../secret.txt",
                                        "/%2e%2e/secret.txt",
                                        "/a/../../secret.txt",
                                        "/a/%2e%2e/%2e%2e/secret.txt",
                                        "/..%2fsecret.txt",
                                        "/..%5csecret.txt",
                                        "/a/..\\..\\secret.txt",
                                        "//etc/passwd",
                                        "/%2fetc/passwd",
                                        "/link.txt",
                                        "/.hidden",

                                        "/a/",
                                        "/./index.html",
                                        "/a//roads.pmtiles",
                                        "/index.html/",
                                        "/index.html/x",
                                        "/%252e%252e/secret.txt",
                                        "/a/roads.pmtiles/..",
                                        "/proc/self/environ",
                                        "/....//secret.txt",
                                        "/%c0%ae%c0%ae/secret.txt"}) {
        EXPECT_EQ(get(world.server->port(), path).status, 404) << path;
    }
}

} // namespace
} // namespace macadam::testing
