#include "mapping/network/build_network.hpp"
#include "mapping/network/image/network_check.hpp"

#include "estimator/common/error.hpp"
#include "support/files/sealed_image.hpp"

#include <gmock/gmock.h>

#include <cstring>
#include <random>

namespace macadam {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

const std::string source(64, 'a');

std::vector<std::byte> town_image() {
    return testing::bytes_of(image_of(testing::named_town(), source));
}

std::string refusal_of(std::vector<std::byte> image) {
    testing::seal(image);
    try {
        testing::opened(std::move(image));
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

/// Arrays by their numbers in the file.
enum Array : std::size_t {
    ways,
    points,
    node_ids,
    along_mm,
    links,
    node_point,
    first_out,
    out_edges,
    turn_restrictions,
    turns,
    boxes,
    numbers,
    first_letter,
    letters
};

/// The refusal of the town's image with one value of an array changed.
template <typename Value>
std::string refusal_with(
    Array array, std::size_t record_bytes, std::size_t record, std::size_t offset, Value value) {
    auto image = town_image();
    const auto section = testing::section_of(image, array);
    EXPECT_LT(record, section.count);
    std::memcpy(
        image.data() + section.offset + record * record_bytes + offset, &value, sizeof value);
    return refusal_of(std::move(image));
}

constexpr std::uint32_t huge = 0xfffffff0U;

TEST(NetworkCheck, HoldsForWhatIsBuiltHere) {
    expect_sound(testing::named_town());
    expect_sound(build_network({}));
    EXPECT_EQ(refusal_of(town_image()), "");
    testing::use(testing::opened(town_image()));
}

TEST(NetworkCheck, RefusesEachRecordThatPointsBeyondAnArray) {
    const auto refused = StartsWith("is not a valid network: ");
    for (const std::size_t field : {8U, 12U, 16U, 20U, 24U}) { // points, links, turns, name, class
        EXPECT_THAT(refusal_with(ways, sizeof(PackedWay), 1, field, huge), refused) << field;
    }
    for (std::size_t field = 0; field < 24; field += 4) {
        EXPECT_THAT(refusal_with(links, sizeof(PackedLink), 3, field, huge), refused) << field;
    }
    for (const auto array : {node_point, first_out, out_edges, numbers, first_letter, along_mm}) {
        EXPECT_THAT(refusal_with(array, 4, 2, 0, huge), refused) << array;
    }
    for (const std::size_t field : {0U, 4U}) {
        EXPECT_THAT(refusal_with(turn_restrictions, 8, 0, field, huge), refused) << field;
        EXPECT_THAT(refusal_with(points, 8, 4, field, 2'000'000'000), refused) << field;
    }
    for (std::size_t field = 0; field < 16; field += 4) {
        EXPECT_THAT(refusal_with(boxes, 16, 1, field, 2'000'000'000), refused) << field;
    }
}

TEST(NetworkCheck, RefusesValuesThatStandForNothing) {
    EXPECT_THAT(refusal_with(ways, sizeof(PackedWay), 0, 30, std::uint8_t{3}),
                HasSubstr("way '1' is invalid")); // oneway
    EXPECT_THAT(refusal_with(links, sizeof(PackedLink), 0, 24, std::uint16_t{0}),
                HasSubstr("link 0 is invalid")); // its speed limit
    EXPECT_THAT(refusal_with(links, sizeof(PackedLink), 0, 26, std::uint16_t{64}),
                HasSubstr("link 0 is invalid")); // its flags
    EXPECT_THAT(refusal_with(turns, sizeof(TurnRule), 0, 16, std::int64_t{2}),
                HasSubstr("a turn restriction is invalid"));
    EXPECT_THAT(refusal_with(boxes, 16, 0, 0, -1'000'000'000), HasSubstr("an invalid box"));
}

TEST(NetworkCheck, RefusesWhatIsOutOfOrder) {
    EXPECT_THAT(refusal_with(ways, sizeof(PackedWay), 1, 0, std::int64_t{0}),
                HasSubstr("its ways are not in order"));
    EXPECT_THAT(refusal_with(along_mm, 4, 1, 0, std::uint32_t{4'000'000'000}),
                HasSubstr("the lengths along way '1' decrease"));
    EXPECT_THAT(refusal_with(node_point, 4, 1, 0, std::uint32_t{0}),
                HasSubstr("its nodes are not in order"));
}

TEST(NetworkCheck, RefusesASegmentLengthThatIsNone) {
    for (const double length_m : {0.0, -20.0, std::nan(""), HUGE_VAL}) {
        auto image = town_image();
        std::memcpy(image.data() + 24, &length_m, sizeof length_m);
        EXPECT_THAT(refusal_of(std::move(image)), HasSubstr("segment length")) << length_m;
    }
    auto image = town_image(); // every link would have millions of segments
    const double length_m = 1e-6;
    std::memcpy(image.data() + 24, &length_m, sizeof length_m);
    EXPECT_THAT(refusal_of(std::move(image)), StartsWith("is not a valid network: "));
}

/// 12 million random bytes would meet the same few checks: so values change as an attacker changes
/// them, to what is near a bound, is another's or is huge.
TEST(NetworkCheck, LeavesOnlyImagesThatCanBeUsedOfThousandsWithTrueSums) {
    const auto whole = town_image();
    std::mt19937 random{20261122};
    int used = 0;
    for (int i = 0; i < 6000; ++i) {
        auto image = whole;
        const int changes = 1 + static_cast<int>(random() % 3);
        for (int k = 0; k < changes; ++k) {
            const bool in_head = random() % 8 == 0;
            const auto at = in_head ? random() % 320 : 384 + random() % (image.size() - 384);
            const std::size_t word = at / 4 * 4;
            std::uint32_t value = 0;
            std::memcpy(&value, image.data() + word, 4);
            switch (random() % 6) {
            case 0:
                image[at] ^= std::byte{static_cast<unsigned char>(1U << random() % 8)};
                continue;
            case 1:
                value += 1;
                break;
            case 2:
                value -= 1;
                break;
            case 3:
                value = static_cast<std::uint32_t>(random());
                break;
            case 4:
                value = static_cast<std::uint32_t>(random() % 200);
                break;
            default:
                value = i % 2 == 0 ? 0U : 0x7fffffffU + static_cast<std::uint32_t>(random() % 2);
                break;
            }
            std::memcpy(image.data() + word, &value, 4);
        }
        testing::seal(image);
        try {
            testing::use(testing::opened(std::move(image)));
            ++used;
        } catch (const InputError& refusal) {
            EXPECT_STRNE(refusal.what(), "");
        }
    }
    EXPECT_GT(used, 100); // names, ids, limits and places may well be others
    EXPECT_LT(used, 5000);
}

} // namespace
} // namespace macadam
