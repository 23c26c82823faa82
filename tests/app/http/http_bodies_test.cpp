// Bodies of requests.

#include "app/http/http_server.hpp"
#include "support/http/http_client.hpp"
#include "support/http/text_server.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstddef>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

namespace macadam::testing {
namespace {

using namespace std::chrono_literals;

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
        auto made = text_config();
        made.max_body_bytes = 1'000'000;
        made.body_time = body_time;
        return made;
    }
    explicit TakingServer(std::chrono::milliseconds body_time = 60s)
        : TakingServer{limits(body_time)} {}
    explicit TakingServer(const HttpServerConfig& config)
        : server{config, [this] {
                     auto made = text_handlers();
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

TEST(HttpBodies, HandsBodiesOnBlockByBlock) {
    TakingServer taking;
    HttpClient client{taking.server.port()};
    for (int i = 0; i < 2; ++i) { // on one connection
        client.send("PUT /a HTTP/1.1\r\nHost: localhost\r\nContent-Length: 500000\r\n\r\n");
        client.send(std::string(500'000, 'x'));
        EXPECT_EQ(client.answer().status, 200);
    }
    EXPECT_EQ(taking.bytes, 1'000'000U);
}

TEST(HttpBodies, AnswersARefusedBodyOnceItIsSent) {
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

TEST(HttpBodies, RefusesBodiesByTheirHeads) {
    TakingServer taking;
    for (const auto& [head, status] :
         {RefusedHead{"PUT / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 1000001\r\n", 413},
          RefusedHead{"PUT / HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: chunked\r\n", 411},
          RefusedHead{"PUT / HTTP/1.1\r\nHost: localhost\r\n", 411},
          RefusedHead{"GET / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 5\r\n", 413},
          RefusedHead{"PATCH / HTTP/1.1\r\nHost: localhost\r\n", 405},
          RefusedHead{"PUT / HTTP/1.1\r\nHost: evil.example\r\nContent-Length: 5\r\n", 421}}) {
        HttpClient client{taking.server.port()};
        client.send(std::string{head} + "\r\n");
        EXPECT_EQ(client.answer().status, status) << head;
    }
}

TEST(HttpBodies, TakesNoBodyForARequest) {
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

TEST(HttpBodies, TellsThatABodyCannotBeStored) {
    TakingServer taking;
    HttpClient client{taking.server.port()};
    client.send("PUT / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 9\r\n\r\nfull disk");
    const auto answer = client.answer();
    EXPECT_EQ(answer.status, 503);
    EXPECT_TRUE(answer.headers.contains("retry-after"));
}

TEST(HttpBodies, ClosesConnectionsWhoseBodyIsLate) {
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

TEST(HttpBodies, GivesAdmittedUploadsMoreTimeThanOthers) {
    auto limits = TakingServer::limits(1s);
    limits.slowest_upload_bytes = 1; // a second
    limits.slowest_bytes = 1'000'000;
    const TakingServer taking{limits};
    for (const auto& [path, status] : {std::pair{"/a", 200}, {"/no", 0}}) {
        HttpClient slow{taking.server.port()};
        slow.send(
            fmt::format("PUT {} HTTP/1.1\r\nHost: localhost\r\nContent-Length: 1001\r\n\r\n{}",
                        path,
                        std::string(1000, 'x')));
        std::this_thread::sleep_for(2s); // longer than a refused one has
        slow.send("x");
        EXPECT_EQ(slow.answer().status, status) << path;
    }
}

} // namespace
} // namespace macadam::testing
