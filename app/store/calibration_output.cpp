#include "app/store/calibration_output.hpp"

#include "app/cli/console.hpp"
#include "app/cli/row_writer.hpp"
#include "app/store/car_change_output.hpp"

#include <fmt/format.h>

namespace macadam {
namespace {

constexpr double um_per_mm = 1000;

Cell calibrated(const CalibratedCar& car, double CarCalibration::*value) {
    return car.calibration ? Cell{(*car.calibration).*value} : Cell{};
}

std::string offset_words(const CalibratedCar& car, UnitSystem units) {
    if (!car.calibration) {
        return " too few roads shared with other cars";
    }
    const auto scale = iri_scale(3, units);
    return fmt::format(
        "{:+.{}f}", scale.of_mm_per_m * car.calibration->offset_um / um_per_mm, scale.decimals);
}

std::string sd_words(const CalibratedCar& car) {
    return car.calibration ? fmt::format("{:.1f} %", 100 * car.calibration->relative_sd) : "";
}

/// Share of passes of cars left out that are inside their intervals.
std::optional<double> left_out_coverage(const CalibrationReport& report) {
    return report.left_out_readings > 0
               ? std::optional{static_cast<double>(report.left_out_held) /
                               static_cast<double>(report.left_out_readings)}
               : std::nullopt;
}

std::string left_out_text(const CalibrationReport& report) {
    const auto coverage = left_out_coverage(report);
    return coverage ? fmt::format("cars left out       90 % intervals from the other cars held "
                                  "{:.0f} % of {}\n",
                                  100 * *coverage,
                                  counted(report.left_out_readings, "pass"))
                    : "";
}

// clang-format off
Columns<CalibratedCar> calibrated_car_columns(UnitSystem units) {
    return in_units<CalibratedCar>({
    {"vehicle", as::text, [](auto& r) { return r.vehicle; }, {"car", "{:<34}"}},
    {"trips", as::integer, [](auto& r) { return r.trips; }, {"trips", " {:>6}"}},
    {"shared_passes", as::integer, [](auto& r) { return r.shared; }, {"shared", " {:>9}"}},
    {"gain", as::real(4), [](auto& r) { return calibrated(r, &CarCalibration::gain); },
     {"gain", " {:>7}", 3}},
    {"offset_mm_per_m", as::iri(3), [](auto& r) {
         return r.calibration ? Cell{r.calibration->offset_um / um_per_mm} : Cell{}; }},
    {"", as::text, [units](auto& r) { return offset_words(r, units); }, {"offset", " {:>9}"}},
    {"relative_sd", as::real(4), [](auto& r) { return calibrated(r, &CarCalibration::relative_sd); }},
    {"", as::text, sd_words, {"sd", " {:>9}"}},
    {"scatter", as::real(4), [](auto& r) { return calibrated(r, &CarCalibration::scatter); }},
    {"changes", as::json_only(as::raw), [](auto& r) { return changes_json(r.periods); }},
    }, units);
}

Columns<CalibrationReport> calibration_columns(UnitSystem units) {
    return in_units<CalibrationReport>({
    {"generation", as::integer, [](auto& r) { return r.generation; }},
    {"cars", as::raw, [units](auto& r) { return json_rows(calibrated_car_columns(units), r.cars); }},
    {"car_relative_sd", as::real(4), [](auto& r) { return r.car_relative_sd; }},
    {"trip_relative_sd", as::real(4), [](auto& r) { return r.components.trip_relative_sd; }},
    {"rest_relative_sd", as::real(4), [](auto& r) { return r.components.rest_relative_sd; }},
    {"rest_sd_mm_per_m", as::iri(4), [](auto& r) { return r.components.rest_sd_mm_per_m; }},
    {"anchor_relative_sd", as::real(4), [](auto& r) { return r.components.anchor_relative_sd; }},
    {"passes", as::integer, [](auto& r) { return r.readings; }},
    {"shared_places", as::integer, [](auto& r) { return r.places; }},
    {"left_out_passes", as::integer, [](auto& r) { return r.left_out_readings; }},
    {"left_out_coverage", as::real(4), [](auto& r) { return left_out_coverage(r); }},
    {"reference_surveys", as::integer, [](auto& r) { return r.surveys; }},
    }, units);
}
// clang-format on

} // namespace

std::string text_of(const CalibrationReport& report, UnitSystem units) {
    auto text = table_text(calibrated_car_columns(units), report.cars);
    for (const auto& car : report.cars) {
        text += changes_text(car.vehicle, car.periods);
    }
    if (report.places == 0) { // the error components are not known
        return text;
    }
    const auto& components = report.components;
    const auto components_text =
        fmt::format("\n"
                    "between cars        {:.1f} %\n"
                    "between trips       {:.1f} %\n"
                    "between passes      {:.1f} % and {}\n"
                    "common to all cars  {:.1f} % (possible bias of {})\n"
                    "from {} at {} where two or more cars passed within a year\n",
                    100 * report.car_relative_sd,
                    100 * components.trip_relative_sd,
                    100 * components.rest_relative_sd,
                    iri_words(components.rest_sd_mm_per_m, units),
                    100 * components.anchor_relative_sd,
                    report.surveys > 0 ? "the surveys" : "their mean",
                    counted(report.readings, "pass"),
                    counted(report.places, "place"));
    return text + components_text + left_out_text(report);
}

std::string json_of(const CalibrationReport& report, UnitSystem units) {
    return json_object(calibration_columns(units), report).text() + "\n";
}

std::string csv_of(const CalibrationReport& report, UnitSystem units) {
    return rows_text(calibrated_car_columns(units), report.cars, "csv");
}

} // namespace macadam
