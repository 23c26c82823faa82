#include "app/http/http_server.hpp"

#include "storage/files/gzip.hpp"
#include "support/files/files.hpp"
#include "support/http/http_client.hpp"
#include "support/http/text_server.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

namespace macadam::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(HttpServer, AnswersSeveralRequestsOnOneConnection) {
    const HttpServer server{text_config(), text_handlers()};
    HttpClient client{server.port()};
    for (int i = 0; i < 3; ++i) {
        client.send("GET /a HTTP/1.1\r\nHost: localhost\r\n\r\n");
        const auto answer = client.answer();
        EXPECT_EQ(answer.status, 200);
        EXPECT_EQ(answer.body.size(), 5000U);
    }
}

TEST(HttpServer, TellsBrowsersToRunNothingOfOthers) {
    const HttpServer server{text_config(), text_handlers()};
    const auto answer = get(server.port(), "/a");
    EXPECT_EQ(answer.headers.at("x-content-type-options"), "nosniff");
    EXPECT_THAT(answer.headers.at("content-security-policy"), HasSubstr("frame-ancestors 'none'"));
    EXPECT_FALSE(answer.headers.contains("access-control-allow-origin"));
}

TEST(HttpServer, SendsHeadsWithoutBodies) {
    const HttpServer server{text_config(), text_handlers()};
    HttpClient client{server.port()};
    client.send("HEAD /a HTTP/1.1\r\nHost: localhost\r\n\r\nGET /health HTTP/1.1\r\nHost: "
                "localhost\r\n\r\n");
    const auto head = client.answer(false);
    EXPECT_EQ(head.headers.at("content-length"), "5000");
    EXPECT_EQ(client.answer().body, "well");
}

TEST(HttpServer, CompressesForThoseWhoTakeIt) {
    const HttpServer server{text_config(), text_handlers()};
    const auto packed = get(server.port(), "/a", "Accept-Encoding: br, gzip;q=0.5\r\n");
    EXPECT_EQ(packed.headers.at("content-encoding"), "gzip");
    EXPECT_EQ(gunzipped(packed.body), std::string(5000, 'a'));
    EXPECT_FALSE(get(server.port(), "/a", "Accept-Encoding: gzip;q=0\r\n")
                     .headers.contains("content-encoding"));
    EXPECT_FALSE(get(server.port(), "/own", "Accept-Encoding: gzip\r\n")
                     .headers.contains("content-encoding")); // BREACH
}

TEST(HttpServer, SendsNothingThatTheClientHas) {
    const HttpServer server{text_config(), text_handlers()};
    const auto etag = get(server.port(), "/a").headers.at("etag");
    const auto again = get(server.port(), "/a", "If-None-Match: \"x\", W/" + etag + "\r\n");
    EXPECT_EQ(again.status, 304);
    EXPECT_TRUE(again.body.empty());
}

TEST(HttpServer, NamesCompressedAnswersByAnETagOfTheirOwn) {
    const HttpServer server{text_config(), text_handlers()};
    const std::string gzip = "Accept-Encoding: gzip\r\n";
    const auto plain = get(server.port(), "/a").headers.at("etag");
    const auto packed = get(server.port(), "/a", gzip).headers.at("etag");
    EXPECT_EQ(plain, "\"v1\"");
    EXPECT_EQ(packed, "W/\"v1\"");
    for (const auto& etag : {plain, packed}) {
        for (const auto& [takes, own] : {std::pair{std::string{}, plain}, {gzip, packed}}) {
            const auto again = get(server.port(), "/a", takes + "If-None-Match: " + etag + "\r\n");
            EXPECT_EQ(again.status, 304);
            EXPECT_EQ(again.headers.at("etag"), own);
            EXPECT_EQ(again.headers.at("vary"), "Accept-Encoding");
        }
    }
}

