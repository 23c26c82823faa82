#include "app/http/static_folder.hpp"

#include "app/http/compressed_files.hpp"
#include "app/http/http_server.hpp"
#include "storage/files/gzip.hpp"
#include "support/files/files.hpp"
#include "support/http/hostile_texts.hpp"
#include "support/http/http_client.hpp"
#include "support/http/text_server.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace macadam::testing {
namespace {

/// Server of a folder with a file beside it that nobody may read.
struct FileWorld {
    FileWorld() {
        written(folder, "site/index.html", "<html>");
        written(folder, "site/a/roads.pmtiles", "0123456789");
        written(folder, "site/.hidden", "no");
        written(folder, "site/site.js", script);
        written(folder, "site/large.pmtiles", script);
        written(folder, "site/large.png", script);
        written(folder, "secret.txt", "no");
        std::filesystem::create_symlink(folder / "secret.txt", folder / "site/link.txt");
        HttpHandlers made;
        made.answer = [site = folder / "site"](const HttpRequest& request, std::size_t) {
            return file_response(site, request.path).value_or(http_problem(404, "none"));
        };
        server.emplace(text_config(), made);
    }
    std::filesystem::path folder = test_folder();
    std::string script = std::string(20'000, 'a') + "b";
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
    const HttpServer server{text_config(), made};
    EXPECT_EQ(get(server.port(), "/page.html").body, "<html>");
}

TEST(StaticFolder, MixesNoVersionsOfAFileThatIsWrittenToMeanwhile) {
    const FileWorld world;
    const std::size_t size = 40'000'000; // more than a connection keeps on its way
    written(world.folder, "site/roads.bin", std::string(size, 'a'));
    HttpClient client{world.server->port()};
    client.send("GET /roads.bin HTTP/1.1\r\nHost: localhost\r\n\r\n");
    const auto head = client.read_until("\r\n\r\n");
    EXPECT_TRUE(head.find("200 OK") != std::string::npos) << head;
    {
        std::fstream file{world.folder / "site/roads.bin", std::ios::in | std::ios::out};
        file << std::string(size, 'b');
    }
    const auto body = client.read_until("b");
    EXPECT_LT(body.size(), size); // cut, so that nobody takes it for whole
    EXPECT_EQ(body.find('b'), std::string::npos);
    EXPECT_EQ(get(world.server->port(), "/roads.bin").body, std::string(size, 'b'));
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

TEST(StaticFolder, CompressesWhatIsTextForThoseWhoTakeIt) {
    const FileWorld world;
    const auto port = world.server->port();
    const std::string gzip = "Accept-Encoding: gzip\r\n";
    const auto before = std::distance(std::filesystem::directory_iterator{world.folder / "site"},
                                      std::filesystem::directory_iterator{});
    for (int i = 0; i < 2; ++i) { // the second time from memory
        const auto packed = get(port, "/site.js", gzip);
        EXPECT_EQ(packed.status, 200);
        EXPECT_EQ(packed.headers.at("content-encoding"), "gzip");
        EXPECT_EQ(packed.headers.at("content-type"), "text/javascript; charset=utf-8");
        EXPECT_EQ(packed.headers.at("vary"), "Accept-Encoding");
        EXPECT_LT(packed.body.size(), 1000U);
        EXPECT_EQ(gunzipped(packed.body), world.script);
    }
    const auto plain = get(port, "/site.js");
    EXPECT_FALSE(plain.headers.contains("content-encoding"));
    EXPECT_EQ(plain.headers.at("vary"), "Accept-Encoding");
    EXPECT_EQ(plain.body, world.script);
    for (const auto* const picture : {"/large.pmtiles", "/large.png"}) {
        EXPECT_EQ(get(port, picture, gzip).body, world.script) << picture;
    }
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator{world.folder / "site"},
                            std::filesystem::directory_iterator{}),
              before); // the folder belongs to its owner
}

TEST(StaticFolder, SendsRangesOfTheFileAsItIs) {
    const FileWorld world;
    const auto port = world.server->port();
    const std::string gzip = "Accept-Encoding: gzip\r\n";
    const auto packed = get(port, "/site.js", gzip).headers.at("etag");
    const auto range = get(port, "/site.js", gzip + "Range: bytes=20000-\r\n");
    EXPECT_EQ(range.status, 206);
    EXPECT_FALSE(range.headers.contains("content-encoding"));
    EXPECT_EQ(range.body, "b");
    EXPECT_NE(range.headers.at("etag"), packed); // parts of the two are never put together
    const auto other =
        get(port, "/site.js", gzip + "Range: bytes=20000-\r\nIf-Range: " + packed + "\r\n");
    EXPECT_EQ(other.status, 200);
}

TEST(StaticFolder, CompressesAFileAnewOnceItHasChanged) {
    const FileWorld world;
    const std::string gzip = "Accept-Encoding: gzip\r\n";
    const auto before = get(world.server->port(), "/site.js", gzip);
    written(world.folder, "site/site.js", std::string(20'002, 'c'));
    const auto after = get(world.server->port(), "/site.js", gzip);
    EXPECT_NE(after.headers.at("etag"), before.headers.at("etag"));
    EXPECT_EQ(gunzipped(after.body), std::string(20'002, 'c'));
}

TEST(CompressedFiles, KeepTheLatestWithinTheirRoom) {
    const auto folder = test_folder();
    CompressedFiles kept{50}; // bytes: one of these files
    std::vector<HttpFile> files;
    for (const auto* const name : {"a", "b"}) {
        const auto file = written(folder, name, std::string(5000, *name));
        files.push_back({std::make_shared<const HttpOpenFile>(file), 5000});
    }
    const auto first = kept.get("a", files[0]);
    EXPECT_EQ(kept.get("a", files[0]), first);
    kept.get("b", files[1]);
    EXPECT_NE(kept.get("a", files[0]), first);
    written(folder, "b", std::string(6000, 'c'));
    EXPECT_EQ(kept.get("changed", files[1]), nullptr); // it is not what was opened
}

TEST(StaticFolder, LeadsFromFoldersToTheirPages) {
    const FileWorld world;
    const auto moved = get(world.server->port(), "/a");
    EXPECT_EQ(moved.status, 308);
    EXPECT_EQ(moved.headers.at("location"), "a/");
}

TEST(StaticFolder, ServesNothingOutside) {
    const FileWorld world;
    for (const auto path : path_traversals) {
        const auto answer = get(world.server->port(), path);
        EXPECT_TRUE(answer.status == 404 || answer.status == 400) << path << answer.status;
    }
}

TEST(StaticFolder, ServesFilesByTheirNamesAlone) {
    const FileWorld world;
    for (const std::string_view path : {"/link.txt",
                                        "/.hidden",
                                        "/a/",
                                        "/./index.html",
                                        "/a//roads.pmtiles",
                                        "/index.html/",
                                        "/index.html/x",
                                        "/a/roads.pmtiles/.."}) {
        EXPECT_EQ(get(world.server->port(), path).status, 404) << path;
    }
}

} // namespace
} // namespace macadam::testing
