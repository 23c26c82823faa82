#include "mapping/network/build_network.hpp"
#include "mapping/network/image/network_image.hpp"

#include "estimator/common/error.hpp"
#include "support/files/sealed_image.hpp"
#include "support/roads/town.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <random>

namespace macadam {
namespace {

using testing::bytes_of;
using ::testing::HasSubstr;

const std::string source(64, 'a');

ImageContent content_of(std::vector<std::byte> bytes) {
    const auto kept = std::make_shared<const std::vector<std::byte>>(std::move(bytes));
    return network_in(*kept, kept);
}

std::string refusal_of(std::vector<std::byte> bytes) {
    try {
        content_of(std::move(bytes));
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

TEST(NetworkImage, IsReadBackToTheLastByte) {
    const auto bytes = bytes_of(image_of(testing::made_up_town(12), source));
    const auto content = content_of(bytes);
    EXPECT_EQ(content.source, source);
    EXPECT_EQ(bytes_of(image_of(content.roads, source)), bytes);
}

TEST(NetworkImage, GivesTheWaysBackAndTheSameNetworkOfThem) {
    const auto roads = testing::made_up_town(12);
    const auto content = content_of(bytes_of(image_of(roads, source)));
    const auto again = build_network(copies_of_ways(content.roads), content.roads.segment_length_m);
    EXPECT_EQ(bytes_of(image_of(again, source)), bytes_of(image_of(roads, source)));
}

TEST(NetworkImage, IsTheSameWhateverTheOrderOfTheWays) {
    auto ways = copies_of_ways(testing::made_up_town(12));
    const auto expected = bytes_of(image_of(build_network(ways), source));
    std::shuffle(ways.begin(), ways.end(), std::mt19937_64{1});
    EXPECT_EQ(bytes_of(image_of(build_network(ways), source)), expected);
}

TEST(NetworkImage, OutlivesTheNetworkThatItWasOpenedAs) {
    auto content = content_of(bytes_of(image_of(testing::made_up_town(3), source)));
    const RoadNetwork copy = content.roads;
    content = {};
    EXPECT_GT(length_m(copy, EdgeId{0}), 0);
}

TEST(NetworkImage, OfNoRoadsIsANetworkOfNoRoads) {
    const auto content = content_of(bytes_of(image_of(build_network({}), source)));
    EXPECT_EQ(link_count(content.roads), 0U);
    EXPECT_EQ(node_count(content.roads), 0U);
    EXPECT_TRUE(is_empty(extent_of(content.roads)));
}

TEST(NetworkImage, OfSomethingElseIsRefused) {
    const std::vector<std::byte> zeros(5000);
    EXPECT_EQ(refusal_of(zeros), "is not a Macadam network file");
    EXPECT_EQ(refusal_of({}), "is not a Macadam network file");
}

TEST(NetworkImage, CutAnywhereIsRefused) {
    const auto whole = bytes_of(image_of(testing::made_up_town(3), source));
    for (std::size_t size = 0; size < whole.size(); size += 64) {
        EXPECT_NE(refusal_of({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)}),
                  "");
    }
    EXPECT_THAT(refusal_of({whole.begin(), whole.end() - 64}), HasSubstr(": it is truncated"));
    EXPECT_THAT(refusal_of({whole.begin(), whole.begin() + 100}), HasSubstr("has 100 bytes"));
}

TEST(NetworkImage, WithAnyByteChangedIsRefused) {
    const auto whole = bytes_of(image_of(testing::made_up_town(2), source));
    for (std::size_t i = 0; i < whole.size(); i += 7) { // in steps that meet every place of a word
        auto changed = whole;
        changed[i] ^= std::byte{1};
        EXPECT_NE(refusal_of(changed), "") << "byte " << i;
    }
    auto changed = whole;
    changed.back() ^= std::byte{1};
    EXPECT_EQ(refusal_of(changed), "is damaged: its checksum differs");
}

TEST(NetworkImage, OfAnotherVersionOrMachineSaysSo) {
    const auto whole = bytes_of(image_of(testing::made_up_town(2), source));
    constexpr std::size_t byte_order_at = 8;
    constexpr std::size_t version_at = 12;
    auto changed = whole;
    changed[version_at] = std::byte{77};
    EXPECT_EQ(refusal_of(changed), "is a network file of version '77', expected version 1");
    changed = whole;
    std::reverse(changed.begin() + byte_order_at, changed.begin() + version_at);
    EXPECT_EQ(refusal_of(changed), "was written on a machine with another byte order");
}

} // namespace
} // namespace macadam
