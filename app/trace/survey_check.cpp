#include "app/trace/survey_check.hpp"

#include "estimator/common/error.hpp"
#include "estimator/motion/gnss_track.hpp"
#include "estimator/roughness/roughness_mean.hpp"

#include <fmt/format.h>

#include <set>

namespace macadam {
namespace {

/// Returns the positions of the centre of gravity, from plausible fixes.
std::vector<TravelPosition>
places_of(const TripLog& trip, const Odometer& odometer, const Vehicle& vehicle) {
    const double ahead_m = antenna_ahead_m(trip.meta, vehicle);
    std::vector<TravelPosition> places;
    for (const auto& place : track_of(trip, OdometerConfig{}, &odometer).places) {
        const double travel_m = odometer.travel_m(place.t_s) + ahead_m;
        if (places.empty() || travel_m > places.back().travel_m) {
            places.push_back({place.at, travel_m});
        }
    }
    return places;
}

struct NamedIri {
    std::optional<double> mm_per_m;
    std::string_view index;
};

std::optional<double> mean_of_tracks(const SurveyRow& row) {
    return row.left_mm_per_m && row.right_mm_per_m
               ? std::optional{(*row.left_mm_per_m + *row.right_mm_per_m) / 2}
               : std::nullopt;
}

NamedIri survey_iri(const SurveyRow& row, bool wants_mri) {
    const NamedIri mri{row.mri_mm_per_m ? row.mri_mm_per_m : mean_of_tracks(row), "MRI"};
    const NamedIri hri{row.hri_mm_per_m, "HRI"};
    const NamedIri unspecified{row.iri_mm_per_m, "IRI"};
    const NamedIri track{row.left_mm_per_m ? row.left_mm_per_m : row.right_mm_per_m, "IRI"};
    for (const auto& named : {wants_mri ? mri : hri, unspecified, wants_mri ? hri : mri, track}) {
        if (named.mm_per_m) {
            return named;
        }
    }
    return {{}, ""};
}

AgainstRow row_of(const SurveyRow& survey,
                  const SurveyPass& pass,
                  const TripTrace& trace,
                  const Vehicle& vehicle) {
    const auto mean = mean_over(trace.roughness, pass.from_m, pass.to_m, vehicle);
    const auto named = survey_iri(survey, mean.mri_mm_per_m.has_value());
    return {.survey = survey,
            .pass = pass,
            .t_s = trace.odometer.t_s((pass.from_m + pass.to_m) / 2),
            .mean = mean,
            .survey_mm_per_m = named.mm_per_m,
            .survey_index = named.index};
}

} // namespace

Against against_survey(std::span<const SurveyRow> survey,
                       const TripLog& trip,
                       const TripTrace& trace,
                       const Vehicle& vehicle,
                       const SurveyMatchConfig& config) {
    Against against{.rows = {}, .survey_rows = survey.size(), .met = 0};
    std::set<std::size_t> met;
    for (const auto& pass :
         match_survey(survey, places_of(trip, trace.odometer, vehicle), config)) {
        met.insert(pass.row);
        against.rows.push_back(row_of(survey[pass.row], pass, trace, vehicle));
    }
    against.met = met.size();
    if (met.empty()) {
        throw InputError{fmt::format("covers none of the survey's {} rows, expected some "
                                     "within {:g} m and {:g} degrees of its path",
                                     survey.size(),
                                     config.max_distance_m,
                                     config.max_angle_deg)};
    }
    return against;
}

} // namespace macadam
