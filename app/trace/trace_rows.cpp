#include "app/trace/trace_rows.hpp"

#include "estimator/common/statistics.hpp"
#include "estimator/roughness/roughness_mean.hpp"

#include <algorithm>

namespace macadam {
namespace {

/// The headline: MRI where both tracks were observed, else HRI.
std::optional<double> headline_of(const TraceRow& row) {
    return row.mean.mri_mm_per_m ? row.mean.mri_mm_per_m : row.mean.hri_mm_per_m;
}

/// Bound of the 90 % interval, `sds` standard deviations from the headline.
Cell bound_of(const TraceRow& row, double sds) {
    const auto iri = headline_of(row);
    return iri ? Cell{std::max(0.0, *iri + sds * row.mean.sd_mm_per_m)} : Cell{};
}

Cell index_of(const TraceRow& row) {
    return !headline_of(row) ? Cell{} : row.mean.mri_mm_per_m ? "MRI" : "HRI";
}

// clang-format off
const Columns<TraceRow> columns{
    {"from_m", as::metres(3), [](auto& r) { return r.from_m; }},
    {"to_m", as::metres(3), [](auto& r) { return r.to_m; }},
    {"t_s", as::seconds(3), [](auto& r) { return r.t_s; }},
    {"lat_deg", as::degrees, [](auto& r) { return r.at ? Cell{r.at->lat_deg} : Cell{}; }},
    {"lon_deg", as::degrees, [](auto& r) { return r.at ? Cell{r.at->lon_deg} : Cell{}; }},
    {"speed_mps", as::real(3, "m/s"), [](auto& r) { return r.speed_mps; }},
    {"iri", as::iri(3), headline_of},
    {"iri_sd", as::iri(3), [](auto& r) { return headline_of(r) ? Cell{r.mean.sd_mm_per_m} : Cell{}; }},
    {"iri_low", as::iri(3), [](auto& r) { return bound_of(r, -normal_interval_90); }},
    {"iri_high", as::iri(3), [](auto& r) { return bound_of(r, normal_interval_90); }},
    {"iri_left", as::iri(3), [](auto& r) { return r.mean.left_mm_per_m; }},
    {"iri_right", as::iri(3), [](auto& r) { return r.mean.right_mm_per_m; }},
    {"mri", as::iri(3), [](auto& r) { return r.mean.mri_mm_per_m; }},
    {"hri", as::iri(3), [](auto& r) { return r.mean.hri_mm_per_m; }},
    {"index", as::text, index_of},
    {"validity", as::text, [](auto& r) { return name_of_validity(r.mean.validity); }},
};
// clang-format on

TraceRow trace_row(double from_m,
                   double length_m,
                   const TripTrace& trace,
                   const TripPositions& place,
                   const Vehicle& vehicle) {
    const double t_s = trace.odometer.t_s(from_m + length_m / 2);
    const auto mean = mean_over(trace.roughness, from_m, from_m + length_m, vehicle);
    return {.from_m = from_m,
            .to_m = from_m + length_m,
            .t_s = t_s,
            .at = place(t_s),
            .speed_mps = mean.hri_mm_per_m ? mean.speed_mps : trace.odometer.speed_mps(t_s),
            .mean = mean};
}

} // namespace

const Columns<TraceRow>& trace_columns() {
    return columns;
}

void each_trace_row(const TripTrace& trace,
                    double length_m,
                    const TripPositions& place,
                    const Vehicle& vehicle,
                    const std::function<void(const TraceRow&)>& take) {
    const double whole_m = trace.odometer.whole_m();
    for (std::size_t i = 0; static_cast<double>(i + 1) * length_m <= whole_m;) {
        const double from_m = static_cast<double>(i) * length_m;
        const double seen_m =
            trace.odometer.past_gap_m(from_m, static_cast<double>(i + 1) * length_m);
        if (seen_m > from_m) {
            i = std::max(i + 1, static_cast<std::size_t>(seen_m / length_m));
        } else {
            take(trace_row(from_m, length_m, trace, place, vehicle));
            ++i;
        }
    }
}

} // namespace macadam
