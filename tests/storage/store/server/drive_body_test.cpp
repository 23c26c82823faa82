#include "storage/store/server/drive_body.hpp"

#include "support/files/files.hpp"

#include <gmock/gmock.h>

#include <limits>
#include <random>

namespace macadam {
namespace {

using testing::refusal_of;

constexpr std::uint32_t segments = 25;

DrivePass drive_pass(std::uint32_t offset, IriUm left, IriUm right) {
    return {offset,
            {.segment = {},
             .occurrence = 0,
             .iri_left_um = left,
             .iri_right_um = right,
             .iri_centre_um = {},
             .iri_um = (left + right + 1) / 2,
             .sd_um = 150,
             .centre_only = false,
             .validity = 0,
             .speed_mmps = 13'000,
             .covered_mm = 20'000,
             .confidence_ppm = 990'000,
             .t_ms = 1'500 * std::int64_t{offset}}};
}

void expect_equal(const DrivePass& a, const DrivePass& b) {
    EXPECT_EQ(a.offset, b.offset);
    EXPECT_EQ(a.pass.occurrence, b.pass.occurrence);
    EXPECT_EQ(a.pass.iri_left_um, b.pass.iri_left_um);
    EXPECT_EQ(a.pass.iri_right_um, b.pass.iri_right_um);
    EXPECT_EQ(a.pass.iri_centre_um, b.pass.iri_centre_um);
    EXPECT_EQ(a.pass.iri_um, b.pass.iri_um);
    EXPECT_EQ(a.pass.sd_um, b.pass.sd_um);
    EXPECT_EQ(a.pass.centre_only, b.pass.centre_only);
    EXPECT_EQ(a.pass.validity, b.pass.validity);
    EXPECT_EQ(a.pass.speed_mmps, b.pass.speed_mmps);
    EXPECT_EQ(a.pass.covered_mm, b.pass.covered_mm);
    EXPECT_EQ(a.pass.confidence_ppm, b.pass.confidence_ppm);
    EXPECT_EQ(a.pass.t_ms, b.pass.t_ms);
}

TEST(DriveBody, GivesBackEveryPassOfADrive) {
    std::mt19937 random{47};
    std::uniform_int_distribution<IriUm> any{std::numeric_limits<IriUm>::min(),
                                             std::numeric_limits<IriUm>::max()};
    std::vector<DrivePass> passes;
    for (std::uint32_t offset = 0; offset < segments; ++offset) {
        auto pass = drive_pass(offset, any(random), any(random));
        pass.pass.iri_um = any(random);
        pass.pass.iri_left_um = offset % 3 == 0 ? std::nullopt : pass.pass.iri_left_um;
        pass.pass.iri_centre_um = offset % 2 == 0 ? std::optional{any(random)} : std::nullopt;
        pass.pass.centre_only = offset % 2 == 0;
        pass.pass.validity = static_cast<std::uint8_t>(any(random));
        pass.pass.t_ms = offset % 2 == 0 ? std::numeric_limits<std::int64_t>::min()
                                         : std::numeric_limits<std::int64_t>::max();
        passes.push_back(pass);
    }
    const auto found = passes_in_body(body_of({passes.rbegin(), passes.rend()}), segments);
    ASSERT_EQ(found.size(), passes.size());
    for (std::size_t i = 0; i < passes.size(); ++i) {
        expect_equal(found[i], passes[i]);
    }
}

TEST(DriveBody, TakesAtMost25BytesAPass) {
    std::mt19937 random{47};
    std::uniform_int_distribution<IriUm> rough{500, 9'000};
    std::vector<DrivePass> passes;
    for (std::uint32_t offset = 0; offset < segments; ++offset) {
        passes.push_back(drive_pass(offset, rough(random), rough(random)));
    }
    EXPECT_LE(body_of(passes).size(), 25 * segments);
}

TEST(DriveBody, IsRefusedWhereverItIsCutOrDamaged) {
    const auto body = body_of({drive_pass(0, 1'000, 2'000), drive_pass(24, 3'000, 900)});
    const auto one = body_of({drive_pass(0, 1'000, 2'000)}).size();
    for (std::size_t size = 0; size < body.size(); ++size) {
        const auto refusal = refusal_of([&] { passes_in_body({body.data(), size}, segments); });
        EXPECT_EQ(refusal.empty(), size == 1 || size == one) << size;
    }
    EXPECT_NE(refusal_of([&] { passes_in_body(body, 24); }), "");
    std::mt19937 random{47};
    for (int i = 0; i < 10'000; ++i) { // ends, with a refusal or with other passes
        auto damaged = body;
        damaged[random() % damaged.size()] = static_cast<char>(random());
        refusal_of([&] {
            for (const auto& pass : passes_in_body(damaged, segments)) {
                EXPECT_LT(pass.offset, segments);
            }
        });
    }
}

} // namespace
} // namespace macadam
