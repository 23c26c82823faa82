#include "mapping/surveys/survey_match.hpp"

#include "estimator/common/angle.hpp"
#include "mapping/surveys/survey_line.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace macadam {
namespace {

constexpr double course_over_m = 10; // on both sides of a sample, to average position noise
constexpr double min_chord_m = 5;    // of a course
constexpr double other_road_m = 2;   // advantage required to switch to another line
constexpr double slack_m = 5;        // of a pass beyond its first and last sample

/// Position and course of the trip at one travel distance.
struct Sample {
    PointEn at;
    double travel_m;
    PointEn course; ///< a unit vector
};

/// A sample matched to the survey.
struct Met {
    double travel_m;
    LegPosition place;
};

/// The trip as one polyline in a plane, without the gaps between its positions.
class TripLine {
public:
    TripLine(std::span<const TravelPosition> trip, const LocalFrame& frame) {
        for (const auto& place : trip) {
            at_.push_back(frame.to_local(place.at));
            travel_m_.push_back(place.travel_m);
        }
    }

    std::size_t size() const { return at_.size(); }
    double travel_m(std::size_t i) const { return travel_m_[i]; }

    PointEn operator()(double travel_m) const {
        const auto after = std::ranges::upper_bound(travel_m_, travel_m) - travel_m_.begin();
        const auto last = static_cast<std::ptrdiff_t>(travel_m_.size()) - 1;
        const auto i = static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(after, 1, last));
        const double run_m = travel_m_[i] - travel_m_[i - 1];
        const double part =
            run_m > 0 ? std::clamp((travel_m - travel_m_[i - 1]) / run_m, 0.0, 1.0) : 0;
        return {at_[i - 1].east_m + part * (at_[i].east_m - at_[i - 1].east_m),
                at_[i - 1].north_m + part * (at_[i].north_m - at_[i - 1].north_m)};
    }

private:
    std::vector<PointEn> at_;
    std::vector<double> travel_m_;
};

std::vector<Sample> samples_of(const TripLine& line, const SurveyMatchConfig& config) {
    std::vector<Sample> samples;
    for (std::size_t i = 1; i < line.size(); ++i) {
        const double from_m = line.travel_m(i - 1);
        const double run_m = line.travel_m(i) - from_m;
        if (run_m <= 0 || run_m > config.longest_hole_m) {
            continue;
        }
        const auto parts = static_cast<int>(std::ceil(run_m / config.sample_m));
        for (int part = 0; part < parts; ++part) {
            const double travel_m = from_m + run_m * part / parts;
            const auto behind = line(travel_m - course_over_m);
            const auto ahead = line(travel_m + course_over_m);
            const double east_m = ahead.east_m - behind.east_m;
            const double north_m = ahead.north_m - behind.north_m;
            const double chord_m = std::hypot(east_m, north_m);
            if (chord_m >= min_chord_m) {
                samples.push_back({.at = line(travel_m),
                                   .travel_m = travel_m,
                                   .course = {east_m / chord_m, north_m / chord_m}});
            }
        }
    }
    return samples;
}

bool runs_alike(const PointEn& a, const PointEn& b, double max_angle_deg) {
    const double cosine = a.east_m * b.east_m + a.north_m * b.north_m;
    return std::acos(std::clamp(cosine, -1.0, 1.0)) <= max_angle_deg * rad_per_deg;
}

bool goes_on(const Met& before, double travel_m, const LegPosition& place, double max_distance_m) {
    const double apart_m = place.station_m - before.place.station_m - (travel_m - before.travel_m);
    return place.line == before.place.line &&
           std::abs(apart_m) <= 2 * max_distance_m + (travel_m - before.travel_m) / 4;
}

/// Returns true beyond the ends of a line, where the nearest point is its end but not where the
/// trip was.
bool is_end(const LegPosition& place, const SurveyLine& line) {
    return place.station_m <= line.pieces.front().from_m ||
           place.station_m >= line.pieces.back().to_m;
}

/// Finds the nearest point within the limits; of two about equally near, the one that continues the
/// line.
std::optional<LegPosition> place_of(const Sample& sample,
                                    const std::optional<Met>& before,
                                    const SurveyLines& lines,
                                    const SurveyLegIndex& index,
                                    const SurveyMatchConfig& config) {
    std::optional<LegPosition> best;
    double least = 0;
    for (const std::size_t leg : index.near(sample.at)) {
        const auto place = nearest_on(lines.legs[leg], sample.at);
        if (place.distance_m > config.max_distance_m || is_end(place, lines.lines[place.line]) ||
            !runs_alike(lines.legs[leg].course, sample.course, config.max_angle_deg)) {
            continue;
        }
        const bool on = before && goes_on(*before, sample.travel_m, place, config.max_distance_m);
        const double cost = place.distance_m + (on ? 0 : other_road_m);
        if (!best || cost < least) {
            best = place;
            least = cost;
        }
    }
    return best;
}

