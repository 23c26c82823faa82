#include "app/profile/profile_simulation.hpp"

#include "estimator/common/error.hpp"
#include "estimator/iri/iri.hpp"
#include "storage/profiles/profile_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <utility>
#include <variant>

namespace macadam {
namespace {

constexpr double reliable_after_m = 60; // lead-in that leaves 0.1 % of the golden car's transient

/// Returns the start of the car: the first point, or the reported part if the profile before it is
/// shorter than the base of the start slope. On even stations it is the last point before, so that
/// no point moves.
double start_of(const ProfileExtent& extent, std::optional<double> from_m) {
    const double before_m = from_m.value_or(extent.first_m) - extent.first_m;
    if (before_m < 0 || before_m >= start_up_m) {
        return extent.first_m;
    }
    if (!extent.even_step_m) {
        return extent.first_m + before_m;
    }
    const double steps = std::floor((before_m + rounding_m) / *extent.even_step_m);
    return extent.first_m + steps * *extent.even_step_m;
}

/// Returns the end of the last value of the rectified stroke; the envelope shortens the profile.
double end_of(const ProfileExtent& extent, const IriMethod& method) {
    if (!method.envelope_samples) {
        return extent.last_m;
    }
    return extent.last_m - static_cast<double>(*method.envelope_samples - 1) * *extent.even_step_m;
}

void check_step(const ProfileExtent& extent, const std::string& file) {
    const double mean_m = (extent.last_m - extent.first_m) / static_cast<double>(extent.points - 1);
    if (mean_m > coarsest_step_m * (1 + 1e-9)) {
        throw InputError{fmt::format(
            "{}: has a point every {:.6g} m, expected 0 to {}", file, mean_m, coarsest_step_m)};
    }
}

/// Simulation of the golden car on one track.
class Drive {
public:
    explicit Drive(std::variant<RectifiedStroke, ExactIri> iri) : iri_{std::move(iri)} {}

    void push(double station_m, double elevation_m) {
        if (auto* const sampled = std::get_if<RectifiedStroke>(&iri_)) {
            sampled->push(elevation_m);
        } else {
            std::get<ExactIri>(iri_).push(station_m, elevation_m);
        }
    }
    void finish() {
        std::visit([](auto& iri) { iri.finish(); }, iri_);
    }
    std::optional<double> next() {
        return std::visit([](auto& iri) { return iri.next(); }, iri_);
    }

private:
    std::variant<RectifiedStroke, ExactIri> iri_;
};

/// Reads the points from the start of the car on; a start between two stations is interpolated.
class RowsFromStart {
public:
    RowsFromStart(const IriQuestion& question, const Course& course)
        : rows_{question.measured ? rows_of_profile(*question.measured)
                                  : open_profile(question.profile, question.step_m)},
          course_{course} {}

    std::span<const double> next() {
        if (std::exchange(held_, false)) {
            return after_;
        }
        if (std::exchange(started_, true)) {
            return rows_->next();
        }
        return course_.sampled() ? past_the_skipped() : at_start();
    }

private:
    std::span<const double> past_the_skipped() {
        const double skipped_m = course_.start_m - course_.extent.first_m;
        for (auto skip = std::lround(skipped_m / *course_.extent.even_step_m); skip > 0; --skip) {
            rows_->next();
        }
        return rows_->next();
    }

    std::span<const double> at_start() {
        auto row = rows_->next();
        while (!row.empty() && row.front() < course_.start_m) {
            before_.assign(row.begin(), row.end());
            row = rows_->next();
        }
        if (row.empty() || before_.empty() || row.front() == course_.start_m) {
            return row;
        }
        after_.assign(row.begin(), row.end());
        held_ = true;
        const double part =
            (course_.start_m - before_.front()) / (after_.front() - before_.front());
        for (std::size_t i = 1; i < before_.size(); ++i) {
            before_[i] = std::lerp(before_[i], after_[i], part);
        }
        before_.front() = course_.start_m;
        return before_;
    }

