// Trip logs in folders, and in buckets of a real service: npm's s3rver, which takes any signature
// (those are held against examples of AWS, request_signature_test.cpp).

#include "storage/objects/object_store.hpp"

#include "estimator/common/error.hpp"
#include "storage/files/sha256.hpp"
#include "support/program/program.hpp"
#include "support/program/shell.hpp"
#include "support/s3/s3_service.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cstdlib>
#include <filesystem>
#include <functional>
#include <string>

#include <sys/stat.h>

namespace macadam {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using testing::fresh_folder;
using ::testing::HasSubstr;
using testing::read_file;
using testing::S3Service;
using testing::write_file;

LogObject object_of(const std::string& bytes) {
    Sha256 hash;
    hash.add(bytes);
    return {hash.hex(), static_cast<std::int64_t>(bytes.size())};
}

std::string refusal_of(const std::function<void()>& call) {
    try {
        call();
    } catch (const InputError& error) {
        return error.what();
    }
    return "no refusal";
}

/// A log of many blocks, of which no two are alike.
std::string long_log() {
    std::string log;
    for (int i = 0; i < 60'000; ++i) {
        log += fmt::format("{},{}\n", i, i * 7919 % 10'007);
    }
    return log;
}

void expect_round_trip(ObjectStore& store, const fs::path& folder, const std::string& bytes) {
    const auto object = object_of(bytes);
    write_file(folder / "in", bytes);
    fs::remove(folder / "out");
    store.put(object, folder / "in");
    store.put(object, folder / "in"); // again: no matter
    store.fetch(object, folder / "out");
    EXPECT_EQ(read_file(folder / "out"), bytes);
    store.remove(object.sha256);
    store.remove(object.sha256);
    fs::remove(folder / "out");
    EXPECT_THAT(refusal_of([&] { store.fetch(object, folder / "out"); }),
                HasSubstr(fmt::format("object {} is missing", object.sha256)));
    EXPECT_FALSE(fs::exists(folder / "out"));
}

TEST(FolderObjects, ComeBackAsTheyWere) {
    const auto folder = fresh_folder();
    const auto store = open_object_store((folder / "logs").string());
    expect_round_trip(*store, folder, "");
    expect_round_trip(*store, folder, "a,b\n1,2\n");
    expect_round_trip(*store, folder, long_log());
}

TEST(FolderObjects, AreForTheirOwnerAloneUnlessTheFolderSaysOtherwise) {
    const auto folder = fresh_folder();
    const std::string bytes = "a trip";
    const auto object = object_of(bytes);
    write_file(folder / "in", bytes);
    const auto mode_of = [](const fs::path& path) {
        struct stat status {};
        EXPECT_EQ(::stat(path.c_str(), &status), 0) << path;
        return status.st_mode & 0777U;
    };
    const auto path =
        fs::path{object.sha256.substr(0, 2)} / object.sha256.substr(2, 2) / object.sha256;
    open_object_store((folder / "logs").string())->put(object, folder / "in");
    EXPECT_EQ(mode_of(folder / "logs"), 0700U);
    EXPECT_EQ(mode_of(folder / "logs" / path), 0600U);
    fs::create_directory(folder / "shared");
    ::chmod((folder / "shared").c_str(), 0750);
    open_object_store((folder / "shared").string())->put(object, folder / "in");
    EXPECT_EQ(mode_of(folder / "shared" / path), 0640U);
    fs::create_directory(folder / "of a group");
    ::chmod((folder / "of a group").c_str(), 02770);
    const auto before = ::umask(077);
    open_object_store((folder / "of a group").string())->put(object, folder / "in");
    ::umask(before);
    EXPECT_EQ(mode_of(folder / "of a group" / path), 0660U);
    EXPECT_EQ(mode_of((folder / "of a group" / path).parent_path()), 0770U);
}

TEST(FolderObjects, AreNotSoughtWhereNothingIsMounted) {
    const auto folder = fresh_folder() / "logs";
    const auto open = [&] { return open_object_store(folder.string(), {}, MissingFolder::refuse); };
    EXPECT_THAT(refusal_of(open),
                AllOf(HasSubstr("is no folder here"), HasSubstr("is it mounted?")));
    EXPECT_FALSE(fs::exists(folder));
    fs::create_directory(folder); // as a mount point
    EXPECT_THAT(refusal_of(open), AllOf(HasSubstr("has no .macadam"), HasSubstr("is it mounted?")));
    open_object_store(folder.string());
    const auto store = open();
    store->remove(object_of("a trip").sha256); // gone before: no matter
    fs::remove_all(folder);
    fs::create_directory(folder); // unmounted
    const auto refusal = HasSubstr("is it mounted?");
    EXPECT_THAT(refusal_of([&] { store->expect_in_place(); }), refusal);
    EXPECT_THAT(refusal_of([&] { store->remove(object_of("a trip").sha256); }), refusal);
    EXPECT_THAT(refusal_of([&] { store->fetch(object_of("a trip"), folder / "out"); }), refusal);
}

TEST(FolderObjects, AreCheckedByTheirHash) {
    const auto folder = fresh_folder();
    const auto store = open_object_store((folder / "logs").string());
    const std::string bytes = "a trip";
    auto object = object_of(bytes);
    write_file(folder / "in", "another one");
    EXPECT_THAT(refusal_of([&] { store->put(object, folder / "in"); }),
                HasSubstr("in: changed while it was stored"));
    EXPECT_THAT(refusal_of([&] { store->fetch(object, folder / "out"); }), HasSubstr("is missing"));
    write_file(folder / "in", bytes);
    store->put(object, folder / "in");
    const auto stored =
        folder / "logs" / object.sha256.substr(0, 2) / object.sha256.substr(2, 2) / object.sha256;
    for (const std::string spoilt : {"a crip", "a tri", "a trip and more"}) {
        write_file(stored, spoilt);
        EXPECT_THAT(refusal_of([&] { store->fetch(object, folder / "out"); }),
                    HasSubstr("is damaged: its bytes have another SHA-256"))
            << spoilt;
        EXPECT_FALSE(fs::exists(folder / "out")) << spoilt;
    }
}

TEST(ObjectStore, IsAFolderOrABucket) {
    const auto folder = fresh_folder();
    write_file(folder / "file", "");
    EXPECT_THAT(refusal_of([&] { open_object_store((folder / "file").string()); }),
                HasSubstr("is a file, expected a folder"));
    EXPECT_THAT(refusal_of([&] { open_object_store((folder / "no/such").string()); }),
                HasSubstr("cannot be made"));
    EXPECT_THAT(refusal_of([] { open_object_store("ftp://roads"); }),
                HasSubstr("expected a folder or s3://BUCKET/PREFIX"));
    for (const std::string location :
         {"s3://", "s3://Roads", "s3://me:secret@roads", "s3://roads/../x", "s3://roads/a//b"}) {
        EXPECT_THAT(refusal_of([&] { open_object_store(location); }),
                    HasSubstr("expected s3://BUCKET/PREFIX"))
            << location;
    }
}

TEST(S3Objects, ComeBackAsTheyWere) {
    const auto folder = fresh_folder();
    const S3Service service{folder};
    const auto store = open_object_store("s3://roads/logs/2026");
    expect_round_trip(*store, folder, "");
    expect_round_trip(*store, folder, "a,b\n1,2\n");
    expect_round_trip(*store, folder, long_log());
}

TEST(S3Objects, OfThisMachineGoThroughNoProxy) {
    const auto folder = fresh_folder();
    const S3Service service{folder};
    ::setenv("http_proxy", "http://127.0.0.1:9", 1); // NOLINT(concurrency-mt-unsafe)
    expect_round_trip(*open_object_store("s3://roads"), folder, "a trip");
    ::unsetenv("http_proxy"); // NOLINT(concurrency-mt-unsafe)
}

TEST(S3Objects, AreTriedAgainWhileTheServiceIsBusy) {
    const auto folder = fresh_folder();
    const S3Service service{folder, {"--failing", "3"}};
    expect_round_trip(*open_object_store("s3://roads"), folder, "a trip");
}

TEST(S3Objects, TellWhatAServiceSays) {
    const auto folder = fresh_folder();
    const S3Service service{folder, {"--failing", "5"}};
    write_file(folder / "in", "a trip");
    const auto put = [&](const std::string& location) {
        return refusal_of(
            [&] { open_object_store(location)->put(object_of("a trip"), folder / "in"); });
    };
    EXPECT_THAT(put("s3://roads/logs"),
                AllOf(HasSubstr("s3://roads/logs: cannot store an object: 127.0.0.1:"),
                      HasSubstr("answers 503, 'Please reduce your request rate.'")));
    EXPECT_THAT(put("s3://elsewhere"), HasSubstr("The specified bucket does not exist"));
}

/// Tests whether an object is the cause of an error, not the store.
bool is_unusable(const std::function<void()>& call) {
    try {
        call();
    } catch (const UnusableObject&) {
        return true;
    } catch (const InputError&) {
        return false;
    }
    ADD_FAILURE() << "no error";
    return false;
}

TEST(FolderObjects, TellAMissingObjectFromAMissingStore) {
    const auto folder = fresh_folder();
    const auto store = open_object_store((folder / "logs").string());
    const auto fetch = [&] { store->fetch(object_of("a trip"), folder / "out"); };
    EXPECT_TRUE(is_unusable(fetch));
    fs::remove_all(folder / "logs");
    EXPECT_FALSE(is_unusable(fetch));
}

TEST(S3Objects, TellAMissingObjectFromAServiceThatDoesNotServe) {
    const auto folder = fresh_folder();
    const auto fetch = [&](const std::string& location) {
        return [=] { open_object_store(location)->fetch(object_of("a trip"), folder / "out"); };
    };
    for (const auto* const status : {"401", "403", "400", "500"}) {
        const S3Service service{folder, {"--failing", "5", "--status", status}};
        EXPECT_FALSE(is_unusable(fetch("s3://roads"))) << status;
    }
    {
        const S3Service service{folder};
        EXPECT_TRUE(is_unusable(fetch("s3://roads")));
        EXPECT_FALSE(is_unusable(fetch("s3://elsewhere"))); // no such bucket
    }
    EXPECT_FALSE(is_unusable(fetch("s3://roads"))); // nobody listens any more
    EXPECT_FALSE(fs::exists(folder / "out"));
}

TEST(S3Objects, AreCheckedByTheirHash) {
    const auto folder = fresh_folder();
    const S3Service service{folder};
    const auto store = open_object_store("s3://roads");
    const auto object = object_of("a trip");
    write_file(folder / "in", "a crip");
    EXPECT_THAT(refusal_of([&] { store->put(object, folder / "in"); }),
                HasSubstr("in: changed while it was stored"));
    EXPECT_THAT(refusal_of([&] { store->fetch(object, folder / "out"); }), HasSubstr("is missing"));
    write_file(folder / "in", "a trip");
    store->put(object, folder / "in");
    auto shorter = object;
    shorter.bytes = 3;
    EXPECT_THAT(refusal_of([&] { store->fetch(shorter, folder / "out"); }),
                HasSubstr("is damaged"));
    EXPECT_FALSE(fs::exists(folder / "out"));
}

TEST(S3Objects, TravelEncryptedToServicesThatCanProveWhoTheyAre) {
    const auto folder = fresh_folder();
    testing::output_of(folder,
                       fmt::format("openssl req -x509 -newkey rsa:2048 -nodes -days 2 -subj "
                                   "/CN=localhost -keyout {0}/key.pem -out {0}/cert.pem",
                                   folder.string()));
    const S3Service service{folder, {"--tls"}};
    setenv("AWS_ENDPOINT_URL", fmt::format("https://localhost:{}", service.port()).c_str(), 1);
    write_file(folder / "in", "a trip");
    EXPECT_THAT(refusal_of([&] {
                    open_object_store("s3://roads")->put(object_of("a trip"), folder / "in");
                }),
                HasSubstr("certificate"));
    setenv("AWS_ENDPOINT_URL", "http://s3.example.org", 1);
    EXPECT_THAT(refusal_of([] { open_object_store("s3://roads"); }),
                HasSubstr("expected https://: trip logs tell where people drive"));
}

TEST(S3Objects, TakeTheirKeysFromAFileOfTheirOwnerAlone) {
    const auto folder = fresh_folder();
    const S3Service service{folder};
    unsetenv("AWS_ACCESS_KEY_ID");
    unsetenv("AWS_PROFILE");
    const auto file = folder / "credentials";
    setenv("AWS_SHARED_CREDENTIALS_FILE", file.c_str(), 1);
    const auto open = [] { open_object_store("s3://roads"); };
    EXPECT_THAT(refusal_of(open), HasSubstr("no keys for S3: expected AWS_ACCESS_KEY_ID"));
    write_file(file,
               "[other]\naws_access_key_id = x\naws_secret_access_key = y\n"
               "[default]\naws_access_key_id = S3RVER\n");
    EXPECT_THAT(refusal_of(open), HasSubstr("others can read these keys"));
    ::chmod(file.c_str(), 0600);
    EXPECT_THAT(refusal_of(open), HasSubstr("has no keys of profile [default]"));
    write_file(file,
               "[other]\naws_access_key_id = x\naws_secret_access_key = y\n"
               "[default]\naws_access_key_id = S3RVER\naws_secret_access_key=S3RVER\n");
    expect_round_trip(*open_object_store("s3://roads"), folder, "a trip");
}

} // namespace
} // namespace macadam
