#include "app/store/calibration_output.hpp"

#include "app/cli/console.hpp"
#include "storage/text/json.hpp"

#include <fmt/format.h>

#include <cmath>
#include <vector>

namespace macadam {
namespace {

constexpr double um_per_mm = 1000;

std::string row_of(const CalibratedCar& car) {
    const auto row = fmt::format("{:<34} {:>6} {:>9}", car.vehicle, car.trips, car.shared);
    if (!car.calibration) {
        return row + "       -  too few roads shared with other cars\n";
    }
    const auto& [gain, offset_um, relative_sd] = *car.calibration;
    return row +
           fmt::format(
               " {:>7.3f} {:>+9.3f} {:>7.1f} %\n", gain, offset_um / um_per_mm, 100 * relative_sd);
}

} // namespace

std::string text_of(const CalibrationReport& report) {
    auto text = fmt::format(
        "{:<34} {:>6} {:>9} {:>7} {:>9} {:>9}\n", "car", "trips", "shared", "gain", "offset", "sd");
    for (const auto& car : report.cars) {
        text += row_of(car);
    }
    if (report.places == 0) { // the error components are not known
        return text;
    }
    const auto& components = report.components;
    return text + fmt::format("\n"
                              "between cars        {:.1f} %\n"
                              "between trips       {:.1f} %\n"
                              "between passes      {:.1f} % and {:.2f} mm/m\n"
                              "common to all cars  {:.1f} % (possible bias of {})\n"
                              "from {} at {} where two or more cars passed within a year\n",
                              100 * report.car_relative_sd,
                              100 * components.trip_relative_sd,
                              100 * components.rest_relative_sd,
                              components.rest_sd_mm_per_m,
                              100 * components.anchor_relative_sd,
                              report.surveys > 0 ? "the surveys" : "their mean",
                              counted(report.readings, "pass"),
                              counted(report.places, "place"));
}

std::string json_of(const CalibrationReport& report) {
    const auto whole = [](std::size_t n) { return static_cast<std::int64_t>(n); };
    std::vector<std::string> cars;
    for (const auto& car : report.cars) {
        JsonObject entry;
        entry.add("vehicle", car.vehicle)
            .add("trips", whole(car.trips))
            .add("shared_passes", whole(car.shared));
        if (car.calibration) {
            entry.add("gain", JsonNumber{car.calibration->gain, 4})
                .add("offset_mm_per_m", JsonNumber{car.calibration->offset_um / um_per_mm, 3})
                .add("relative_sd", JsonNumber{car.calibration->relative_sd, 4});
        } else {
            entry.add("gain", nullptr).add("offset_mm_per_m", nullptr).add("relative_sd", nullptr);
        }
        cars.push_back(entry.text());
    }
    const auto& components = report.components;
    JsonObject object;
    object.add("generation", std::int64_t{report.generation})
        .add("cars", JsonRaw{json_array(cars)})
        .add("car_relative_sd", JsonNumber{report.car_relative_sd, 4})
        .add("trip_relative_sd", JsonNumber{components.trip_relative_sd, 4})
        .add("rest_relative_sd", JsonNumber{components.rest_relative_sd, 4})
        .add("rest_sd_mm_per_m", JsonNumber{components.rest_sd_mm_per_m, 4})
        .add("anchor_relative_sd", JsonNumber{components.anchor_relative_sd, 4})
        .add("passes", whole(report.readings))
        .add("shared_places", whole(report.places))
        .add("reference_surveys", whole(report.surveys));
    return object.text() + "\n";
}

} // namespace macadam
