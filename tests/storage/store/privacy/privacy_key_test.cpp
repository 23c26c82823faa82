#include "storage/store/privacy/privacy_key.hpp"

#include "support/files/files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <functional>
#include <set>

#include <sys/inotify.h>
#include <sys/stat.h>
#include <unistd.h>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;

using ::testing::AllOf;
using ::testing::Each;
using ::testing::Ge;
using ::testing::HasSubstr;
using ::testing::Lt;
using ::testing::MatchesRegex;

const PrivacyKey key{PrivacyKey::Bytes{1, 2, 3}};

TEST(PrivacyKey, NamesACarByTheHmacOfItsIdAndNobodyByNone) {
    // printf 'macadam car 1\nv-38657c765e00' | openssl dgst -sha256 -mac HMAC, hexkey:010203000...
    EXPECT_EQ(key.pseudonym("WVWZZZ1JZXW000001"), "v-9c025c9c2056da1150807016486f7002");
    EXPECT_EQ(key.pseudonym(""), "unknown");
}

TEST(PrivacyKey, NamesCarsOtherwiseThanEveryOtherKey) {
    std::set<std::string> names;
    for (int i = 0; i < 100; ++i) {
        const auto other = PrivacyKey::make();
        EXPECT_THAT(other.pseudonym("van-7"), MatchesRegex("v-[0-9a-f]{32}"));
        names.insert(other.pseudonym("van-7"));
        names.insert(other.pseudonym("van-8"));
        names.insert("v-" + other.id());
    }
    EXPECT_EQ(names.size(), 300U);
}

TEST(PrivacyKey, KnowsACarOfADatabaseOfVersion2Again) {
    EXPECT_EQ(key.pseudonym_of_unkeyed(unkeyed_name_of("van-7")), key.pseudonym("van-7"));
    EXPECT_EQ(key.pseudonym_of_unkeyed("unknown"), "unknown");
    EXPECT_EQ(unkeyed_name_of("WVWZZZ1JZXW000001"), "v-38657c765e00"); // by sha256sum
    EXPECT_TRUE(is_unkeyed_name_of("v-38657c765e00", "WVWZZZ1JZXW000001"));
    EXPECT_FALSE(is_unkeyed_name_of("v-38657c765e00", "WVWZZZ1JZXW000002"));
    EXPECT_FALSE(is_unkeyed_name_of("unknown", ""));
    EXPECT_FALSE(is_unkeyed_name_of("", "a"));
}

TEST(PrivacyKey, DrawsTheSameNumbersForTheSameTripAndOthersForEveryOther) {
    const auto numbers = key.draw("abc", "ends", 1000);
    EXPECT_EQ(numbers, key.draw("abc", "ends", 1000));
    EXPECT_THAT(numbers, Each(AllOf(Ge(0.0), Lt(1.0))));
    EXPECT_NE(numbers, key.draw("abd", "ends", 1000));
    EXPECT_NE(numbers, key.draw("abc", "stops", 1000));
    EXPECT_NE(numbers, (PrivacyKey{PrivacyKey::Bytes{1, 2, 4}}.draw("abc", "ends", 1000)));

    std::array<int, 10> tenths{};
    for (const double number : numbers) {
        ++tenths.at(static_cast<std::size_t>(number * 10));
    }
    EXPECT_THAT(tenths, Each(AllOf(Ge(60), Lt(140)))); // 100 each, give or take four sigma
}

TEST(PrivacyKey, LiesInAFileForItsOwnerAlone) {
    const auto file = test_folder() / "roads.gpkg.key";
    const auto mask = ::umask(0);
    write_key(file, key);
    ::umask(mask);
    EXPECT_EQ(fs::status(file).permissions(), fs::perms::owner_read | fs::perms::owner_write);
    EXPECT_FALSE(is_open_to_others(file));
    EXPECT_EQ(read_key(file)->hex(), key.hex());
    fs::permissions(file, fs::perms::group_read, fs::perm_options::add);
    EXPECT_TRUE(is_open_to_others(file));
    EXPECT_EQ(read_key(file.string() + "2"), std::nullopt);
}

TEST(PrivacyKey, IsNeverWrittenOverAFileOrThroughALink) {
    const auto folder = test_folder();
    const auto file = written(folder, "a.key", "mine");
    EXPECT_THAT(refusal_of([&] { write_key(file, key); }), HasSubstr("a.key: exists"));
    fs::create_symlink(folder / "elsewhere", folder / "b.key");
    EXPECT_THAT(refusal_of([&] { write_key(folder / "b.key", key); }), HasSubstr("b.key: "));
    EXPECT_FALSE(fs::exists(folder / "elsewhere"));
}

/// What inotify(7) tells of a file meanwhile, as one mask.
std::uint32_t events_of(const fs::path& file, const std::function<void()>& work) {
    const int watch = ::inotify_init1(IN_NONBLOCK | IN_CLOEXEC);
    ::inotify_add_watch(watch, file.parent_path().c_str(), IN_CREATE | IN_MOVED_TO | IN_MODIFY);
    work();
    alignas(inotify_event) std::array<char, 16'384> bytes{};
    const auto size = ::read(watch, bytes.data(), bytes.size());
    ::close(watch);
    std::uint32_t seen = 0;
    for (std::ptrdiff_t at = 0; at < size;) {
        const auto* const event = reinterpret_cast<const inotify_event*>(bytes.data() + at);
        seen |= event->len > 0 && file.filename() == event->name ? event->mask : 0;
        at += static_cast<std::ptrdiff_t>(sizeof(inotify_event) + event->len);
    }
    return seen;
}

TEST(PrivacyKey, IsWholeFromTheMomentItsFileHasAName) { // else a kill could leave half a key
    const auto file = test_folder() / "a.key";
    const auto seen = events_of(file, [&] { write_key(file, key); });
    EXPECT_NE(seen & (IN_CREATE | IN_MOVED_TO), 0U);
    EXPECT_EQ(seen & IN_MODIFY, 0U);
    EXPECT_EQ(read_key(file)->hex(), key.hex());
}

TEST(PrivacyKey, OfAnotherLengthOrFormIsRefusedWithWords) {
    const auto folder = test_folder();
    const auto line = std::string{"# a key\n"};
    for (const auto& text : {std::string{},
                             std::string{"# a key"},
                             line,
                             line + key.hex().substr(1) + "\n",
                             line + key.hex() + "0\n",
                             line + "g" + key.hex().substr(1) + "\n",
                             line + "-" + key.hex().substr(1) + "\n",
                             key.hex() + "\n",
                             std::string(100'000, '\0')}) {
        const auto file = written(folder, "a.key", text);
        EXPECT_THAT(refusal_of([&] { read_key(file); }),
                    HasSubstr("a.key: is not a key file, "
                              "expected"));
    }
    EXPECT_EQ(read_key(written(folder, "a.key", line + key.hex() + "\r\n"))->hex(), key.hex());
}

TEST(PrivacyKey, LiesBesideTheDatabaseWhereverALinkToItLies) {
    const auto folder = test_folder();
    const auto database = written(folder, "here/roads.gpkg", "");
    fs::create_symlink(database, folder / "link.gpkg");
    EXPECT_EQ(key_file_of(folder / "link.gpkg"), key_file_of(database));
    EXPECT_EQ(key_file_of(database).filename(), "roads.gpkg.key");
}

} // namespace
} // namespace macadam::testing
