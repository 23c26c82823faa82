#include "app/import/import_outcome.hpp"

#include <gmock/gmock.h>

#include <vector>

namespace macadam {
namespace {

using ::testing::HasSubstr;

const GeoBox krems{15.55, 48.38, 15.70, 48.45};

TEST(OutsideText, NamesThePlaceOfTheTripsAndTheMap) {
    const std::vector<GeoPoint> trips(6, {47.6934, 17.6751});
    EXPECT_EQ(outside_text(trips, 6, krems, PrivacyProfile::own),
              "none of 6 trips touches this map: trips near 47.69, 17.68; map covers 15.55,48.38 "
              "to 15.70,48.45 (W,S to E,N)");
}

TEST(OutsideText, CountsTripsIfOthersAreInside) {
    const std::vector<GeoPoint> trips{{47.69, 17.67}, {47.69, 17.67}};
    EXPECT_THAT(outside_text(trips, 6, krems, PrivacyProfile::own),
                HasSubstr("2 of 6 trips are outside this map: trips near 47.69, 17.67;"));
    EXPECT_THAT(outside_text({trips.data(), 1}, 6, krems, PrivacyProfile::own),
                HasSubstr("1 of 6 trips is outside this map: trip near 47.69, 17.67;"));
}

TEST(OutsideText, NamesAtMostThreePlaces) {
    const std::vector<GeoPoint> trips{{1, 1}, {2, 2}, {3, 3}, {4, 4}, {1, 1}};
    EXPECT_THAT(outside_text({trips.data(), 2}, 5, krems, PrivacyProfile::own),
                HasSubstr("near 1.00, 1.00 and 2.00, 2.00;"));
    EXPECT_THAT(outside_text(trips, 5, krems, PrivacyProfile::own),
                HasSubstr("near 1.00, 1.00 and 3 other places;"));
}

TEST(OutsideText, HardlyTellsWherePeopleOfACrowdDrive) {
    const std::vector<GeoPoint> trips{{47.6934, 17.6751}, {47.7412, 17.6501}};
    EXPECT_THAT(outside_text(trips, 2, krems, PrivacyProfile::crowd),
                HasSubstr("near 47.7, 17.7; map covers 15.55,48.38"));
}

TEST(OutsideText, RecognisesExchangedCoordinates) {
    const std::vector<GeoPoint> exchanged{{15.6, 48.4}};
    EXPECT_THAT(outside_text(exchanged, 1, krems, PrivacyProfile::own),
                HasSubstr("latitude and longitude are probably exchanged"));
    const std::vector<GeoPoint> far{{47.69, 17.67}};
    EXPECT_THAT(outside_text(far, 1, krems, PrivacyProfile::own),
                ::testing::Not(HasSubstr("exchanged")));
}

} // namespace
} // namespace macadam
