#include "mapping/analysis/road_section.hpp"

#include "mapping/analysis/homogeneous_sections.hpp"
#include "support/roads/road_art.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace macadam {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using testing::road_art;
using ::testing::SizeIs;

SegmentState state_of(const SegmentKey& key, int iri_um, int sd_um, int passes) {
    SegmentState state{};
    state.segment = key;
    state.iri_um = iri_um;
    state.sd_um = sd_um;
    state.passes = passes;
    state.vehicles = 2;
    return state;
}

// ------------------------------------------------------------------------------- measured roads

TEST(CorrelatedMean, HasTheVarianceOfAllPairs) {
    std::mt19937 random{7};
    std::vector<SegmentState> states(12);
    std::vector<MeasuredPiece> pieces;
    double at_m = 0;
    for (auto& state : states) {
        state = state_of({1, true, 0},
                         1000 + static_cast<int>(random() % 3000),
                         50 + static_cast<int>(random() % 300),
                         1);
        at_m += 5 + static_cast<double>(random() % 40);
        pieces.push_back({1 + static_cast<double>(random() % 20), at_m, &state});
    }
    for (const double share : {0.0, 0.5, 1.0}) {
        for (const double correlation_m : {0.0, 20.0, 1e9}) {
            double whole_m = 0, sum = 0, variance = 0;
            for (const auto& a : pieces) {
                whole_m += a.length_m;
                sum += a.length_m * a.state->iri_um / 1000;
                for (const auto& b : pieces) {
                    const double fade = &a == &b ? 1
                                        : correlation_m > 0
                                            ? std::exp(-std::abs(a.at_m - b.at_m) / correlation_m)
                                            : 0;
                    variance += a.length_m * a.state->sd_um / 1000.0 * b.length_m * b.state->sd_um /
                                1000.0 * (share + (1 - share) * fade);
                }
            }
            const auto road = measured_road(pieces, {share, correlation_m});
            const double sd = std::sqrt(variance) / whole_m;
            EXPECT_NEAR(road.mean.iri, sum / whole_m, 1e-12);
            EXPECT_NEAR(road.mean.sd, sd, 1e-9);
            EXPECT_NEAR(road.mean.high, road.mean.iri + 1.645 * sd, 1e-9);
        }
    }
}

TEST(CorrelatedMean, KeepsTheCommonErrorHoweverLongItIs) {
    const auto state = state_of({1, true, 0}, 2000, 200, 3);
    std::vector<MeasuredPiece> pieces;
    for (int i = 0; i < 1000; ++i) {
        pieces.push_back({20, 20.0 * i, &state});
    }
    const double sd = measured_road(pieces, {}).mean.sd;
    // Half of the variance is common; of 20 km the rest is a thousandth or a few.
    EXPECT_GT(sd, 0.2 * std::sqrt(0.5));
    EXPECT_LT(sd, 0.2 * std::sqrt(0.5 + 0.5 * 0.004));
    EXPECT_NEAR(measured_road(std::span{pieces}.first(1), {}).mean.sd, 0.2, 1e-12);
}

TEST(CorrelatedMean, OfNothingIsZero) {
    const auto road = measured_road({}, {});
    EXPECT_EQ(road.mean.length_m, 0);
    EXPECT_EQ(road.min_passes, 0);
    EXPECT_EQ(road.first_seen_ms, std::nullopt);
}

// ------------------------------------------------------------------------------------- sections

TEST(RoadSection, SectionsOfOneLengthLeaveTheRestAtTheEnd) {
    EXPECT_THAT(even_sections(250, 100),
                ElementsAre(RouteMeasureRange{0, 100},
                            RouteMeasureRange{100, 200},
                            RouteMeasureRange{200, 250}));
    EXPECT_THAT(even_sections(200.001, 100), SizeIs(2)); // no section of a millimetre
    EXPECT_THAT(even_sections(0, 100), IsEmpty());
}

/// Metre by metre along one way of 300 m: the slow road to the same numbers.
TEST(RoadSection, MeansAreThoseOfEveryDecimetre) {
    const auto art = road_art("A------------------------------B", 300.0 / 31, {"AB"});
    const auto edge = edge_between(art, 'A', 'B');
    std::mt19937 random{5};
    for (const bool forward : {true, false}) {
        const auto road = route_along_way(art.roads, 1, 13, 287, forward);
        SegmentStates states;
        for (const auto& segment : segments_of(art.roads, forward ? edge : reversed(edge))) {
            if (random() % 4 != 0) { // nobody drove every fourth
                states.emplace(segment.key,
                               state_of(segment.key,
                                        1000 + static_cast<int>(random() % 4000),
                                        100,
                                        1 + static_cast<int>(random() % 5)));
            }
        }
        const std::vector<RouteMeasureRange> excluded{{30, 41}, {90, 130}};
        const std::vector<RouteMeasureRange> ranges{{0, 70}, {70, 100}, {100, 274}};
        const auto sections = measured_sections(art.roads, road, states, ranges, excluded);
        ASSERT_THAT(sections, SizeIs(3));
        const auto link = link_at(art.roads, edge);
        const double segment_m = (link.to_m - link.from_m) / link.segments;
        for (const auto& section : sections) {
            double open_m = 0, measured_m = 0, sum = 0;
            int least = std::numeric_limits<int>::max();
            constexpr double step_m = 0.1;
            for (double x_m = section.from_m + step_m / 2; x_m < section.to_m; x_m += step_m) {
                if ((x_m > 30 && x_m < 41) || (x_m > 90 && x_m < 130)) {
                    continue;
                }
                const double station_m = forward ? 13 + x_m : 287 - x_m;
                const auto state =
                    states.find({1, forward, static_cast<std::uint32_t>(station_m / segment_m)});
                open_m += step_m;
                if (state != states.end()) {
                    measured_m += step_m;
                    sum += step_m * state->second.iri_um / 1000.0;
                    least = std::min(least, state->second.passes);
                }
            }
            EXPECT_NEAR(section.to_m - section.from_m - section.excluded_m, open_m, 0.2);
            EXPECT_NEAR(section.measured.mean.length_m, measured_m, 1);
            EXPECT_NEAR(section.open_share, measured_m / open_m, 0.01);
            if (measured_m > 0) {
                EXPECT_NEAR(section.measured.mean.iri, sum / measured_m, 0.05); // at the borders
                EXPECT_EQ(section.measured.min_passes, least);
            }
            ASSERT_THAT(section.parts, SizeIs(1));
            EXPECT_NEAR(
                section.parts[0].from_m, forward ? 13 + section.from_m : 287 - section.to_m, 1e-6);
        }
    }
}

