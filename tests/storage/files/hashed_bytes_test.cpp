#include "storage/files/hashed_bytes.hpp"

#include "support/files/files.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

using namespace macadam;
using macadam::testing::refusal_of;

namespace {

/// A text in blocks of at most 5 bytes, which may end in an error.
class Blocks final : public ByteStream {
public:
    explicit Blocks(std::string text, std::string error = "")
        : text_{std::move(text)}, error_{std::move(error)} {}

    std::size_t read(std::span<char> into) override {
        const auto count = text_.copy(into.data(), std::min<std::size_t>(into.size(), 5), at_);
        if (count == 0 && !error_.empty()) {
            throw InputError{std::exchange(error_, "read again after its error")};
        }
        at_ += count;
        return count;
    }
    std::uint64_t consumed() const override { return at_; }

private:
    std::string text_;
    std::string error_;
    std::size_t at_ = 0;
};

HashedBytes hashed(std::string text, std::string error = "") {
    return HashedBytes{std::make_unique<Blocks>(std::move(text), std::move(error))};
}

std::string rest_of(ByteStream& stream) {
    std::string text;
    std::vector<char> block(7);
    while (const auto count = stream.read(block)) {
        text.append(block.data(), count);
    }
    return text;
}

// Of "abc": FIPS 180-2, appendix B.1; of the longer text: appendix B.2.
constexpr std::string_view sha256_of_abc =
    "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
constexpr auto longer = "abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq";
constexpr std::string_view sha256_of_longer =
    "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1";

TEST(HashedBytes, AreHashedAsTheyAreRead) {
    auto bytes = hashed(longer);
    EXPECT_EQ(rest_of(bytes), longer);
    EXPECT_EQ(bytes.sha256(), sha256_of_longer);
    EXPECT_EQ(bytes.sha256(), sha256_of_longer); // asked again
}

TEST(HashedBytes, ThatWereReadAheadComeAgainInTheirOrder) {
    auto all = hashed(longer);
    EXPECT_TRUE(all.read_ahead(1000));
    EXPECT_EQ(all.sha256(), sha256_of_longer);
    EXPECT_EQ(rest_of(all), longer);

    auto some = hashed(longer);
    EXPECT_FALSE(some.read_ahead(12));
    EXPECT_EQ(rest_of(some), longer);
    EXPECT_EQ(some.sha256(), sha256_of_longer);
}

TEST(HashedBytes, EndWhereTheyFirstEndedThoughTheFileGrows) {
    class Growing final : public ByteStream {
    public:
        std::size_t read(std::span<char> into) override {
            constexpr std::array<std::string_view, 3> reads{"abc", "", "d"};
            return next_ < reads.size() ? reads[next_++].copy(into.data(), into.size()) : 0;
        }
        std::uint64_t consumed() const override { return 0; }

    private:
        std::size_t next_ = 0;
    };
    HashedBytes bytes{std::make_unique<Growing>()};
    EXPECT_EQ(rest_of(bytes), "abc");
    EXPECT_EQ(bytes.sha256(), sha256_of_abc);
    EXPECT_EQ(rest_of(bytes), "");
}

TEST(HashedBytes, OfNothingHaveAHash) {
    auto none = hashed("");
    EXPECT_TRUE(none.read_ahead(1000));
    EXPECT_EQ(rest_of(none), "");
    EXPECT_EQ(none.sha256(), // FIPS 180-4, of the empty message
              "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
}

TEST(HashedBytes, ThatNobodyReadToTheEndAreHashedWhole) {
    auto bytes = hashed(longer);
    std::vector<char> block(3);
    ASSERT_EQ(bytes.read(block), 3U);
    EXPECT_EQ(bytes.sha256(), sha256_of_longer);
    EXPECT_EQ(hashed("abc").sha256(), sha256_of_abc);
}

TEST(HashedBytes, ThatCannotBeReadSaySoToEveryoneWhoAsks) {
    auto bytes = hashed("abc", "broken");
    EXPECT_EQ(refusal_of([&] { rest_of(bytes); }), "broken");
    EXPECT_EQ(refusal_of([&] { bytes.sha256(); }), "broken");

    auto ahead = hashed("abc", "broken");
    EXPECT_EQ(refusal_of([&] { ahead.read_ahead(1000); }), "broken");
    EXPECT_EQ(refusal_of([&] { ahead.sha256(); }), "broken");
}

} // namespace
