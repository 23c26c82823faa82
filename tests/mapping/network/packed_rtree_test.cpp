#include "mapping/network/packed_rtree.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <numeric>
#include <random>

namespace macadam {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

GridBox random_box(std::mt19937_64& random, std::int32_t largest_e7) {
    std::uniform_int_distribution<std::int32_t> lat{-900'000'000, 900'000'000 - largest_e7};
    std::uniform_int_distribution<std::int32_t> lon{-1'800'000'000, 1'800'000'000 - largest_e7};
    std::uniform_int_distribution<std::int32_t> size{0, largest_e7};
    const auto south = lat(random);
    const auto west = lon(random);
    return {south, west, south + size(random), west + size(random)};
}

bool meet(const GridBox& a, const GridBox& b) {
    return std::max(a.south_e7, b.south_e7) <= std::min(a.north_e7, b.north_e7) &&
           std::max(a.west_e7, b.west_e7) <= std::min(a.east_e7, b.east_e7);
}

class BoxTreeOfSize : public ::testing::TestWithParam<std::size_t> {};

TEST_P(BoxTreeOfSize, FindsWhatGoingThroughAllFinds) {
    std::mt19937_64 random{3};
    std::vector<GridBox> boxes(GetParam());
    std::ranges::generate(boxes, [&] { return random_box(random, 50'000'000); });
    std::vector<std::uint32_t> numbers(boxes.size());
    std::iota(numbers.begin(), numbers.end(), 0U);
    const auto tree = build_box_tree(boxes, numbers);
    EXPECT_EQ(tree.boxes.size(), box_tree_size(boxes.size()));
    for (int i = 0; i < 300; ++i) {
        const auto asked = random_box(random, 400'000'000);
        std::vector<std::uint32_t> expected;
        std::ranges::copy_if(numbers, std::back_inserter(expected), [&](std::uint32_t number) {
            return meet(boxes[number], asked);
        });
        EXPECT_EQ(numbers_meeting({tree.boxes, tree.numbers}, asked), expected);
    }
}

// Around the fan-out of 16, where a level begins.
INSTANTIATE_TEST_SUITE_P(, BoxTreeOfSize, ::testing::Values(0, 1, 2, 15, 16, 17, 256, 257, 5000));

TEST(PackedRtree, GivesANumberOfSeveralBoxesOnce) {
    const auto tree = build_box_tree({{0, 0, 1, 1}, {1, 1, 2, 2}, {5, 5, 6, 6}}, {7, 7, 3});
    EXPECT_THAT(numbers_meeting({tree.boxes, tree.numbers}, {0, 0, 9, 9}), ElementsAre(3U, 7U));
    EXPECT_THAT(numbers_meeting({tree.boxes, tree.numbers}, {3, 3, 4, 4}), IsEmpty());
}

TEST(PackedRtree, HasAsItsRootTheBoxAroundAll) {
    std::mt19937_64 random{4};
    std::vector<GridBox> boxes(1000);
    std::ranges::generate(boxes, [&] { return random_box(random, 1000); });
    const auto tree = build_box_tree(boxes, std::vector<std::uint32_t>(boxes.size()));
    const auto lowest = [&](auto side) { return side(*std::ranges::min_element(boxes, {}, side)); };
    const auto highest = [&](auto side) {
        return side(*std::ranges::max_element(boxes, {}, side));
    };
    EXPECT_EQ(tree.boxes.back(),
              (GridBox{lowest([](const GridBox& box) { return box.south_e7; }),
                       lowest([](const GridBox& box) { return box.west_e7; }),
                       highest([](const GridBox& box) { return box.north_e7; }),
                       highest([](const GridBox& box) { return box.east_e7; })}));
}

TEST(PackedRtree, AsksForNoLessThanTheBoxInDegrees) {
    EXPECT_EQ(on_grid({10.00000001, 49.99999999, 10.00000011, 50.00000001}),
              (GridBox{499999999, 100000000, 500000001, 100000002}));
    EXPECT_EQ(on_grid({-200, -100, 200, 100}),
              (GridBox{-900'000'000, -1'800'000'000, 900'000'000, 1'800'000'000}));
}

} // namespace
} // namespace macadam
