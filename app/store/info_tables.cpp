#include "app/store/info_tables.hpp"

#include "app/cli/text_table.hpp"
#include "app/store/car_change_output.hpp"

#include "mapping/style/iri_class.hpp"
#include "storage/networks/network_file.hpp"
#include "storage/text/json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <map>
#include <span>
#include <string_view>

namespace macadam {
namespace {

constexpr std::size_t max_rows = 20; // months or cars in the text; JSON has all

double share(double part, double whole) {
    return whole > 0 ? part / whole : 0;
}

std::map<std::string, double> network_km_of(const RoadNetwork& roads) {
    std::map<std::string, double> km;
    for (std::uint32_t i = 0; i < way_count(roads); ++i) {
        const auto way = way_at(roads, i);
        auto& sum_km = km[std::string{way.highway}];
        for (auto link = way.first_link; link < way.past_link; ++link) {
            for (const bool forward : {true, false}) {
                const auto edge = edge_of(LinkId{link}, forward);
                sum_km += is_drivable(roads, edge) ? length_m(roads, edge) / 1000 : 0;
            }
        }
    }
    return km;
}

std::vector<RoadClassInfo> road_classes_of(const StoreReader& store, const StoreUsage& usage) {
    std::map<std::string, RoadClassInfo> by_highway;
    for (const auto& [highway, km] : network_km_of(load_or_build_network(store))) {
        by_highway[highway] = {.highway = highway, .network_km = km, .km = 0, .classes = {}};
    }
    for (const auto& [highway, class_name, km] : usage.road_classes) {
        auto& info = by_highway[highway];
        info.highway = highway;
        info.km += km;
        info.classes.push_back({class_name, km});
    }
    std::vector<RoadClassInfo> infos;
    for (auto& [highway, info] : by_highway) {
        infos.push_back(std::move(info));
    }
    std::ranges::stable_sort(infos, std::greater{}, &RoadClassInfo::network_km);
    return infos;
}

std::vector<CarInfo> cars_of(const StoreUsage& usage) {
    std::map<std::string, CarInfo> by_name;
    std::size_t passes = 0;
    for (const auto& use : usage.vehicles) {
        auto& car = by_name[use.vehicle];
        car.vehicle = use.vehicle;
        car.trips += use.trips;
        car.passes += use.passes;
        car.km += use.km;
        passes += use.passes;
    }
    std::size_t number = 0;
    for (const auto& car : usage.cars) {
        by_name[car].number = car == unknown_car ? 0 : ++number;
    }
    for (const auto& car : usage.calibrated_cars) {
        by_name[car.vehicle].calibration = car.calibration;
        by_name[car.vehicle].periods = car.periods;
    }
    std::vector<CarInfo> cars;
    for (auto& [name, car] : by_name) {
        car.share = share(static_cast<double>(car.passes), static_cast<double>(passes));
        cars.push_back(std::move(car));
    }
    std::ranges::stable_sort(cars, std::greater{}, &CarInfo::passes);
    return cars;
}

std::string car_km_words(const CarInfo& car, UnitSystem units) {
    const bool us = units == UnitSystem::us;
    auto words = fmt::format("{:>9.1f}", us ? 1000 * car.km * mi_of_m : car.km);
    if (const auto& calibration = car.calibration) {
        const double offset = calibration->offset_um / 1000;
        words += fmt::format("  reads {:.3f} x IRI {}, sd {:.1f} %",
                             calibration->gain,
                             us ? fmt::format("{:+.0f} in/mi", offset * in_per_mi_of_mm_per_m)
                                : fmt::format("{:+.2f} mm/m", offset),
                             100 * calibration->relative_sd);
    }
    return words;
}

std::string covered_words(const RoadClassInfo& info) {
    auto words = fmt::format("{:>6.1f} %", 100 * share(info.km, info.network_km));
    for (const auto& [name, km] : info.classes) {
        words += fmt::format("  {} {:.0f} %", name, 100 * share(km, info.km));
    }
    return words;
}

Cell number_of(const CarInfo& car) {
    return car.number > 0 ? Cell{car.number} : Cell{};
}

Cell calibrated(const CarInfo& car, double CarCalibration::*value, double unit = 1) {
    return car.calibration ? Cell{(*car.calibration).*value / unit} : Cell{};
}

// clang-format off
Columns<CarInfo> of_cars(UnitSystem units) {
    return in_units<CarInfo>({
    {"", as::integer, number_of, {"no.", "{:>4}"}},
    {"vehicle", as::text, [](auto& r) { return r.vehicle; }, {"car", " {:<34}"}},
    {"number", as::integer, number_of},
    {"trips", as::integer, [](auto& r) { return r.trips; }, {"trips", " {:>6}"}},
    {"passes", as::integer, [](auto& r) { return r.passes; }, {"passes", " {:>9}"}},
    {"share", as::real(4), [](auto& r) { return r.share; }},
    {"", as::text, [](auto& r) { return fmt::format("{:.1f} %", 100 * r.share); },
     {"share", " {:>7}"}},
    {"km", as::real(3, "km"), [](auto& r) { return r.km; }},
    {"", as::text, [units](auto& r) { return car_km_words(r, units); },
     {units == UnitSystem::us ? "mi" : "km", " {:>9}"}},
    {"gain", as::real(4), [](auto& r) { return calibrated(r, &CarCalibration::gain); }},
    {"offset_mm_per_m", as::iri(3),
     [](auto& r) { return calibrated(r, &CarCalibration::offset_um, 1000); }},
    {"relative_sd", as::real(4), [](auto& r) { return calibrated(r, &CarCalibration::relative_sd); }},
    {"scatter", as::real(4), [](auto& r) { return calibrated(r, &CarCalibration::scatter); }},
    {"changes", as::json_only(as::raw), [](auto& r) { return changes_json(r.periods); }},
    }, units);
}

Columns<RoadClassInfo> of_road_classes(UnitSystem units) {
    return in_units<RoadClassInfo>({
    {"highway", as::text, [](auto& r) { return r.highway.empty() ? Cell{} : Cell{r.highway}; },
     {"road class", "{:<18}"}},
    {"network_km", as::real(3, "km"), [](auto& r) { return r.network_km; },
     {"network km", " {:>11}", 1}},
    {"km", as::real(3, "km"), [](auto& r) { return r.km; }, {"driven km", " {:>10}", 2}},
    {"covered", as::real(4), [](auto& r) { return share(r.km, r.network_km); }},
    {"", as::text, covered_words, {"covered", " {:>8}"}},
    {"classes", as::json_only(as::raw),
     [units](auto& r) { return class_lengths_json(r.classes, r.km, units); }},
    }, units);
}
// clang-format on

std::string car_lines(std::span<const CarInfo> cars, UnitSystem units) {
    const auto count = std::min(cars.size(), max_rows);
    const auto text = fmt::format("\n{}", table_text(of_cars(units), cars.first(count)));
    return cars.size() > count ? text + fmt::format("and {} more\n", cars.size() - count) : text;
}

/// Tells the cars that changed or scatter, of all cars.
std::string change_lines(std::span<const CarInfo> cars) {
    std::string text;
    for (const auto& car : cars) {
        text += changes_text(fmt::format("car {}", car.number), car.periods);
    }
    return text.empty() ? text : "\n" + text;
}

/// Formats the last months.
std::string month_lines(std::span<const DailyUsage> months) {
    const auto last = months.last(std::min(months.size(), max_rows));
    return fmt::format("\n{}", table_text(usage_columns("month"), last));
}

} // namespace

InfoTables info_tables(const StoreReader& store) {
    const auto usage = store.usage();
    return {road_classes_of(store, usage), cars_of(usage), usage.days};
}

Columns<RoadClassInfo> road_class_columns(UnitSystem units) {
    return of_road_classes(units);
}

Columns<CarInfo> car_columns(UnitSystem units) {
    return of_cars(units);
}

Columns<DailyUsage> usage_columns(std::string_view period) {
    return {
        {period, as::text, [](auto& r) { return r.day; }, {period, "{:<18}"}},
        {"trips", as::integer, [](auto& r) { return r.trips; }, {"trips", " {:>6}"}},
        {"passes", as::integer, [](auto& r) { return r.passes; }, {"passes", " {:>9}"}},
    };
}

Columns<ClassLength> class_columns(double km) {
    return {{"class", as::text, [](auto& r) { return r.name; }, {"class", "{:<12}"}},
            {"km", as::real(3, "km"), [](auto& r) { return r.km; }, {"km", " {:>10}", 2}},
            {"share", as::real(4), [km](auto& r) { return share(r.km, km); }, {"share", " {:>7}"}}};
}

std::vector<DailyUsage> months_of(const std::vector<DailyUsage>& days) {
    std::map<std::string, DailyUsage> months;
    for (const auto& [day, trips, passes] : days) {
        auto& month = months[day.substr(0, 7)];
        month.day = day.substr(0, 7);
        month.trips += trips;
        month.passes += passes;
    }
    std::vector<DailyUsage> rows;
    for (const auto& [name, month] : months) {
        rows.push_back(month);
    }
    return rows;
}

std::string text_of(const InfoTables& tables, UnitSystem units) {
    return fmt::format("\n{}", table_text(of_road_classes(units), tables.road_classes)) +
           (tables.cars.empty() ? "" : car_lines(tables.cars, units)) + change_lines(tables.cars) +
           (tables.days.empty() ? "" : month_lines(months_of(tables.days)));
}

std::string
class_lengths_json(const std::vector<ClassLength>& lengths, double km, UnitSystem units) {
    return json_rows(in_units(class_columns(km), units), lengths);
}

void add_to(JsonObject& object, const InfoTables& tables, UnitSystem units) {
    object.add("road_classes", JsonRaw{json_rows(of_road_classes(units), tables.road_classes)})
        .add("cars", JsonRaw{json_rows(of_cars(units), tables.cars)})
        .add("passes_per_month", JsonRaw{json_rows(usage_columns("month"), months_of(tables.days))})
        .add("passes_per_day", JsonRaw{json_rows(usage_columns("day"), tables.days)});
}

} // namespace macadam
