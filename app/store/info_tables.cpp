#include "app/store/info_tables.hpp"

#include "app/cli/terminal_escape.hpp"

#include "storage/networks/network_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

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

std::vector<RoadClassInfo> road_classes_of(const RoadStore& store) {
    std::map<std::string, RoadClassInfo> by_highway;
    for (const auto& [highway, km] : network_km_of(load_or_build_network(store))) {
        by_highway[highway] = {.highway = highway, .network_km = km, .km = 0, .classes = {}};
    }
    for (const auto& [highway, class_name, km] : store.road_class_lengths()) {
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

std::vector<CarInfo> cars_of(const RoadStore& store) {
    std::map<std::string, CarInfo> by_name;
    std::size_t passes = 0;
    for (const auto& use : store.vehicle_uses()) {
        auto& car = by_name[use.vehicle];
        car.vehicle = use.vehicle;
        car.trips += use.trips;
        car.passes += use.passes;
        car.km += use.km;
        passes += use.passes;
    }
    std::size_t number = 0;
    for (const auto& car : store.cars()) {
        by_name[car].number = car == unknown_car ? 0 : ++number;
    }
    for (const auto& car : store.calibrated_cars()) {
        by_name[car.vehicle].calibration = car.calibration;
    }
    std::vector<CarInfo> cars;
    for (auto& [name, car] : by_name) {
        car.share = share(static_cast<double>(car.passes), static_cast<double>(passes));
        cars.push_back(std::move(car));
    }
    std::ranges::stable_sort(cars, std::greater{}, &CarInfo::passes);
    return cars;
}

std::string road_class_lines(const std::vector<RoadClassInfo>& infos) {
    std::string text = fmt::format(
        "\n{:<18} {:>11} {:>10} {:>8}\n", "road class", "network km", "driven km", "covered");
    for (const auto& info : infos) {
        text += fmt::format("{:<18} {:>11.1f} {:>10.2f} {:>6.1f} %",
                            info.highway.empty() ? "-" : printable_name(info.highway),
                            info.network_km,
                            info.km,
                            100 * share(info.km, info.network_km));
        for (const auto& [name, km] : info.classes) {
            text += fmt::format("  {} {:.0f} %", name, 100 * share(km, info.km));
        }
        text += "\n";
    }
    return text;
}

std::string calibration_words(const CarInfo& car) {
    if (!car.calibration) {
        return {};
    }
    const auto& [gain, offset_um, relative_sd] = *car.calibration;
    return fmt::format("  reads {:.3f} x IRI {:+.2f} mm/m, sd {:.1f} %",
                       gain,
                       offset_um / 1000,
                       100 * relative_sd);
}

std::string car_lines(const std::vector<CarInfo>& cars) {
    auto text = fmt::format(
        "\n{:>4} {:<34} {:>6} {:>9} {:>7} {:>9}\n", "no.", "car", "trips", "passes", "share", "km");
    for (std::size_t i = 0; i < std::min(cars.size(), max_rows); ++i) {
        const auto& car = cars[i];
        text += fmt::format("{:>4} {:<34} {:>6} {:>9} {:>5.1f} % {:>9.1f}{}\n",
                            car.number > 0 ? std::to_string(car.number) : "-",
                            car.vehicle,
                            car.trips,
                            car.passes,
                            100 * car.share,
                            car.km,
                            calibration_words(car));
    }
    return cars.size() > max_rows ? text + fmt::format("and {} more\n", cars.size() - max_rows)
                                  : text;
}

std::string month_lines(const std::map<std::string, DailyUsage>& months) {
    auto text = fmt::format("\n{:<18} {:>6} {:>9}\n", "month", "trips", "passes");
    std::size_t left_out = months.size() - std::min(months.size(), max_rows);
    for (const auto& [month, use] : months) {
        if (left_out > 0) {
            --left_out; // the last months are shown
            continue;
        }
        text += fmt::format("{:<18} {:>6} {:>9}\n", month, use.trips, use.passes);
    }
    return text;
}

std::string json_of(const RoadClassInfo& info) {
    std::vector<std::string> classes;
    for (const auto& [name, km] : info.classes) {
        JsonObject entry;
        entry.add("class", name)
            .add("km", JsonNumber{km, 3})
            .add("share", JsonNumber{share(km, info.km), 4});
        classes.push_back(entry.text());
    }
    JsonObject object;
    object.add("highway", info.highway.empty() ? JsonValue{nullptr} : JsonValue{info.highway})
        .add("network_km", JsonNumber{info.network_km, 3})
        .add("km", JsonNumber{info.km, 3})
        .add("covered", JsonNumber{share(info.km, info.network_km), 4})
        .add("classes", JsonRaw{json_array(classes)});
    return object.text();
}

std::string json_of(const CarInfo& car) {
    JsonObject object;
    object.add("vehicle", car.vehicle)
        .add("number",
             car.number > 0 ? JsonValue{static_cast<std::int64_t>(car.number)} : JsonValue{nullptr})
        .add("trips", static_cast<std::int64_t>(car.trips))
        .add("passes", static_cast<std::int64_t>(car.passes))
        .add("share", JsonNumber{car.share, 4})
        .add("km", JsonNumber{car.km, 3});
    if (const auto& calibration = car.calibration) {
        object.add("gain", JsonNumber{calibration->gain, 4})
            .add("offset_mm_per_m", JsonNumber{calibration->offset_um / 1000, 3})
            .add("relative_sd", JsonNumber{calibration->relative_sd, 4});
    } else {
        object.add("gain", nullptr).add("offset_mm_per_m", nullptr).add("relative_sd", nullptr);
    }
    return object.text();
}

std::string json_of(std::string_view key, const DailyUsage& use) {
    JsonObject object;
    object.add(key, use.day)
        .add("trips", static_cast<std::int64_t>(use.trips))
        .add("passes", static_cast<std::int64_t>(use.passes));
    return object.text();
}

} // namespace

InfoTables info_tables(const RoadStore& store) {
    return {road_classes_of(store), cars_of(store), store.day_uses()};
}

std::map<std::string, DailyUsage> months_of(const std::vector<DailyUsage>& days) {
    std::map<std::string, DailyUsage> months;
    for (const auto& [day, trips, passes] : days) {
        auto& month = months[day.substr(0, 7)];
        month.day = day.substr(0, 7);
        month.trips += trips;
        month.passes += passes;
    }
    return months;
}

std::string text_of(const InfoTables& tables) {
    auto text = road_class_lines(tables.road_classes);
    text += tables.cars.empty() ? "" : car_lines(tables.cars);
    return text + (tables.days.empty() ? "" : month_lines(months_of(tables.days)));
}

void add_to(JsonObject& object, const InfoTables& tables) {
    std::vector<std::string> road_classes, cars, days, months;
    for (const auto& info : tables.road_classes) {
        road_classes.push_back(json_of(info));
    }
    for (const auto& car : tables.cars) {
        cars.push_back(json_of(car));
    }
    for (const auto& day : tables.days) {
        days.push_back(json_of("day", day));
    }
    for (const auto& [month, use] : months_of(tables.days)) {
        months.push_back(json_of("month", use));
    }
    object.add("road_classes", JsonRaw{json_array(road_classes)})
        .add("cars", JsonRaw{json_array(cars)})
        .add("passes_per_month", JsonRaw{json_array(months)})
        .add("passes_per_day", JsonRaw{json_array(days)});
}

} // namespace macadam
