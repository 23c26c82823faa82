#include "storage/settings/scenario_file.hpp"

#include "storage/settings/sample_scenario.hpp"
#include "storage/settings/scenario_keys.hpp"
#include "storage/tables/toml.hpp"
#include "storage/text/utc.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>
#include <vector>

namespace macadam {
namespace {

using namespace recipe_keys; // only tables

/// Reads the keys of a table; the remaining keys are rejected.
class Reader {
public:
    explicit Reader(TomlTable table) : table_{std::move(table)} {}

    template <typename Recipe, std::size_t count>
    Recipe numbers(Recipe recipe, const std::array<NumberKey<Recipe>, count>& keys) {
        for (const auto& key : keys) {
            double& place = key.place(recipe);
            place = table_.maybe_number(known(key.name), key.range).value_or(place);
        }
        return recipe;
    }

    template <typename Recipe, std::size_t count>
    Recipe numbers(Recipe recipe, const std::array<OptionalKey<Recipe>, count>& keys) {
        for (const auto& key : keys) {
            key.place(recipe) = table_.maybe_number(known(key.name), key.range);
        }
        return recipe;
    }

    template <typename Recipe, std::size_t count>
    Recipe bounds(Recipe recipe, const std::array<BoundsKey<Recipe>, count>& keys) {
        for (const auto& key : keys) {
            Bounds& place = key.place(recipe);
            place = bounds(key.name, key.range).value_or(place);
        }
        return recipe;
    }

    std::optional<Bounds> bounds(std::string_view key, const TomlRange& range) {
        if (!has(key)) {
            return {};
        }
        const auto expected =
            fmt::format("two numbers, the first not above the second, each {}", range.words);
        if (table_.is_number(key)) {
            table_.refuse(key, expected);
        }
        const auto numbers = table_.numbers(key);
        if (numbers.size() != 2 || !(numbers[0] <= numbers[1]) ||
            !std::ranges::all_of(numbers, range.holds)) {
            table_.refuse(key, expected);
        }
        return Bounds{numbers[0], numbers[1]};
    }

    bool has(std::string_view key) { return table_.has(known(key)); }
    const TomlTable& table() const { return table_; }
    void finish() const { table_.expect_only(known_); }

private:
    std::string_view known(std::string_view key) {
        known_.push_back(key);
        return key;
    }