/// Groups matched samples in which line and trip advance together.
std::vector<std::vector<Met>> runs_of(std::span<const Sample> samples,
                                      const SurveyLines& lines,
                                      const SurveyMatchConfig& config) {
    const SurveyLegIndex index{lines.legs, config.max_distance_m};
    std::vector<std::vector<Met>> runs;
    std::optional<Met> before;
    for (const auto& sample : samples) {
        const auto place = place_of(sample, before, lines, index, config);
        if (!place) {
            continue;
        }
        const bool on = before && sample.travel_m - before->travel_m <= config.longest_hole_m &&
                        goes_on(*before, sample.travel_m, *place, config.max_distance_m);
        if (!on) {
            runs.emplace_back();
        }
        before = Met{sample.travel_m, *place};
        runs.back().push_back(*before);
    }
    return runs;
}

/// Returns the offset of the line's measure from the trip's at each sample: a symmetric mean, so
/// that drift between the two is followed up to the ends.
std::vector<double> ahead_of_trip_m(std::span<const Met> run, double average_m) {
    std::vector<double> sums{0};
    for (const auto& met : run) {
        sums.push_back(sums.back() + met.place.station_m - met.travel_m);
    }
    std::vector<double> ahead_m(run.size());
    for (std::size_t k = 0; k < run.size(); ++k) {
        std::size_t reach = 0;
        const std::size_t most = std::min(k, run.size() - 1 - k);
        while (reach < most &&
               run[k + reach + 1].travel_m - run[k - reach - 1].travel_m <= average_m) {
            ++reach;
        }
        ahead_m[k] = (sums[k + reach + 1] - sums[k - reach]) / static_cast<double>(2 * reach + 1);
    }
    return ahead_m;
}

/// Travel of the trip at stations of the line.
struct Rulers {
    std::vector<double> station_m; ///< increasing
    std::vector<double> travel_m;

    std::optional<double> travel_at(double at_m) const {
        if (at_m < station_m.front() - slack_m || at_m > station_m.back() + slack_m) {
            return std::nullopt;
        }
        const auto after = std::ranges::upper_bound(station_m, at_m) - station_m.begin();
        const auto last = static_cast<std::ptrdiff_t>(station_m.size()) - 1;
        if (after == 0) {
            return travel_m.front() + at_m - station_m.front();
        }
        if (after > last) {
            return travel_m.back() + at_m - station_m.back();
        }
        const auto i = static_cast<std::size_t>(after);
        const double part = (at_m - station_m[i - 1]) / (station_m[i] - station_m[i - 1]);
        return travel_m[i - 1] + part * (travel_m[i] - travel_m[i - 1]);
    }
};

Rulers rulers_of(std::span<const Met> run, double average_m) {
    const auto ahead_m = ahead_of_trip_m(run, average_m);
    Rulers rulers;
    for (std::size_t k = 0; k < run.size(); ++k) {
        const double station_m = run[k].travel_m + ahead_m[k];
        if (rulers.station_m.empty() || station_m > rulers.station_m.back()) {
            rulers.station_m.push_back(station_m);
            rulers.travel_m.push_back(run[k].travel_m);
        }
    }
    return rulers;
}

double mean_distance_m(std::span<const Met> run, double from_m, double to_m) {
    auto met = std::ranges::lower_bound(run, from_m, {}, &Met::travel_m);
    if (met == run.end() || met->travel_m > to_m) {
        met -= met == run.begin() ? 0 : 1;
        return met->place.distance_m;
    }
    double sum_m = 0;
    double count = 0;
    for (; met != run.end() && met->travel_m <= to_m; ++met) {
        sum_m += met->place.distance_m;
        count += 1;
    }
    return sum_m / count;
}

std::vector<SurveyPass>
passes_of(std::span<const Met> run, const SurveyLine& line, double average_m) {
    const auto rulers = rulers_of(run, average_m);
    std::vector<SurveyPass> passes;
    for (const auto& piece : line.pieces) {
        const auto from_m = rulers.travel_at(piece.from_m);
        const auto to_m = rulers.travel_at(piece.to_m);
        if (from_m && to_m && *from_m < *to_m) {
            passes.push_back({.row = piece.row,
                              .pass = 1,
                              .from_m = *from_m,
                              .to_m = *to_m,
                              .distance_m = mean_distance_m(run, *from_m, *to_m)});
        }
    }
    return passes;
}

} // namespace

std::vector<SurveyPass> match_survey(std::span<const SurveyRow> survey,
                                     std::span<const TravelPosition> trip,
                                     const SurveyMatchConfig& config) {
    if (survey.empty() || trip.size() < 2) {
        return {};
    }
    const LocalFrame frame{survey.front().at};
    const auto lines = survey_lines(survey, frame);
    const auto samples = samples_of(TripLine{trip, frame}, config);
    std::vector<SurveyPass> passes;
    for (const auto& run : runs_of(samples, lines, config)) {
        for (const auto& pass :
             passes_of(run, lines.lines[run.front().place.line], config.average_m)) {
            passes.push_back(pass);
        }
    }
    std::ranges::stable_sort(passes, {}, &SurveyPass::from_m);
    std::map<std::size_t, std::size_t> count;
    for (auto& pass : passes) {
        pass.pass = ++count[pass.row];
    }
    return passes;
}

} // namespace macadam
