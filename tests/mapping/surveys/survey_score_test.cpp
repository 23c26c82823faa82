#include "mapping/surveys/survey_score.hpp"

#include <gmock/gmock.h>

#include <cmath>

namespace macadam::testing {
namespace {

using ::testing::IsEmpty;
using ::testing::SizeIs;

// Errors of +1, 0 and -1 mm/m.
const std::vector<SurveyPair> three{{1, 2, 1.5, 2.5}, {3, 3, 2, 4}, {5, 4, 3.5, 5.5}};

} // namespace

TEST(SurveyScore, IsWhatTheFormulasSay) {
    const auto score = score_of(three);
    EXPECT_EQ(score.pieces, 3U);
    EXPECT_DOUBLE_EQ(score.mean_survey, 3);
    EXPECT_DOUBLE_EQ(score.mean_trip, 3);
    EXPECT_DOUBLE_EQ(score.bias, 0);
    EXPECT_DOUBLE_EQ(score.sd, 1);
    EXPECT_DOUBLE_EQ(score.rmse, std::sqrt(2.0 / 3));
    EXPECT_DOUBLE_EQ(score.correlation, 1);
    EXPECT_DOUBLE_EQ(score.coverage, 2.0 / 3);
}

TEST(SurveyScore, OfOnePieceHasNoSpread) {
    const auto score = score_of({three.data(), 1});
    EXPECT_DOUBLE_EQ(score.bias, 1);
    EXPECT_DOUBLE_EQ(score.rmse, 1);
    EXPECT_TRUE(std::isnan(score.sd));
    EXPECT_TRUE(std::isnan(score.correlation));
}

TEST(SurveyScore, OfNothingIsNotKnown) {
    const auto score = score_of({});
    EXPECT_EQ(score.pieces, 0U);
    EXPECT_TRUE(std::isnan(score.rmse));
    EXPECT_TRUE(std::isnan(score.coverage));
    EXPECT_THAT(scores_by_band({}), IsEmpty());
}

/// A survey's 2 is of the band 2 to 4.
TEST(SurveyScore, PartsTheBandsOfThePaperByTheSurvey) {
    const std::vector<SurveyPair> pairs{
        {1.9, 5, 0, 9}, {2, 1, 0, 9}, {3.9, 1, 0, 9}, {11, 1, 0, 9}, {12, 1, 0, 9}};
    const auto bands = scores_by_band(pairs);
    ASSERT_THAT(bands, SizeIs(4));
    EXPECT_EQ(bands[0].pieces, 1U);
    EXPECT_DOUBLE_EQ(bands[1].from_mm_per_m, 2);
    EXPECT_DOUBLE_EQ(bands[1].to_mm_per_m, 4);
    EXPECT_EQ(bands[1].pieces, 2U);
    EXPECT_DOUBLE_EQ(bands[2].from_mm_per_m, 6);
    EXPECT_TRUE(std::isinf(bands[3].to_mm_per_m));
}

} // namespace macadam::testing
