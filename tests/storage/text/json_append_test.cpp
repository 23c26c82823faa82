#include "storage/text/json_append.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <bit>
#include <limits>
#include <random>

namespace macadam {
namespace {

std::string fixed(double value, int decimals) {
    std::string text;
    append_fixed(text, value, decimals);
    return text;
}

TEST(AppendFixed, WritesWhatPrintfWrites) {
    std::mt19937_64 random{17};
    std::uniform_real_distribution<double> degrees{-180, 180};
    for (int i = 0; i < 2'000; ++i) {
        const auto any = std::bit_cast<double>(random()); // of every size, NaN and infinity too
        const double halfway = static_cast<double>(i) / 2000;
        for (const double value : {degrees(random), any, halfway, -halfway}) {
            for (const int decimals : {0, 2, 3, 7, 9}) {
                ASSERT_EQ(fixed(value, decimals), fmt::format("{:.{}f}", value, decimals));
            }
        }
    }
}

TEST(AppendFixed, LeavesTiesToExactArithmetic) {
    EXPECT_EQ(fixed(0.125, 2), "0.12"); // a tie: to even
    EXPECT_EQ(fixed(0.375, 2), "0.38");
    EXPECT_EQ(fixed(2.345, 2), "2.35"); // its double lies above
    EXPECT_EQ(fixed(1.005, 2), "1.00"); // and this one's below
    EXPECT_EQ(fixed(-0.0, 3), "-0.000");
}

TEST(AppendJson, WritesWhatAnObjectHolds) {
    const auto infinity = std::numeric_limits<double>::infinity();
    for (const auto& type : {as::iri(3), as::shortest, as::integer, as::text, as::raw, as::truth}) {
        for (const Cell& cell : {Cell{},
                                 Cell{-0.0001},
                                 Cell{2.0625},
                                 Cell{infinity},
                                 Cell{-7},
                                 Cell{true},
                                 Cell{"a \"b\" \xc3\xa9 \xff"}}) {
            std::string text{"{\"x\":"};
            append_json(text, type, cell);
            JsonObject object;
            object.add("x", json_value(type, cell));
            EXPECT_EQ(text + "}", object.text());
        }
    }
}

} // namespace
} // namespace macadam
