#pragma once

#include "survey.hpp"

#include <array>

namespace macadam::field_test {

struct MethodRow {
    const char* name;
    Method method;
    Channels channels;
    SensorSet sensors; ///< of the smoother
    bool fitted;       ///< one factor, from a tenth of the drive with the reference known
};

inline constexpr std::array methods{
    MethodRow{"kf, vertical", Method::kf, Channels::vertical, {}, true},
    MethodRow{"kf, lateral", Method::kf, Channels::lateral, {}, true},
    MethodRow{
        "smoother, vertical", Method::smoother, Channels::automatic, {.vertical = true}, false},
    MethodRow{"smoother, vertical + pitch rate (maps)",
              Method::smoother,
              Channels::automatic,
              {.vertical = true, .pitch = true},
              false},
    MethodRow{"smoother, vertical + lateral",
              Method::smoother,
              Channels::automatic,
              {.vertical = true, .lateral = true, .yaw = true},
              false},
    MethodRow{"smoother, vertical + lateral + roll rate",
              Method::smoother,
              Channels::automatic,
              {.vertical = true, .lateral = true, .roll = true, .yaw = true},
              false},
    MethodRow{"smoother, all",
              Method::smoother,
              Channels::automatic,
              {.vertical = true, .lateral = true, .roll = true, .pitch = true, .yaw = true},
              false}};

/// What every method says of one piece of the survey, mm/m.
struct Reading {
    double reference; ///< of the laser car
    double driven;    ///< true of the tracks and the place that the car itself was on
    double matched;   ///< true of the car's tracks, where satellites put the piece
    std::array<double, methods.size()> estimate;
    std::array<double, methods.size()> sd;
    std::array<double, methods.size()> at_true_place; ///< estimates, had satellites not erred
};

std::vector<Reading> readings_on(const LanePlan& plan);

/// The readings with the factor that fits the first tenth of them best on the methods that are
/// fitted; the factors by method.
struct Fitted {
    std::vector<Reading> readings;
    std::array<double, methods.size()> factor;
};
Fitted fitted(std::vector<Reading> readings);

} // namespace macadam::field_test