// ---------------------------------------------------------------------------------- homogeneous

double cost_of(const std::vector<ProfilePiece>& profile,
               const std::vector<std::size_t>& beginnings,
               double price) {
    double cost = 0;
    for (std::size_t s = 0; s < beginnings.size(); ++s) {
        const auto last = s + 1 < beginnings.size() ? beginnings[s + 1] : profile.size();
        double whole_m = 0, sum = 0;
        for (auto i = beginnings[s]; i < last; ++i) {
            whole_m += profile[i].to_m - profile[i].from_m;
            sum += (profile[i].to_m - profile[i].from_m) * profile[i].iri;
        }
        for (auto i = beginnings[s]; i < last; ++i) {
            cost +=
                (profile[i].to_m - profile[i].from_m) * std::pow(profile[i].iri - sum / whole_m, 2);
        }
        cost += s > 0 ? price : 0;
    }
    return cost;
}

TEST(HomogeneousSections, AreTheCheapestOfAllCuts) {
    std::mt19937 random{11};
    std::normal_distribution<double> noise{0, 0.3};
    for (int round = 0; round < 20; ++round) {
        std::vector<ProfilePiece> profile;
        double at_m = 0;
        for (int i = 0; i < 12; ++i) {
            const double piece_m = 18 + static_cast<double>(random() % 5);
            const double level = i < static_cast<int>(random() % 12) ? 1.5 : 3;
            profile.push_back({at_m, at_m + piece_m, level + noise(random)});
            at_m += piece_m;
        }
        const HomogeneousConfig config{.min_length_m = 50};
        std::vector<double> steps;
        for (std::size_t i = 1; i < profile.size(); ++i) {
            steps.push_back(std::abs(profile[i].iri - profile[i - 1].iri));
        }
        std::ranges::sort(steps);
        const double sd = 1.4826 * steps[steps.size() / 2] / std::sqrt(2.0);
        const double price = config.penalty * sd * sd * at_m / 12 * std::log(12.0);

        double least = std::numeric_limits<double>::infinity();
        for (unsigned cuts = 0; cuts < 1U << 11; ++cuts) {
            std::vector<std::size_t> beginnings{0};
            for (std::size_t i = 1; i < 12; ++i) {
                if ((cuts >> (i - 1) & 1U) != 0) {
                    beginnings.push_back(i);
                }
            }
            bool long_enough = true;
            for (std::size_t s = 0; s < beginnings.size(); ++s) {
                const double end_m =
                    s + 1 < beginnings.size() ? profile[beginnings[s + 1]].from_m : at_m;
                long_enough = long_enough && end_m - profile[beginnings[s]].from_m >= 50;
            }
            if (long_enough) {
                least = std::min(least, cost_of(profile, beginnings, price));
            }
        }
        std::vector<std::size_t> found;
        for (const auto& section : homogeneous_sections(at_m, profile, config)) {
            found.push_back(static_cast<std::size_t>(
                std::ranges::find(profile, section.from_m, &ProfilePiece::from_m) -
                profile.begin()));
        }
        EXPECT_NEAR(cost_of(profile, found, price), least, 1e-6);
    }
}

TEST(HomogeneousSections, FindAChangeWhereItIsAndNoneWhereThereIsNone) {
    std::mt19937 random{2};
    std::normal_distribution<double> noise{0, 0.3};
    const auto profile_of = [&](double second) {
        std::vector<ProfilePiece> profile;
        for (int i = 0; i < 100; ++i) {
            profile.push_back({20.0 * i, 20.0 * (i + 1), (i < 60 ? 1.5 : second) + noise(random)});
        }
        return profile;
    };
    const auto changed = homogeneous_sections(2000, profile_of(3));
    ASSERT_THAT(changed, SizeIs(2));
    EXPECT_NEAR(changed[0].to_m, 1200, 20); // a piece
    EXPECT_THAT(homogeneous_sections(2000, profile_of(1.5)), SizeIs(1));
    const std::vector<ProfilePiece> even{{0, 20, 2}, {20, 40, 2}, {40, 60, 2}};
    EXPECT_THAT(homogeneous_sections(60, even, {.min_length_m = 10}),
                ElementsAre(RouteMeasureRange{0, 60}));
    EXPECT_THAT(homogeneous_sections(60, {}), ElementsAre(RouteMeasureRange{0, 60}));
}

} // namespace
} // namespace macadam
