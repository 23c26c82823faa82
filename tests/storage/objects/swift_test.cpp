// Trip logs in OpenStack Swift, by its S3 API, which verifies signatures.

#include "estimator/common/error.hpp"
#include "estimator/common/plugin_library.hpp"
#include "storage/files/sha256.hpp"
#include "storage/objects/http_transfer.hpp"
#include "storage/objects/object_store.hpp"
#include "storage/objects/request_signature.hpp"
#include "support/files/files.hpp"
#include "support/program/places.hpp"
#include "support/program/program.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>

namespace macadam {
namespace {

using namespace std::chrono_literals;
using testing::fresh_folder;
using ::testing::HasSubstr;
using testing::read_file;
using testing::refusal_of;
using testing::write_file;

constexpr int port = 17480;

/// Creates bucket "roads". \returns the status of the answer.
long make_bucket() {
    const auto host = fmt::format("127.0.0.1:{}", port);
    const auto time = fmt::format("{:%Y%m%dT%H%M%SZ}", fmt::gmtime(std::time(nullptr)));
    const std::string nothing{sha256_of_nothing};
    const S3Request request{
        .method = "PUT",
        .path = "/roads",
        .headers = {{"host", host}, {"x-amz-content-sha256", nothing}, {"x-amz-date", time}},
        .payload_sha256 = nothing};
    HttpTransfer transfer;
    transfer.method = request.method;
    transfer.url = "http://" + host + request.path;
    transfer.headers = {"x-amz-content-sha256: " + nothing,
                        "x-amz-date: " + time,
                        "authorization: " +
                            authorization_of(request,
                                             {.key_id = "test:tester", .secret = "testing"},
                                             {.region = "us-east-1", .time = time})};
    HttpOutcome outcome;
    plugin_function<HttpRun>("macadam_http.so", http_run_name)(transfer, outcome);
    return outcome.status;
}

TEST(Swift, KeepsObjectsOfThoseWhoSignWithTheirKey) {
    const auto folder = fresh_folder();
    const auto end = [](std::FILE* pipe) { pclose(pipe); };
    const std::unique_ptr<std::FILE, decltype(end)> swift{
        popen(fmt::format("{}/tests/support/s3/swift.sh {} {}",
                          testing::source_folder(),
                          folder.string(),
                          port)
                  .c_str(),
              "w"),
        end};
    constexpr long success = 200;
    long status = 0;
    for (int i = 0; i < 120 && status != success; ++i) {
        std::this_thread::sleep_for(500ms);
        status = make_bucket();
    }
    ASSERT_EQ(status, success) << read_file(folder / "proxy.log");
    setenv("AWS_ENDPOINT_URL", fmt::format("http://127.0.0.1:{}", port).c_str(), 1);
    setenv("AWS_ACCESS_KEY_ID", "test:tester", 1);
    setenv("AWS_SECRET_ACCESS_KEY", "testing", 1);
    std::string log;
    for (int i = 0; i < 100'000; ++i) {
        log += fmt::format("{},{}\n", i, i * 7919 % 10'007);
    }
    Sha256 hash;
    hash.add(log);
    const LogObject object{hash.hex(), static_cast<std::int64_t>(log.size())};
    write_file(folder / "in", log);
    const auto store = open_object_store("s3://roads/logs");
    store->put(object, folder / "in");
    store->put(object, folder / "in");
    store->fetch(object, folder / "out");
    EXPECT_EQ(read_file(folder / "out"), log);
    setenv("AWS_SECRET_ACCESS_KEY", "wrong", 1);
    EXPECT_THAT(
        refusal_of([&] { open_object_store("s3://roads/logs")->put(object, folder / "in"); }),
        HasSubstr("answers 403"));
    store->remove(object.sha256);
    std::filesystem::remove(folder / "out");
    EXPECT_THAT(refusal_of([&] { store->fetch(object, folder / "out"); }), HasSubstr("is missing"));
}

} // namespace
} // namespace macadam
