#include "estimator/iri/iri.hpp"

#include "estimator/common/error.hpp"
#include "estimator/vehicle/quarter_car.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace macadam {
namespace {

/// Returns the number of whole steps nearest to a length, at least 1. A step that is a mean of
/// printed stations has an error in its last digits, which must not decide a tie.
std::size_t steps_in(double length_m, double step_m) {
    constexpr double rounding = 1e-6;
    const auto steps = static_cast<std::size_t>(std::floor(length_m / step_m + 0.5 + rounding));
    return std::max<std::size_t>(steps, 1);
}

double mean_slope(std::span<const double> elevation_m, std::size_t steps, double step_m) {
    return (elevation_m[steps] - elevation_m[0]) / (static_cast<double>(steps) * step_m);
}

/// Calls `take` with every signed value of the stroke.
template <typename Take>
void drive(std::span<const double> elevation_m, double step_m, bool envelope, Take take) {
    RectifiedStroke stroke{step_m, envelope};
    const auto drain = [&] {
        while (const auto value = stroke.next_signed()) {
            take(*value);
        }
    };
    for (const double z : elevation_m) {
        stroke.push(z);
        drain();
    }
    stroke.finish();
    drain();
}

} // namespace

std::size_t envelope_steps(double step_m) {
    return steps_in(contact_patch_m, step_m);
}

RectifiedStroke::RectifiedStroke(double step_m, bool envelope) : step_m_{step_m} {
    // Printed stations have few decimals, so their mean step is compared with a tolerance.
    if (!(step_m > 0 && step_m <= coarsest_step_m * (1 + 1e-9))) {
        throw InputError{
            fmt::format("profile step is {} m, expected 0 to {}", step_m, coarsest_step_m)};
    }
    patch_ = envelope ? envelope_steps(step_m) : 1;
    const auto car = discretise(golden_car(), step_m / golden_speed_mps);
    Eigen::Map<Eigen::Matrix4d>{transition_.data()} = car.a;
    Eigen::Map<Eigen::Vector4d>{response_.data()} = car.b;
}

void RectifiedStroke::push(double elevation_m) {
    if (!std::isfinite(elevation_m)) {
        throw InputError{fmt::format(
            "profile elevation {} is '{}', expected a finite number", pushed_, elevation_m)};
    }
    ++pushed_;
    elevation_m_.push_back(elevation_m);
    if (!started_ && pushed_ > steps_in(start_up_m, step_m_)) {
        start();
    }
}

void RectifiedStroke::finish() {
    if (pushed_ < 2) {
        throw InputError{fmt::format("profile has {} points, expected at least 2", pushed_)};
    }
    if (!started_) {
        patch_ = std::min(patch_, pushed_ - 1);
        start();
    }
}

void RectifiedStroke::start() {
    const auto steps = std::min(steps_in(start_up_m, step_m_), pushed_ - 1);
    const double slope = mean_slope(elevation_m_, steps, step_m_);
    state_ = {slope, 0, slope, 0};
    started_ = true;
}

std::optional<double> RectifiedStroke::next() {
    const auto stroke = next_signed();
    return stroke ? std::optional{std::abs(*stroke)} : std::nullopt;
}

std::optional<double> RectifiedStroke::next_signed() {
    if (!started_ || first_ + patch_ >= elevation_m_.size()) {
        return {};
    }
    // The mean over the patch and the difference combine to the slope from its rear to its front.
    const double slope = mean_slope(std::span{elevation_m_}.subspan(first_), patch_, step_m_);
    const Eigen::Map<const Eigen::Matrix4d> transition{transition_.data()};
    const Eigen::Map<const Eigen::Vector4d> response{response_.data()};
    Eigen::Map<Eigen::Vector4d> state{state_.data()};
    state = (transition * state + response * slope).eval();
    constexpr std::size_t worth_dropping = 4096;
    if (++first_ == worth_dropping) {
        elevation_m_.erase(elevation_m_.begin(), elevation_m_.begin() + worth_dropping);
        first_ = 0;
    }
    return 1000 * (state_[2] - state_[0]);
}

std::vector<float>
rectified_stroke_mm_per_m(std::span<const double> elevation_m, double step_m, bool envelope) {
    std::vector<float> stroke;
    stroke.reserve(elevation_m.size());
    drive(elevation_m, step_m, envelope, [&](double value) {
        stroke.push_back(static_cast<float>(std::abs(value)));
    });
    return stroke;
}

std::vector<double>
suspension_stroke_mm_per_m(std::span<const double> elevation_m, double step_m, bool envelope) {
    std::vector<double> stroke;
    stroke.reserve(elevation_m.size());
    drive(elevation_m, step_m, envelope, [&](double value) { stroke.push_back(value); });
    return stroke;
}

double iri_mm_per_m(std::span<const double> elevation_m, double step_m, bool envelope) {
    double sum = 0;
    std::size_t count = 0;
    drive(elevation_m, step_m, envelope, [&](double value) {
        sum += std::abs(value);
        ++count;
    });
    return sum / static_cast<double>(count);
}

} // namespace macadam