    TomlTable table_;
    std::vector<std::string_view> known_;
};

std::int64_t day_s(Reader& reader, std::string_view key, std::int64_t fallback) {
    if (!reader.has(key)) {
        return fallback;
    }
    const auto time_s = parse_utc_s(reader.table().text(key) + "T00:00:00Z");
    if (!time_s) {
        reader.table().refuse(key, "a day as in '2025-01-31'");
    }
    return static_cast<std::int64_t>(*time_s);
}

DrivingRecipe driving_of(Reader reader, DrivingRecipe driving) {
    constexpr std::int64_t max_trips = 1'000'000;
    constexpr std::int64_t max_places = 100'000;
    const auto& table = reader.table();
    driving = reader.numbers(std::move(driving), driving_numbers);
    driving = reader.bounds(std::move(driving), driving_bounds);
    if (reader.has("count")) {
        driving.trips = static_cast<std::size_t>(table.integer("count", 1, max_trips));
    }
    if (reader.has("places")) {
        driving.places = static_cast<std::size_t>(table.integer("places", 2, max_places));
    }
    if (reader.has("driving_side")) {
        const auto side = table.text("driving_side");
        if (side != "right" && side != "left") {
            table.refuse("driving_side", "'right' or 'left'");
        }
        driving.right_hand = side == "right";
    }
    driving.from_utc_s = day_s(reader, "from", driving.from_utc_s);
    driving.to_utc_s = day_s(reader, "to", driving.to_utc_s);
    if (driving.to_utc_s < driving.from_utc_s) {
        table.refuse("to", "a day not before 'from'");
    }
    if (driving.length_km.high <= 0) {
        table.refuse("length_km", "a length above 0");
    }
    reader.finish();
    return driving;
}

GnssRecipe gnss_of(Reader reader, GnssRecipe gnss) {
    gnss = reader.numbers(gnss, gnss_numbers);
    gnss = reader.bounds(gnss, gnss_bounds);
    if (reader.has("latency_stated")) {
        gnss.latency_stated = reader.table().flag("latency_stated");
    }
    reader.finish();
    return gnss;
}

/// `relative_sd` stands for the keys that are not given, except for dynamic_index and gain.
KnowledgeRecipe knowledge_of(Reader reader, KnowledgeRecipe knowledge) {
    if (reader.has("relative_sd")) {
        const double sd = reader.table().number("relative_sd", share);
        knowledge.ms_kg = knowledge.mu_kg = knowledge.ks_n_per_m = knowledge.cs_ns_per_m =
            knowledge.kt_n_per_m = knowledge.is_kgm2 = sd;
    }
    knowledge = reader.numbers(knowledge, knowledge_numbers);
    reader.finish();
    return knowledge;
}

std::vector<std::string> one_or_several(const TomlTable& table, std::string_view key) {
    return table.is_text(key) ? std::vector{table.text(key)} : table.texts(key);
}

RoadRule road_of(Reader reader) {
    constexpr std::int64_t max_id = std::int64_t{1} << 62;
    const auto& table = reader.table();
    auto rule = reader.numbers(RoadRule{}, road_numbers);
    rule.iri_mm_per_m = reader.bounds("iri_mm_per_m", iri);
    rule.long_wave_ratio = reader.bounds("long_wave_ratio", wave_ratio);
    rule.short_wave_ratio = reader.bounds("short_wave_ratio", wave_ratio);
    if (reader.has("highway")) {
        rule.highways = one_or_several(table, "highway");
    }
    if (reader.has("way_id")) {
        rule.way_id = table.integer("way_id", -max_id, max_id);
    }
    if (reader.has("name")) {
        rule.name = table.text("name");
    }
    if (reader.has("share")) {
        rule.share = table.number("share", share);
    }
    reader.finish();
    return rule;
}

Vehicle car_like(Reader& reader) {
    const auto name = reader.has("like") ? reader.table().text("like") : std::string{"generic"};
    const auto* const like = built_in_vehicle(name);
    if (like == nullptr) {
        reader.table().refuse("like", "a built-in car, such as 'generic' or 'small-car'");
    }
    constexpr Axles usual_axles{.wheelbase_m = 2.7, .cg_to_front_m = 1.25};
    constexpr double usual_height_m = 0.4; // of a console above the roll axis
    auto vehicle = *like;
    vehicle.axles = like->axles.value_or(usual_axles);
    vehicle.imu = {};
    vehicle.imu.height_above_roll_axis_m = usual_height_m;
    return vehicle;
}

/// Tests for characters allowed in an id, which becomes part of file names.
bool is_plain(const std::string& id) {
    return std::ranges::all_of(id, [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
               c == '-' || c == '_';
    });
}

FleetCarRecipe car_of(Reader reader, const ImuRecipe& imu) {
    const auto& table = reader.table();
    FleetCarRecipe car{.car = {.vehicle = car_like(reader)}, .imu = imu};
    car.car = reader.numbers(std::move(car.car), car_numbers);
    if (!reader.has("id")) {
        table.miss("id");
    }
    car.car.vehicle.name = table.text("id");
    if (!is_plain(car.car.vehicle.name)) {
        table.refuse("id", "letters of ASCII, digits, '-' and '_'");
    }
    const auto& axles = *car.car.vehicle.axles;
    if (axles.cg_to_front_m >= axles.wheelbase_m) {
        table.refuse("cg_to_front_m", "less than wheelbase_m");
    }
    if (reader.has("imu_rate_hz")) {
        car.imu.rate_hz = table.number("imu_rate_hz", rate);
    }
    if (reader.has("imu_lowpass_hz")) {
        car.imu.lowpass_hz = table.number("imu_lowpass_hz", not_negative_number);
    }
    if (reader.has("gnss_rate_hz")) {
        car.gnss_rate_hz = table.number("gnss_rate_hz", rate);
    }
    if (reader.has("sensors")) {
        const auto sensors = table.texts("sensors");
        const auto has = [&](const char* name) { return std::ranges::count(sensors, name) == 1; };
        car.acc = has("acc");
        car.gyro = has("gyro");
        car.wheel_speed = has("speed");
        if (std::size_t{car.acc} + car.gyro + car.wheel_speed != sensors.size() || !car.acc) {
            table.refuse("sensors", "'acc', and with it 'gyro' or 'speed' or both, each once");
        }
    }
    reader.finish();
    return car;
}

std::vector<FleetCarRecipe> cars_of(const std::vector<TomlTable>& tables, const ImuRecipe& imu) {
    std::vector<FleetCarRecipe> cars;
    for (const auto& table : tables) {
        auto car = car_of(Reader{table}, imu);
        const bool twice = std::ranges::any_of(cars, [&](const FleetCarRecipe& other) {
            return other.car.vehicle.name == car.car.vehicle.name;
        });
        if (twice) {
            table.refuse("id", "another id for each car");
        }
        cars.push_back(std::move(car));
    }
    return cars;
}

ImuRecipe imu_of(Reader& reader, ImuRecipe imu) {
    imu = reader.numbers(imu, imu_numbers);
    if (reader.has("lowpass_order")) {
        imu.lowpass_order = static_cast<int>(reader.table().integer("lowpass_order", 1, 8));
    }
    return imu;
}

/// Scenario under construction: cars are added after all common settings were read.
struct Draft {
    FleetScenario recipe;
    ImuRecipe imu;
    std::vector<TomlTable> cars;
};

Draft with_sensors(Draft draft, const TomlTable& top) {
    if (const auto gnss = top.table("gnss")) {
        draft.recipe.gnss = gnss_of(Reader{*gnss}, draft.recipe.gnss);
    }
    if (const auto table = top.table("imu")) {
        Reader reader{*table};
        draft.imu = imu_of(reader, draft.imu);
        draft.recipe.spread = reader.numbers(draft.recipe.spread, spread_numbers);
        reader.finish();
    }
    if (const auto odometer = top.table("odometer")) {
        Reader reader{*odometer};
        draft.recipe.odometer = reader.numbers(draft.recipe.odometer, odometer_numbers);
        reader.finish();
    }
    return draft;
}

/// Applies the tables of a scenario to the current values.
Draft with_tables(Draft draft, const TomlTable& top) {
    constexpr std::array<std::string_view, 8> tables{
        "trips", "speed_kmh", "gnss", "imu", "odometer", "knowledge", "road", "car"};
    top.expect_only(tables);
    auto& recipe = draft.recipe;
    if (const auto trips = top.table("trips")) {
        recipe.driving = driving_of(Reader{*trips}, std::move(recipe.driving));
    }
    if (const auto speeds = top.table("speed_kmh")) {
        for (const auto& highway : speeds->keys()) {
            recipe.driving.speed_kmh[highway] = speeds->number(highway, kmh);
        }
    }
    if (const auto knowledge = top.table("knowledge")) {
        recipe.knowledge = knowledge_of(Reader{*knowledge}, recipe.knowledge);
    }
    if (const auto roads = top.tables("road"); !roads.empty()) {
        recipe.roads.clear();
        for (const auto& road : roads) {
            recipe.roads.push_back(road_of(Reader{road}));
        }
    }
    if (auto cars = top.tables("car"); !cars.empty()) {
        draft.cars = std::move(cars);
    }
    return with_sensors(std::move(draft), top);
}

/// Applies a scenario to the sample, which provides the defaults.
FleetScenario recipe_of(const TomlTable& top) {
    const auto sample = parse_toml(sample_recipe(), "the sample recipe");
    auto draft = with_tables(with_tables(Draft{}, sample), top);
    draft.recipe.cars = cars_of(draft.cars, draft.imu);
    return std::move(draft.recipe);
}

} // namespace

FleetScenario parse_recipe(std::string_view text, const std::string& name) {
    return recipe_of(parse_toml(text, name));
}

FleetScenario read_recipe(const std::filesystem::path& file) {
    return recipe_of(read_toml(file, "a recipe"));
}

} // namespace macadam
