#include "mapping/geometry/surroundings.hpp"

#include "estimator/common/error.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <string>

namespace macadam {
namespace {

/// The position so many metres east and north of another, roughly.
GeoPoint moved(const GeoPoint& from, double east_m, double north_m) {
    const double m_per_deg = distance_m(from, {from.lat_deg + 0.01, from.lon_deg}) / 0.01;
    const double m_per_lon_deg = distance_m(from, {from.lat_deg, from.lon_deg + 0.01}) / 0.01;
    return {from.lat_deg + north_m / m_per_deg, from.lon_deg + east_m / m_per_lon_deg};
}

TEST(Surroundings, HoldAllThatIsWithinReachAndNothingFarBeyondItAtAnyLatitude) {
    for (const double lat_deg : {-64.9, -0.001, 0.0, 33.0, 48.2, 70.3}) {
        for (const double lon_deg : {-122.4, 0.0, 16.37}) {
            const GeoPoint centre{lat_deg, lon_deg};
            Surroundings around{1000};
            around.add(centre);
            for (int east = -5; east <= 5; ++east) {
                for (int north = -5; north <= 5; ++north) {
                    const auto place = moved(centre, 1000.0 * east, 1000.0 * north);
                    const double off_m = distance_m(centre, place);
                    if (off_m <= 999) {
                        EXPECT_TRUE(around.contains(place))
                            << lat_deg << ' ' << east << ' ' << north;
                    }
                    if (off_m > 2500) {
                        EXPECT_FALSE(around.contains(place))
                            << lat_deg << ' ' << east << ' ' << north;
                    }
                }
            }
            for (const auto& [east_m, north_m] : {std::pair{700, 700}, {-995, 0}, {0, 995}}) {
                EXPECT_TRUE(around.contains(moved(centre, east_m, north_m))) << lat_deg;
            }
        }
    }
}

TEST(Surroundings, RefusePositionsThatAreScatteredOverTheGlobe) {
    Surroundings around{1000};
    std::string words;
    std::size_t count = 0;
    try {
        for (; count < 4 * Surroundings::max_cells; ++count) {
            around.add({static_cast<double>(count / 2000) * 0.01, // rows 1.1 km apart
                        static_cast<double>(count % 2000) * 0.02});
        }
    } catch (const InputError& error) {
        words = error.what();
    }
    EXPECT_EQ(count, Surroundings::max_cells);
    EXPECT_NE(words.find("more than 1000000 places 333 m apart"), std::string::npos) << words;
}

TEST(Surroundings, TakeNoPositionThatIsNotOnTheGlobe) {
    Surroundings around{1000};
    around.add({std::numeric_limits<double>::quiet_NaN(), 16});
    around.add({95, 16});
    around.add({48, 999});
    EXPECT_TRUE(around.empty());
    EXPECT_TRUE(is_empty(around.box()));
}

} // namespace
} // namespace macadam
