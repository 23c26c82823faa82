#include "app/pipeline/stated_car.hpp"

#include "estimator/common/error.hpp"
#include "estimator/vehicle/vehicle_prior.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <string>

namespace macadam {
namespace {

using ::testing::HasSubstr;

TripMeta
meta_with(const std::string& body, const std::string& mass_kg, const std::string& wheelbase_m) {
    TripMeta meta;
    meta.other = {{"car_body", body}, {"car_mass_kg", mass_kg}, {"car_wheelbase_m", wheelbase_m}};
    return meta;
}

std::string refusal_of(const TripMeta& meta) {
    try {
        static_cast<void>(stated_car(meta));
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

TEST(CarThatALogStates, IsTheOneOfItsPapers) {
    const auto car = stated_car(meta_with("compact", "1430", "2.62"));
    ASSERT_TRUE(car.has_value());
    const auto body = *std::ranges::find(body_types(), "compact", &BodyType::name);
    const auto papers = vehicle_of({.mass_kg = 1430, .wheelbase_m = 2.62, .body = body}, "compact");
    EXPECT_EQ(car->half_car.ms_kg, papers.half_car.ms_kg);
    EXPECT_EQ(car->axles.value().wheelbase_m, 2.62);
    EXPECT_EQ(car->uncertainty, papers.uncertainty);
}

TEST(CarThatALogStates, IsNoneIfOneOfThreeIsUnknown) {
    EXPECT_FALSE(stated_car(TripMeta{}));
    EXPECT_FALSE(stated_car(meta_with("compact", "1430", "unknown")));
    EXPECT_FALSE(stated_car(meta_with("compact", "", "2.62")));
}

TEST(CarThatALogStates, MustBeAPossibleOne) {
    EXPECT_THAT(refusal_of(meta_with("bus", "1430", "2.62")),
                HasSubstr("key 'car_body' is 'bus', expected one of small, compact"));
    EXPECT_THAT(
        refusal_of(meta_with("compact", "12000", "2.62")),
        HasSubstr("key 'car_mass_kg' is '12000', expected 800 to 2200 kg for car_body compact"));
    EXPECT_THAT(refusal_of(meta_with("compact", "1430", "long")),
                HasSubstr("key 'car_wheelbase_m' is 'long', expected 2.35 to 2.9 m"));
}

} // namespace
} // namespace macadam