TEST(HttpServer, RefusesHostileHeads) {
    const HttpServer server{text_config(), text_handlers()};
    const std::string long_target =
        "GET /" + std::string(9000, 'a') + " HTTP/1.1\r\nHost: localhost\r\n";
    const std::string long_head =
        "GET / HTTP/1.1\r\nHost: localhost\r\nCookie: " + std::string(17000, 'a') + "\r\n";
    const std::string longest =
        "GET / HTTP/1.1\r\nHost: localhost\r\nCookie: " + std::string(60000, 'a') + "\r\n";
    for (const auto& [head, status] : {
             RefusedHead{long_target, 414},
             RefusedHead{long_head, 431},
             RefusedHead{longest, 431},
             RefusedHead{"POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 0\r\n", 405},
             RefusedHead{"DELETE / HTTP/1.1\r\nHost: localhost\r\n", 405},
             RefusedHead{"GET / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 5\r\n", 413},
             RefusedHead{"GET / HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: chunked\r\n",
                         413},
             RefusedHead{"GET / HTTP/1.1\r\n", 400},
             RefusedHead{"GET / HTTP/1.1\r\nHost: localhost\r\nHost: b\r\n", 400},
             RefusedHead{"GET / HTTP/1.1\r\nHost: evil.example\r\n", 421},
             RefusedHead{"GET / HTTP/1.1\r\nHost: 127.evil.example\r\n", 421},
             RefusedHead{"GET / HTTP/1.1\r\nHost: [::1].evil.example\r\n", 421},
             RefusedHead{"GET / HTTP/1.1\r\nHost: localhost\"><script>\r\n", 421},
             RefusedHead{"GET /%zz HTTP/1.1\r\nHost: localhost\r\n", 400},
             RefusedHead{"GET /a%00b HTTP/1.1\r\nHost: localhost\r\n", 400},
             RefusedHead{"GET /?a=%0 HTTP/1.1\r\nHost: localhost\r\n", 400},
         }) {
        HttpClient client{server.port()};
        client.send(std::string{head} + "\r\n");
        EXPECT_EQ(client.answer().status, status) << head.substr(0, 80);
    }
    EXPECT_EQ(get(server.port(), "/health").status, 200);
}

TEST(HttpServer, AnswersTargetsInAbsoluteForm) {
    const HttpServer server{text_config(), text_handlers()};
    EXPECT_EQ(get(server.port(), "http://localhost/health").body, "well");
    EXPECT_EQ(get(server.port(), "HTTP://[::1]:80/health?f=json").body, "well");
    EXPECT_EQ(get(server.port(), "https://localhost").status, 200);
    EXPECT_EQ(get(server.port(), "http://evil.example/health").status, 421);
}

TEST(HttpServer, AnswersWhateverTheNumberOfParameters) {
    auto made = text_handlers();
    made.answer = [](const HttpRequest& request, std::size_t) {
        return HttpResponse{.body = fmt::format("{}", request.parameters.size())};
    };
    const HttpServer server{text_config(), made};
    std::string query;
    for (int i = 0; i < 4000; ++i) {
        query += "a&";
    }
    EXPECT_EQ(get(server.port(), "/?" + query).body, "4000");
    EXPECT_EQ(get(server.port(), "/?a=1&b=2").body, "2");
}

TEST(HttpServer, SurvivesWhatIsNoHttp) {
    const HttpServer server{text_config(), text_handlers()};
    for (const std::string_view bytes :
         {"\0\0\0\0\r\n\r\n", "GET\r\n\r\n", "\x16\x03\x01\x02\r\n\r\n", "A B C D\r\n\r\n"}) {
        HttpClient client{server.port()};
        client.send(bytes);
    }
    EXPECT_EQ(get(server.port(), "/health").status, 200);
}

TEST(HttpServer, TellsStrangersNothingOfItsFailures) {
    std::string logged;
    auto made = text_handlers();
    made.failed = [&](const std::string&, const std::string& what) { logged = what; };
    const HttpServer server{text_config(), made};
    const auto answer = get(server.port(), "/fails");
    EXPECT_EQ(answer.status, 500);
    EXPECT_THAT(answer.body, Not(HasSubstr("secret")));
    EXPECT_THAT(logged, HasSubstr("secret"));
}

TEST(HttpServer, SaysThatAnAddressIsTaken) {
    const HttpServer server{text_config(), text_handlers()};
    auto taken = text_config();
    taken.port = server.port();
    EXPECT_THAT(refusal_of([&] {
                    const HttpServer second{taken, text_handlers()};
                }),
                HasSubstr("choose another with --listen"));
    taken.host = "localhost";
    EXPECT_THAT(refusal_of([&] {
                    const HttpServer second{taken, text_handlers()};
                }),
                HasSubstr("is no address"));
}

} // namespace
} // namespace macadam::testing
