#include "estimator/smoother/filter/state_layout.hpp"

#include "estimator/smoother/corners.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

namespace macadam::testing {
namespace {

using ::testing::ElementsAre;

constexpr double cell_m = 0.25;
constexpr double step_s = 0.02;
constexpr auto nowhere = StateLayout::nowhere;

enum Felt : unsigned { vertical = 1, lateral = 2, roll = 4, pitch = 8 };
constexpr unsigned everything = vertical | lateral | roll | pitch;

/// Forty samples of what is asked for, at 12 to 18 m/s; both pulls known.
DriveRecord drive_of(const Vehicle& vehicle, unsigned felt) {
    DriveRecord drive;
    drive.cars = {car_steps(linear_car(vehicle), step_s)};
    double at_m = 5;
    for (int k = 0; k < 40; ++k) {
        drive.travel_m.push_back(at_m);
        at_m += step_s * (15 + 3 * std::sin(0.4 * k));
    }
    for (std::size_t channel = 0; channel < channel_count; ++channel) {
        if ((felt >> channel & 1U) != 0) {
            drive.felt[channel].resize(40);
        }
    }
    drive.pull[0].resize(40);
    drive.pull[1].resize(40);
    return drive;
}

StateLayout layout_of(const std::vector<DriveRecord>& drives) {
    return macadam::layout_of(drives, grid_under(drives, cell_m));
}

StateLayout layout_of(const Vehicle& vehicle, unsigned felt) {
    return layout_of({drive_of(vehicle, felt)});
}

Vehicle car_without_offset() {
    auto vehicle = lopsided_car();
    vehicle.imu.y_m = 0;
    return vehicle;
}

Vehicle one_axle_car() {
    auto vehicle = car_without_offset();
    vehicle.axles.reset();
    return vehicle;
}

/// Whether what is felt within a few steps tells anything of a state, by moving that state.
bool tells_of(const DriveRecord& drive, int state) {
    const CarSteps& steps = drive.cars.front();
    States x = States::Unit(state);
    for (int k = 0; k < 5; ++k) {
        for (std::size_t channel = 0; channel < channel_count; ++channel) {
            if (!drive.felt[channel].empty() &&
                std::abs((steps.car.felt[channel] * x).value()) > 1e-9) {
                return true;
            }
        }
        x = steps.phi * x;
    }
    return false;
}

/// Every number of the state that has a name.
std::vector<std::size_t> all_places(const StateLayout& layout) {
    std::vector<std::size_t> places;
    for (const auto& car : layout.cars) {
        for (std::size_t i = 0; i < car.states.size(); ++i) {
            places.push_back(car.first + i);
        }
        places.insert(places.end(), car.zero.begin(), car.zero.end());
        places.insert(places.end(), car.arm.begin(), car.arm.end());
    }
    for (std::size_t side = 0; side < 2; ++side) {
        for (std::size_t i = 0; i < layout.window && layout.side[side]; ++i) {
            places.push_back(layout.place(layout.first_cell + 17 + static_cast<std::ptrdiff_t>(i),
                                          side)); // wherever the window stands
        }
    }
    std::erase(places, nowhere);
    return places;
}

} // namespace

TEST(StateLayout, FollowsExactlyTheStatesOfWhichTheReadingsTell) {
    for (const auto& vehicle : {lopsided_car(), car_without_offset(), one_axle_car()}) {
        for (unsigned felt = 1; felt <= everything; ++felt) {
            const auto drive = drive_of(vehicle, felt);
            const auto layout = layout_of({drive});
            for (int state = 0; state < LinearCar::states; ++state) {
                const bool followed =
                    std::ranges::count(layout.cars[0].states, static_cast<std::size_t>(state)) == 1;
                EXPECT_EQ(followed, tells_of(drive, state)) << felt << " " << state;
            }
        }
    }
}

TEST(StateLayout, GivesEveryNumberAPlaceOfItsOwn) {
    for (const auto& vehicle : {lopsided_car(), car_without_offset(), one_axle_car()}) {
        for (unsigned felt = 1; felt <= everything; ++felt) {
            const auto layout =
                layout_of({drive_of(vehicle, felt), drive_of(lopsided_car(), vertical)});
            auto places = all_places(layout);
            std::ranges::sort(places);
            std::vector<std::size_t> all(layout.size);
            for (std::size_t i = 0; i < all.size(); ++i) {
                all[i] = i;
            }
            EXPECT_EQ(places, all) << felt;
        }
    }
}

TEST(StateLayout, OfEveryChannelIsTheWholeCar) {
    const auto layout = layout_of(lopsided_car(), everything);
    EXPECT_EQ(layout.cars[0].states.size(), 14);
    EXPECT_EQ(layout.cars[0].heaves, 8);
    EXPECT_EQ(layout.size, 14 + 4 + 2 + 2 * layout.window);
}

TEST(StateLayout, OfTheVerticalAloneLeavesRollAndTheDifferenceOfTheTracksOut) {
    const auto layout = layout_of(car_without_offset(), vertical);
    EXPECT_THAT(layout.cars[0].states, ElementsAre(0, 1, 2, 3, 4, 5, 6, 7));
    EXPECT_THAT(layout.side, ElementsAre(true, false));
    EXPECT_EQ(layout.cars[0].arm[1], nowhere) << "bends do not show";
    EXPECT_EQ(layout.size, 8 + 1 + 1 + layout.window);
}

TEST(StateLayout, OfASensorBesideTheMiddleKeepsThem) {
    auto vehicle = car_without_offset();
    vehicle.imu.y_m = 0.3;
    const auto layout = layout_of(vehicle, vertical);
    EXPECT_EQ(layout.cars[0].states.size(), 14);
    EXPECT_THAT(layout.side, ElementsAre(true, true));
}

TEST(StateLayout, OfRollAloneIsTheOtherSideOfTheRoad) {
    const auto layout = layout_of(lopsided_car(), roll);
    EXPECT_THAT(layout.cars[0].states, ElementsAre(8, 9, 10, 11, 12, 13));
    EXPECT_EQ(layout.cars[0].heaves, 0);
    EXPECT_THAT(layout.side, ElementsAre(false, true));
    EXPECT_EQ(layout.cars[0].arm[0], nowhere) << "braking does not show";
    EXPECT_NE(layout.cars[0].arm[1], nowhere);
}

TEST(StateLayout, OfPitchAloneKeepsHeaveWhichPressesTheWheels) {
    const auto layout = layout_of(car_without_offset(), pitch);
    EXPECT_EQ(layout.cars[0].states.size(), 8);
    EXPECT_THAT(layout.side, ElementsAre(true, false));
}

TEST(StateLayout, OfOneAxleHasNeitherPitchNorRearWheels) {
    const auto layout = layout_of(one_axle_car(), vertical | roll);
    EXPECT_THAT(layout.cars[0].states, ElementsAre(0, 1, 4, 5, 8, 9, 10, 11));
    EXPECT_FALSE(layout.cars[0].has_rear);
    EXPECT_EQ(layout.cars[0].arm[0], nowhere) << "it does not dip";
}

TEST(StateLayout, OfUnknownPullsHasNoArms) {
    auto drive = drive_of(lopsided_car(), everything);
    drive.pull = {};
    EXPECT_THAT(layout_of({drive}).cars[0].arm, ElementsAre(nowhere, nowhere));
}

TEST(StateLayout, HoldsEveryStationUnderTheCarThroughAStep) {
    const auto drive = drive_of(lopsided_car(), everything);
    const auto layout = layout_of({drive});
    const auto& car = drive.cars.front().car;
    ASSERT_GT(drive.travel_m.size(), 1U);
    for (std::size_t k = 1; k < drive.travel_m.size(); ++k) {
        const double last = std::floor((drive.travel_m[k] + car.front_m) / cell_m) + 1;
        const double first = std::floor((drive.travel_m[k - 1] + car.rear_m) / cell_m);
        EXPECT_LE(last - first + 1, static_cast<double>(layout.window));
    }
}

} // namespace macadam::testing
