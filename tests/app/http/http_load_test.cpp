// Many clients at once, slow ones, and a slow disk.

#include "app/http/http_server.hpp"
#include "app/http/limits/client_network.hpp"
#include "support/http/http_client.hpp"
#include "support/http/text_server.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <deque>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

namespace macadam::testing {
namespace {

using namespace std::chrono_literals;

TEST(HttpLoad, AnswersAtOnceWhileAllWorkersAreBusy) {
    const HttpServer server{text_config(), text_handlers()};
    std::deque<HttpClient> slow;
    for (int i = 0; i < 4; ++i) {
        slow.emplace_back(server.port()).send("GET /slow HTTP/1.1\r\nHost: localhost\r\n\r\n");
    }
    EXPECT_EQ(get(server.port(), "/health").body, "well");
    for (auto& client : slow) {
        EXPECT_EQ(client.answer().status, 200);
    }
}

TEST(HttpLoad, ClosesConnectionsWhoseHeadIsLate) {
    auto quick = text_config();
    quick.head_time = 300ms;
    const HttpServer server{quick, text_handlers()};
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

TEST(HttpLoad, LetsOneLaneWaitForNoOther) {
    auto lanes = text_config();
    lanes.workers = 1;
    lanes.lanes = {{.workers = 1, .max_waiting = 2}};
    auto made = text_handlers();
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

TEST(HttpLoad, LetsOneClientHaveAFewRequestsInALaneAlone) {
    auto lanes = text_config();
    lanes.behind_proxy = true;
    lanes.lanes = {{.workers = 1, .max_waiting = 100, .max_per_client = 2}};
    auto made = text_handlers();
    std::promise<void> go;
    made.lane = [](const HttpRequest& request) -> std::size_t { return request.path == "/hung"; };
    made.answer = [may_go = go.get_future().share()](const HttpRequest& request,
                                                     std::size_t) -> HttpResponse {
        if (request.path == "/hung") {
            may_go.wait();
        }
        return {.body = "a"};
    };
    std::atomic<int> refused = 0;
    made.record = [&](const HttpRecord& record) { refused += record.status == 429 ? 1 : 0; };
    const HttpServer server{lanes, made};
    std::deque<HttpClient> clients;
    const auto ask = [&](std::string_view path, std::string_view address) {
        clients.emplace_back(server.port())
            .send(fmt::format("GET {} HTTP/1.1\r\nHost: localhost\r\nX-Forwarded-For: {}\r\n\r\n",
                              path,
                              address));
    };
    for (int i = 1; i <= 3; ++i) { // addresses of one client, who has 64 bits of them
        ask("/hung", fmt::format("2001:db8::{}", i));
    }
    while (refused < 1) { // the test's time limit ends it
        std::this_thread::sleep_for(1ms);
    }
    ask("/hung", "2001:db8:0:1::1");
    ask("/a", "2001:db8::1");
    EXPECT_EQ(clients.back().answer().status, 200); // of another lane
    go.set_value();
    clients.pop_back();
    EXPECT_EQ(clients.back().answer().status, 200);
    clients.pop_back();
    int answered = 0;
    for (auto& client : clients) {
        answered += client.answer().status == 200 ? 1 : 0;
    }
    EXPECT_EQ(answered, 2);
    EXPECT_EQ(refused, 1);
    EXPECT_EQ(get(server.port(), "/hung", "X-Forwarded-For: 2001:db8::1\r\n").status, 200);
}

TEST(HttpLoad, TellsClientsApartByTheirNetworks) {
    EXPECT_EQ(client_network("2001:db8:1:2:3:4:5:6"), "2001:db8:1:2::/64");
    EXPECT_EQ(client_network("2001:db8:1:2::"), "2001:db8:1:2::/64");
    EXPECT_NE(client_network("2001:db8:1:3::"), "2001:db8:1:2::/64");
    EXPECT_EQ(client_network("203.0.113.9"), "203.0.113.9");
    EXPECT_EQ(client_network("::ffff:203.0.113.9"), "203.0.113.9"); // not one with all of IPv4
    EXPECT_EQ(client_network("unknown"), "unknown");
    EXPECT_EQ(client_network(""), "");
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

TEST(HttpLoad, AnswersWhileADiskHangs) {
    auto taking = text_config();
    taking.max_body_bytes = 2'000'000;
    taking.lanes = {{.workers = 1}};
    auto made = text_handlers();
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

TEST(HttpLoad, ClosesConnectionsOfThoseWhoDoNotRead) {
    auto quick = text_config();
    quick.response_time = 300ms;
    auto made = text_handlers();
    std::promise<void> asked;
    made.answer = [&](const HttpRequest&, std::size_t) {
        asked.set_value();
        return HttpResponse{.type = "image/png", .body = std::string(20'000'000, 'a')};
    };
    quick.slowest_bytes = 1'000'000'000;
    const HttpServer server{quick, made};
    HttpClient lazy{server.port()};
    lazy.send("GET /a HTTP/1.1\r\nHost: localhost\r\n\r\n");
    asked.get_future().wait();
    while (server.connections() > 0) { // the test's time limit ends it
        std::this_thread::sleep_for(10ms);
    }
    SUCCEED();
}

TEST(HttpLoad, RefusesMoreToAnAddressThatReadsNothing) {
    auto few = text_config();
    few.behind_proxy = true;
    few.hosts = {"roads.example"};
    few.max_unread_per_address = 50'000'000;
    auto made = text_handlers();
    made.answer = [](const HttpRequest&, std::size_t) {
        return HttpResponse{.type = "image/png", .body = std::string(20'000'000, 'a')};
    };
    std::atomic<int> answered = 0;
    made.record = [&](const HttpRecord& record) { answered += record.status == 200 ? 1 : 0; };
    const HttpServer server{few, made};
    std::deque<HttpClient> lazy;
    for (int i = 0; i < 2; ++i) {
        lazy.emplace_back(server.port())
            .send("GET /a HTTP/1.1\r\nHost: roads.example\r\nX-Forwarded-For: 1.2.3.4\r\n\r\n");
    }
    while (answered < 2) { // the test's time limit ends it
        std::this_thread::sleep_for(1ms);
    }
    const auto third = get(server.port(), "/a", "X-Forwarded-For: 1.2.3.4\r\n");
    EXPECT_EQ(third.status, 429);
    EXPECT_EQ(third.headers.at("retry-after"), "1");
    EXPECT_EQ(get(server.port(), "/a", "X-Forwarded-For: 1.2.3.5\r\n").body.size(), 20'000'000U);
    EXPECT_EQ(get(server.port(), "/health", "X-Forwarded-For: 1.2.3.4\r\n").body, "well");
    for (auto& client : lazy) { // what was promised comes
        EXPECT_EQ(client.answer().body.size(), 20'000'000U);
    }
}

TEST(HttpLoad, RefusesAddressesWithTooManyConnections) {
    auto few = text_config();
    few.max_per_address = 3;
    const HttpServer server{few, text_handlers()};
    std::deque<HttpClient> clients;
    for (int i = 0; i < 3; ++i) {
        clients.emplace_back(server.port()).send("GET /health HTTP/1.1\r\nHost: localhost\r\n\r\n");
        EXPECT_EQ(clients.back().answer().status, 200);
    }
    EXPECT_EQ(get(server.port(), "/health").status, 0);
}

TEST(HttpLoad, RefusesClientsOfAProxyWithTooManyRequests) {
    auto few = text_config();
    few.behind_proxy = true;
    few.max_per_address = 1;
    few.hosts = {"roads.example"};
    auto made = text_handlers();
    std::promise<void> begun, go;
    made.answer = [&](const HttpRequest& request, std::size_t) -> HttpResponse {
        if (request.path == "/held") {
            begun.set_value();
            go.get_future().wait();
        }
        return {.body = "a"};
    };
    const HttpServer server{few, made};
    HttpClient first{server.port()};
    first.send(
        "GET /held HTTP/1.1\r\nHost: roads.example\r\nX-Forwarded-For: 6.6.6.6, 1.2.3.4\r\n\r\n");
    begun.get_future().wait();
    const auto second = get(server.port(), "/a", "X-Forwarded-For: 1.2.3.4\r\n");
    EXPECT_EQ(second.status, 429);
    EXPECT_EQ(second.headers.at("retry-after"), "1");
    EXPECT_EQ(get(server.port(), "/a", "X-Forwarded-For: 1.2.3.5\r\n").status, 200);
    go.set_value();
    EXPECT_EQ(first.answer().status, 200);
}

TEST(HttpLoad, AnswersWhatIsAtWorkBeforeItEnds) {
    auto made = text_handlers();
    std::promise<void> begun;
    made.answer = [&](const HttpRequest&, std::size_t) -> HttpResponse {
        begun.set_value();
        std::this_thread::sleep_for(500ms);
        return {.body = "a"};
    };
    std::optional<HttpServer> server;
    server.emplace(text_config(), made);
    HttpClient client{server->port()};
    client.send("GET /a HTTP/1.1\r\nHost: localhost\r\n\r\n");
    begun.get_future().wait();
    server->drain(1min);
    EXPECT_EQ(client.answer().status, 200);
    server.reset();
}

} // namespace
} // namespace macadam::testing
