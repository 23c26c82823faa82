#include "storage/uploads/sealed_log.hpp"

#include "estimator/common/error.hpp"
#include "support/files/files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

void write_file(const fs::path& file, const std::string& bytes) {
    std::ofstream{file, std::ios::binary} << bytes;
}

std::string read_file(const fs::path& file) {
    std::ifstream in{file, std::ios::binary};
    return {std::istreambuf_iterator<char>{in}, {}};
}

struct Sealed {
    fs::path folder = test_folder();
    fs::path log = folder / "a.csv";
    fs::path file = folder / "a.csv.sealed";
    fs::path link = folder / "open.csv";
    LogKey key = LogKey::make();

    void seal(const std::string& text) const {
        write_file(log, text);
        seal_log(log, file, key.public_key());
    }

    std::string opened(const LogKey& by) const { return read_file(*opened_log(file, by, link)); }
};

std::string text_of_size(std::size_t size) {
    std::string text;
    for (std::size_t i = 0; text.size() < size; ++i) {
        text += std::to_string(i * i) + ",";
    }
    text.resize(size);
    return text;
}

constexpr std::size_t block = 65536;

TEST(SealedLog, IsOpenedByItsKey) {
    const Sealed sealed;
    for (const std::size_t size :
         {std::size_t{0}, std::size_t{1}, block - 1, block, block + 1, 3 * block}) {
        const auto text = text_of_size(size);
        sealed.seal(text);
        EXPECT_EQ(sealed.opened(sealed.key), text) << size;
    }
}

TEST(SealedLog, ShowsNothingOfTheLog) {
    const Sealed sealed;
    const auto text = text_of_size(2 * block);
    sealed.seal(text);
    const auto bytes = read_file(sealed.file);
    for (std::size_t at = 0; at + 16 < text.size(); at += 997) {
        EXPECT_EQ(bytes.find(text.substr(at, 16)), std::string::npos) << at;
    }
    EXPECT_EQ(fs::status(sealed.file).permissions(),
              fs::perms::owner_read | fs::perms::owner_write);
    sealed.seal(text);
    EXPECT_NE(read_file(sealed.file), bytes); // nor whether two are the same
}

TEST(SealedLog, IsOpenOnlyWhileItIsHeld) {
    const Sealed sealed;
    sealed.seal("a log");
    auto open = opened_log(sealed.file, sealed.key, sealed.link);
    EXPECT_TRUE(fs::is_symlink(sealed.link)); // no byte of it is on the disk
    EXPECT_THAT(fs::read_symlink(sealed.link).string(), HasSubstr("/proc/self/fd/"));
    open.reset();
    EXPECT_FALSE(fs::is_symlink(sealed.link));
}

TEST(SealedLog, IsRefusedToAnotherKey) {
    const Sealed sealed;
    sealed.seal("a log");
    EXPECT_THAT(refusal_of([&] { sealed.opened(LogKey::make()); }),
                AllOf(HasSubstr("a.csv.sealed"), HasSubstr("was not sealed for this key")));
    EXPECT_FALSE(fs::is_symlink(sealed.link));
}

TEST(SealedLog, IsRefusedIfItWasChangedOrCutOff) {
    const Sealed sealed;
    sealed.seal(text_of_size(2 * block));
    const auto whole = read_file(sealed.file);
    const auto refused = [&](const std::string& bytes) {
        write_file(sealed.file, bytes);
        return refusal_of([&] { sealed.opened(sealed.key); });
    };
    constexpr std::size_t head = 125; // line, box, header
    for (const std::size_t size : {std::size_t{0}, std::size_t{20}, head - 1}) {
        EXPECT_THAT(refused(whole.substr(0, size)), HasSubstr("is no sealed log")) << size;
    }
    for (const std::size_t size :
         {head, head + 1, head + block + 17, whole.size() - 17, whole.size() - 1}) {
        EXPECT_THAT(refused(whole.substr(0, size)), HasSubstr("was changed or cut off")) << size;
    }
    EXPECT_THAT(refused(whole + "x"), HasSubstr("was changed or cut off"));
    for (const std::size_t at : {std::size_t{101}, head, head + block, whole.size() - 1}) {
        auto changed = whole;
        changed[at] = static_cast<char>(changed[at] ^ 1);
        EXPECT_THAT(refused(changed), HasSubstr("was changed or cut off")) << at;
    }
    auto other_box = whole;
    other_box[60] = static_cast<char>(other_box[60] ^ 1);
    EXPECT_THAT(refused(other_box), HasSubstr("or was changed"));
}

TEST(LogKeyFile, IsRefusedIfItHoldsNoKey) {
    const auto folder = test_folder();
    const auto key = LogKey::make();
    write_log_key(folder / "logs.key", key);
    EXPECT_EQ(read_log_key(folder / "logs.key").public_key(), key.public_key());
    EXPECT_EQ(fs::status(folder / "logs.key").permissions(),
              fs::perms::owner_read | fs::perms::owner_write);
    EXPECT_FALSE(refusal_of([&] { write_log_key(folder / "logs.key", key); }).empty());
    for (const auto* const text : {"", "#", "# Secret key of the logs \n12ab\n", "key\n"}) {
        write_file(folder / "no.key", text);
        EXPECT_THAT(refusal_of([&] { read_log_key(folder / "no.key"); }),
                    HasSubstr("no.key: is not a key of logs"));
    }
    EXPECT_THAT(refusal_of([&] { seal_log(folder / "no.key", folder / "b", "12"); }),
                HasSubstr("'12' is no public key of logs"));
}

} // namespace
} // namespace macadam::testing
