#include "mapping/surveys/survey_match.hpp"

#include "mapping/geometry/local_frame.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

namespace macadam::testing {
namespace {

using ::testing::Each;
using ::testing::Field;
using ::testing::IsEmpty;
using ::testing::SizeIs;

const LocalFrame frame{{48.0, 11.0}};

/// A road as a function of metres along it.
using Way = std::function<PointEn(double at_m)>;

Way straight(double north_m = 0, double turned_deg = 0) {
    const double turned = turned_deg * std::numbers::pi / 180;
    return [=](double at_m) {
        return PointEn{at_m * std::cos(turned), north_m + at_m * std::sin(turned)};
    };
}

/// A way driven the other way round, from `length_m`.
Way backward(const Way& way, double length_m) {
    return [=](double at_m) { return way(length_m - at_m); };
}

/// Rows every step_m, each in the middle of its piece.
std::vector<SurveyRow> survey_of(const Way& way, double from_m, double to_m, double step_m) {
    std::vector<SurveyRow> rows;
    for (double at_m = from_m + step_m / 2; at_m < to_m; at_m += step_m) {
        rows.push_back({.line = rows.size() + 2, .at = frame.to_geo(way(at_m))});
    }
    return rows;
}

/// A position every 20 m; travel is 0 at from_m.
std::vector<TravelPosition> trip_over(const Way& way, double from_m, double to_m) {
    std::vector<TravelPosition> trip;
    for (double at_m = from_m; at_m <= to_m; at_m += 20) {
        trip.push_back({frame.to_geo(way(at_m)), at_m - from_m});
    }
    return trip;
}

std::vector<SurveyPass> matched(const std::vector<SurveyRow>& survey,
                                const std::vector<TravelPosition>& trip) {
    return match_survey(survey, trip, {});
}

} // namespace

TEST(SurveyMatch, FindsEachPieceWhereTheTripDroveIt) {
    const auto passes =
        matched(survey_of(straight(), 0, 1000, 20), trip_over(straight(), -100, 1100));
    ASSERT_THAT(passes, SizeIs(50));
    for (std::size_t i = 0; i < 50; ++i) {
        EXPECT_EQ(passes[i].row, i);
        EXPECT_NEAR(passes[i].from_m, 100 + 20 * static_cast<double>(i), 0.01);
        EXPECT_NEAR(passes[i].to_m, 120 + 20 * static_cast<double>(i), 0.01);
        EXPECT_NEAR(passes[i].distance_m, 0, 0.01);
    }
}

TEST(SurveyMatch, ReachesToTheDistanceAndNoFarther) {
    const auto survey = survey_of(straight(), 0, 400, 20);
    const auto near = matched(survey, trip_over(straight(7), -100, 500));
    ASSERT_THAT(near, SizeIs(20));
    EXPECT_NEAR(near[5].distance_m, 7, 0.01);
    EXPECT_THAT(matched(survey, trip_over(straight(9), -100, 500)), IsEmpty());
}

TEST(SurveyMatch, LeavesTheOppositeDirectionAlone) {
    const auto trip = trip_over(backward(straight(3), 500), 0, 600);
    EXPECT_THAT(matched(survey_of(straight(), 0, 400, 20), trip), IsEmpty());
}

TEST(SurveyMatch, LeavesACrossingRoadAlone) {
    const Way northward = [](double at_m) { return PointEn{200, at_m - 300}; };
    EXPECT_THAT(matched(survey_of(straight(), 0, 400, 20), trip_over(northward, 0, 600)),
                IsEmpty());
}

TEST(SurveyMatch, HoldsTheWaysToTheAngle) {
    const auto survey = survey_of(straight(), -200, 200, 10);
    EXPECT_THAT(matched(survey, trip_over(straight(0, 25), -200, 200)), SizeIs(::testing::Ge(2)));
    EXPECT_THAT(matched(survey, trip_over(straight(0, 35), -200, 200)), IsEmpty());
}

TEST(SurveyMatch, CountsEachTimeThatThePieceWasDriven) {
    auto trip = trip_over(straight(), -100, 500);
    const double away_m = trip.back().travel_m + 900; // round by another road
    for (const auto& place : trip_over(straight(), -100, 500)) {
        trip.push_back({place.at, away_m + place.travel_m});
    }
    const auto passes = matched(survey_of(straight(), 0, 400, 20), trip);
    ASSERT_THAT(passes, SizeIs(40));
    for (std::size_t i = 0; i < 20; ++i) {
        EXPECT_EQ(passes[i].pass, 1U);
        EXPECT_EQ(passes[i + 20].pass, 2U);
        EXPECT_EQ(passes[i + 20].row, passes[i].row);
        EXPECT_NEAR(passes[i + 20].from_m - passes[i].from_m, away_m, 0.1);
    }
}

TEST(SurveyMatch, TakesTheLaneThatWasDriven) {
    auto survey = survey_of(straight(), 0, 400, 20);
    const auto second_lane = survey_of(straight(3.5), 0, 400, 20);
    survey.insert(survey.end(), second_lane.begin(), second_lane.end());
    const auto passes = matched(survey, trip_over(straight(3), -100, 500));
    EXPECT_THAT(passes, SizeIs(20));
    EXPECT_THAT(passes, Each(Field(&SurveyPass::row, ::testing::Ge(20))));
}

/// Pieces reach half-way to their neighbours. A chord of 50 m cuts 1.6 m off a bend of 200 m, and
/// 0.13 m of its length.
TEST(SurveyMatch, FollowsABendBetweenRowsThatAreFarApart) {
    const Way bend = [](double at_m) {
        return PointEn{200 * std::sin(at_m / 200), 200 - 200 * std::cos(at_m / 200)};
    };
    const auto passes = matched(survey_of(bend, 50, 550, 50), trip_over(bend, 0, 620));
    ASSERT_THAT(passes, SizeIs(10));
    for (std::size_t i = 0; i < 10; ++i) {
        EXPECT_NEAR(passes[i].from_m, 50 + 50 * static_cast<double>(i), 1);
        EXPECT_NEAR(passes[i].to_m, 100 + 50 * static_cast<double>(i), 1);
    }
}

TEST(SurveyMatch, TakesTheLengthThatARowStates) {
    auto survey = survey_of(straight(), 0, 1000, 100);
    for (auto& row : survey) {
        row.length_m = 40;
    }
    const auto passes = matched(survey, trip_over(straight(), -100, 1100));
    ASSERT_THAT(passes, SizeIs(10));
    EXPECT_NEAR(passes[3].from_m, 100 + 330, 0.01);
    EXPECT_NEAR(passes[3].to_m, 100 + 370, 0.01);
}

/// Rows of a metre, rounded to whole metres: their own direction is noise.
TEST(SurveyMatch, DoesNotTakeTheDirectionFromRowsThatStandClose) {
    const Way rounded = [](double at_m) {
        const auto exact = straight(0, 20)(at_m);
        return PointEn{std::round(exact.east_m), std::round(exact.north_m)};
    };
    const auto passes =
        matched(survey_of(rounded, 0, 300, 1), trip_over(straight(0, 20), -100, 400));
    EXPECT_GT(passes.size(), 250U);
}

TEST(SurveyMatch, LeavesOutWhatWasDrivenInPart) {
    const auto passes = matched(survey_of(straight(), 0, 400, 100), trip_over(straight(), 50, 350));
    ASSERT_THAT(passes, SizeIs(2));
    EXPECT_EQ(passes[0].row, 1U);
    EXPECT_EQ(passes[1].row, 2U);
}

/// Two metres for each position, independent of the next, are 0.9 m over the five of 100 m.
TEST(SurveyMatch, AveragesTheErrorsOfPositions) {
    std::mt19937 random{4};
    std::normal_distribution<double> error_m{0, 2};
    const Way wild = [&](double at_m) {
        const auto at = straight()(at_m);
        return PointEn{at.east_m + error_m(random), at.north_m + error_m(random)};
    };
    const auto passes = matched(survey_of(straight(), 0, 4000, 20), trip_over(wild, -200, 4200));
    ASSERT_GT(passes.size(), 190U);
    double squares = 0;
    for (const auto& pass : passes) {
        const double off_m = pass.from_m - 200 - 20 * static_cast<double>(pass.row);
        squares += off_m * off_m;
    }
    EXPECT_LT(std::sqrt(squares / static_cast<double>(passes.size())), 1.2);
}

TEST(SurveyMatch, DrawsNoLineAcrossAHoleOfTheSurvey) {
    auto survey = survey_of(straight(), 0, 200, 20);
    const auto later = survey_of(straight(), 1000, 1200, 20);
    survey.insert(survey.end(), later.begin(), later.end());
    const auto passes = matched(survey, trip_over(straight(), -100, 1300));
    ASSERT_THAT(passes, SizeIs(20));
    EXPECT_NEAR(passes[9].to_m, 300, 0.01);
    EXPECT_NEAR(passes[10].from_m, 1100, 0.01);
}

TEST(SurveyMatch, SaysNothingOfAHoleOfTheTrip) {
    auto trip = trip_over(straight(), -100, 500);
    trip.erase(trip.begin() + 10, trip.begin() + 20); // from 80 to 300 m of the road
    const auto passes = matched(survey_of(straight(), 0, 400, 20), trip);
    ASSERT_THAT(passes, SizeIs(9));
    EXPECT_EQ(passes[3].row, 3U);
    EXPECT_EQ(passes[4].row, 15U);
}

TEST(SurveyMatch, OfOneRowOrOnePositionIsNothing) {
    const auto survey = survey_of(straight(), 0, 400, 20);
    const auto trip = trip_over(straight(), -100, 500);
    EXPECT_THAT(matched({survey[3]}, trip), IsEmpty());
    EXPECT_THAT(matched(survey, {trip[6]}), IsEmpty());
    EXPECT_THAT(matched({}, trip), IsEmpty());
    EXPECT_THAT(matched({survey[3], survey[3]}, trip), IsEmpty());
}

} // namespace macadam::testing