    std::unique_ptr<ProfileRows> rows_;
    const Course& course_;
    std::vector<double> before_;
    std::vector<double> after_;
    bool started_ = false;
    bool held_ = false;
};

std::vector<Drive>
drives_of(const Course& course, bool envelope, const std::vector<double>& edges_m) {
    const auto& tracks = course.extent.tracks;
    std::vector<Drive> drives;
    for (std::size_t i = 0; i < tracks.size() + (course.pair() ? 1 : 0); ++i) {
        if (course.sampled()) {
            drives.emplace_back(RectifiedStroke{*course.extent.even_step_m, envelope});
        } else {
            drives.emplace_back(ExactIri{
                edges_m, envelope, envelope ? StrokeValue::integral : StrokeValue::at_end});
        }
    }
    return drives;
}

} // namespace

std::size_t Course::index_at(double station_m) const {
    const double steps = (station_m - start_m) / *extent.even_step_m - rounding_m;
    return static_cast<std::size_t>(std::max(0.0, std::ceil(steps)));
}

bool Course::leads_in(double at_m) const {
    return at_m - start_m < reliable_after_m - rounding_m;
}

std::optional<TrackPair> Course::pair() const {
    const auto& tracks = extent.tracks;
    const auto left = std::ranges::find(tracks, "left") - tracks.begin();
    const auto right = std::ranges::find(tracks, "right") - tracks.begin();
    if (left == std::ssize(tracks) || right == std::ssize(tracks)) {
        return {};
    }
    return TrackPair{static_cast<std::size_t>(left), static_cast<std::size_t>(right)};
}

Course course_of(const IriQuestion& question) {
    const auto file = question.profile.string();
    Course course{.extent = question.measured
                                ? extent_of_profile(file, *question.measured)
                                : extent_of_profile(question.profile, question.step_m),
                  .method = {},
                  .start_m = 0,
                  .from_m = 0,
                  .to_m = 0,
                  .covered_to_m = 0};
    const auto& extent = course.extent;
    check_step(extent, file);
    course.method.even_step_m = extent.even_step_m;
    if (extent.even_step_m && question.envelope) {
        course.method.envelope_samples =
            std::min(envelope_steps(*extent.even_step_m), extent.points - 1);
    }
    course.start_m = start_of(extent, question.from_m);
    const double end_m = end_of(extent, course.method);
    course.from_m = question.from_m.value_or(course.start_m);
    course.to_m = std::min(question.to_m.value_or(end_m), end_m);
    course.covered_to_m = std::min(question.to_m.value_or(extent.last_m), extent.last_m);
    if (!(course.from_m >= course.start_m && course.from_m < course.to_m)) {
        throw InputError{fmt::format("{}: --from-m {:g} --to-m {:g} contains no part of the "
                                     "profile, expected {:g} to {:g} m",
                                     file,
                                     course.from_m,
                                     question.to_m.value_or(end_m),
                                     extent.first_m,
                                     end_m)};
    }
    return course;
}

void drive_all(const IriQuestion& question,
               const Course& course,
               const std::vector<double>& edges_m,
               const std::function<void(std::span<const double>)>& take) {
    auto drives = drives_of(course, question.envelope, edges_m);
    const auto pair = course.pair();
    std::vector<double> values(drives.size());
    const auto drain = [&] {
        while (const auto first = drives.front().next()) {
            values.front() = *first;
            for (std::size_t i = 1; i < drives.size(); ++i) {
                values[i] = drives[i].next().value();
            }
            take(values);
        }
    };
    RowsFromStart rows{question, course};
    for (auto row = rows.next(); !row.empty(); row = rows.next()) {
        const auto elevation_m = row.subspan(1);
        for (std::size_t i = 0; i < elevation_m.size(); ++i) {
            drives[i].push(row.front(), elevation_m[i]);
        }
        if (pair) {
            drives.back().push(row.front(),
                               std::midpoint(elevation_m[pair->left], elevation_m[pair->right]));
        }
        drain();
    }
    for (auto& drive : drives) {
        drive.finish();
    }
    drain();
}

} // namespace macadam
