#include "app/trace/trace_rows.hpp"

#include "estimator/roughness/roughness_mean.hpp"
#include "storage/text/json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>
#include <vector>

namespace macadam {
namespace {

constexpr double z_of_90_percent = 1.645;

/// Returns the columns, with values and decimals as in JSON.
std::vector<std::pair<std::string_view, JsonValue>> cells_of(const TraceRow& row) {
    const auto& mean = row.mean;
    // The headline: MRI where both tracks were observed, else HRI.
    const auto headline = mean.mri_mm_per_m ? mean.mri_mm_per_m : mean.hri_mm_per_m;
    const double iri = headline.value_or(0);
    const double reach = z_of_90_percent * mean.sd_mm_per_m;
    const auto known = [&](double value) { return headline ? std::optional{value} : std::nullopt; };
    const auto index = std::string{mean.mri_mm_per_m ? "MRI" : "HRI"};
    return {{"from_m", JsonNumber{row.from_m, 3}},
            {"to_m", JsonNumber{row.to_m, 3}},
            {"t_s", json_number(row.t_s, 3)},
            {"lat_deg", json_number(row.at ? std::optional{row.at->lat_deg} : std::nullopt, 7)},
            {"lon_deg", json_number(row.at ? std::optional{row.at->lon_deg} : std::nullopt, 7)},
            {"speed_mps", json_number(row.speed_mps, 3)},
            {"iri", json_number(headline, 3)},
            {"iri_sd", json_number(known(mean.sd_mm_per_m), 3)},
            {"iri_low", json_number(known(std::max(0.0, iri - reach)), 3)},
            {"iri_high", json_number(known(iri + reach), 3)},
            {"iri_left", json_number(mean.left_mm_per_m, 3)},
            {"iri_right", json_number(mean.right_mm_per_m, 3)},
            {"mri", json_number(mean.mri_mm_per_m, 3)},
            {"hri", json_number(mean.hri_mm_per_m, 3)},
            {"index", headline ? JsonValue{index} : JsonValue{nullptr}},
            {"validity", name_of_validity(mean.validity)}};
}

std::string cell_text(const JsonValue& value) {
    if (const auto* const number = std::get_if<JsonNumber>(&value)) {
        return fmt::format("{:.{}f}", number->value, number->decimals);
    }
    const auto* const words = std::get_if<std::string>(&value);
    return words ? *words : std::string{};
}

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

std::string trace_csv_header() {
    return "from_m,to_m,t_s,lat_deg,lon_deg,speed_mps,iri,iri_sd,iri_low,iri_high,iri_left,"
           "iri_right,mri,hri,index,validity\n";
}

std::string csv_line_of(const TraceRow& row) {
    std::string line;
    std::string_view before;
    for (const auto& [name, value] : cells_of(row)) {
        line += before;
        line += cell_text(value);
        before = ",";
    }
    return line + "\n";
}

std::string json_line_of(const TraceRow& row) {
    return json_object_of(row) + "\n";
}

std::string json_object_of(const TraceRow& row) {
    JsonObject object;
    for (auto& [name, value] : cells_of(row)) {
        object.add(name, value);
    }
    return object.text();
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
