#include "storage/recipe_file.hpp"

#include "storage/toml.hpp"
#include "storage/utc.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace macadam {
namespace {

constexpr TomlRange share{[](double x) { return x >= 0 && x <= 1; }, "a number from 0 to 1"};
constexpr TomlRange short_distance{[](double x) { return std::abs(x) <= 20; },
                                   "metres, from -20 to 20"};
constexpr TomlRange rate{[](double x) { return x > 0 && x <= 1000; },
                         "a number of hertz, above 0 and at most 1000"};

/// Where a key's number goes, and what it may be.
template <typename Recipe>
struct NumberKey {
    std::string_view name;
    TomlRange range;
    double& (*place)(Recipe&);
};

template <typename Recipe>
struct BoundsKey {
    std::string_view name;
    Bounds& (*place)(Recipe&);
};

template <typename Recipe>
struct OptionalKey {
    std::string_view name;
    TomlRange range;
    std::optional<double>& (*place)(Recipe&);
};

// clang-format off
constexpr std::array driving_numbers{
    NumberKey<DrivingRecipe>{"return_share", share, [](auto& r) -> double& { return r.return_share; }},
    NumberKey<DrivingRecipe>{"stop_share", share, [](auto& r) -> double& { return r.stop_share; }},
    NumberKey<DrivingRecipe>{"acceleration_mps2", positive_number, [](auto& r) -> double& { return r.acceleration_mps2; }},
    NumberKey<DrivingRecipe>{"braking_mps2", positive_number, [](auto& r) -> double& { return r.braking_mps2; }},
    NumberKey<DrivingRecipe>{"lateral_mps2", positive_number, [](auto& r) -> double& { return r.lateral_mps2; }},
    NumberKey<DrivingRecipe>{"lane_offset_m", short_distance, [](auto& r) -> double& { return r.lane_offset_m; }},
    NumberKey<DrivingRecipe>{"oneway_offset_m", short_distance, [](auto& r) -> double& { return r.oneway_offset_m; }},
    NumberKey<DrivingRecipe>{"wander_m", not_negative_number, [](auto& r) -> double& { return r.wander_m; }},
    NumberKey<DrivingRecipe>{"wander_length_m", positive_number, [](auto& r) -> double& { return r.wander_length_m; }},
};
constexpr std::array driving_bounds{
    BoundsKey<DrivingRecipe>{"length_km", [](auto& r) -> Bounds& { return r.length_km; }},
    BoundsKey<DrivingRecipe>{"stop_s", [](auto& r) -> Bounds& { return r.stop_s; }},
    BoundsKey<DrivingRecipe>{"driver", [](auto& r) -> Bounds& { return r.driver; }},
};
constexpr std::array gnss_numbers{
    NumberKey<GnssRecipe>{"rate_hz", rate, [](auto& r) -> double& { return r.rate_hz; }},
    NumberKey<GnssRecipe>{"sigma_m", not_negative_number, [](auto& r) -> double& { return r.sigma_m; }},
    NumberKey<GnssRecipe>{"correlation_s", not_negative_number, [](auto& r) -> double& { return r.correlation_s; }},
    NumberKey<GnssRecipe>{"white_m", not_negative_number, [](auto& r) -> double& { return r.white_m; }},
    NumberKey<GnssRecipe>{"speed_sd_mps", not_negative_number, [](auto& r) -> double& { return r.speed_sd_mps; }},
    NumberKey<GnssRecipe>{"outages_per_hour", not_negative_number, [](auto& r) -> double& { return r.outages_per_hour; }},
    NumberKey<GnssRecipe>{"antenna_ahead_m", short_distance, [](auto& r) -> double& { return r.antenna_ahead_m; }},
    NumberKey<GnssRecipe>{"antenna_left_m", short_distance, [](auto& r) -> double& { return r.antenna_left_m; }},
};
constexpr std::array gnss_bounds{
    BoundsKey<GnssRecipe>{"latency_s", [](auto& r) -> Bounds& { return r.latency_s; }},
    BoundsKey<GnssRecipe>{"outage_s", [](auto& r) -> Bounds& { return r.outage_s; }},
    BoundsKey<GnssRecipe>{"first_fix_s", [](auto& r) -> Bounds& { return r.first_fix_s; }},
};
constexpr std::array imu_numbers{
    NumberKey<ImuRecipe>{"rate_hz", rate, [](auto& r) -> double& { return r.rate_hz; }},
    NumberKey<ImuRecipe>{"noise_mps2", positive_number, [](auto& r) -> double& { return r.noise_mps2; }},
    NumberKey<ImuRecipe>{"noise_radps", positive_number, [](auto& r) -> double& { return r.noise_radps; }},
    NumberKey<ImuRecipe>{"lowpass_hz", not_negative_number, [](auto& r) -> double& { return r.lowpass_hz; }},
    NumberKey<ImuRecipe>{"quantum_mps2", not_negative_number, [](auto& r) -> double& { return r.quantum_mps2; }},
    NumberKey<ImuRecipe>{"quantum_radps", not_negative_number, [](auto& r) -> double& { return r.quantum_radps; }},
    NumberKey<ImuRecipe>{"jitter_s", not_negative_number, [](auto& r) -> double& { return r.jitter_s; }},
};
constexpr std::array spread_numbers{
    NumberKey<SensorSpread>{"acc_bias_mps2", not_negative_number, [](auto& r) -> double& { return r.acc_bias_mps2; }},
    NumberKey<SensorSpread>{"gyro_bias_radps", not_negative_number, [](auto& r) -> double& { return r.gyro_bias_radps; }},
    NumberKey<SensorSpread>{"tilt_deg", not_negative_number, [](auto& r) -> double& { return r.tilt_deg; }},
};
constexpr std::array odometer_numbers{
    NumberKey<OdometerRecipe>{"rate_hz", rate, [](auto& r) -> double& { return r.rate_hz; }},
    NumberKey<OdometerRecipe>{"scale_sd", share, [](auto& r) -> double& { return r.scale_sd; }},
    NumberKey<OdometerRecipe>{"noise_mps", not_negative_number, [](auto& r) -> double& { return r.noise_mps; }},
    NumberKey<OdometerRecipe>{"quantum_mps", not_negative_number, [](auto& r) -> double& { return r.quantum_mps; }},
};
constexpr std::array road_numbers{
    OptionalKey<RoadRule>{"waviness", positive_number, [](auto& r) -> std::optional<double>& { return r.waviness; }},
    OptionalKey<RoadRule>{"level_sd", not_negative_number, [](auto& r) -> std::optional<double>& { return r.level_sd; }},
    OptionalKey<RoadRule>{"level_length_m", positive_number, [](auto& r) -> std::optional<double>& { return r.level_length_m; }},
    OptionalKey<RoadRule>{"coherency_length_m", not_negative_number, [](auto& r) -> std::optional<double>& { return r.coherency_length_m; }},
    OptionalKey<RoadRule>{"joint_spacing_m", not_negative_number, [](auto& r) -> std::optional<double>& { return r.joint_spacing_m; }},
    OptionalKey<RoadRule>{"joint_step_mm", not_negative_number, [](auto& r) -> std::optional<double>& { return r.joint_step_mm; }},
    OptionalKey<RoadRule>{"patches_per_km", not_negative_number, [](auto& r) -> std::optional<double>& { return r.patches_per_km; }},
    OptionalKey<RoadRule>{"potholes_per_km", not_negative_number, [](auto& r) -> std::optional<double>& { return r.potholes_per_km; }},
};
constexpr std::array car_numbers{
    NumberKey<CarRecipe>{"ms_kg", positive_number, [](auto& r) -> double& { return r.vehicle.half_car.ms_kg; }},
    NumberKey<CarRecipe>{"mu_kg", positive_number, [](auto& r) -> double& { return r.vehicle.half_car.mu_kg; }},
    NumberKey<CarRecipe>{"ks_n_per_m", positive_number, [](auto& r) -> double& { return r.vehicle.half_car.ks_n_per_m; }},
    NumberKey<CarRecipe>{"cs_ns_per_m", positive_number, [](auto& r) -> double& { return r.vehicle.half_car.cs_ns_per_m; }},
    NumberKey<CarRecipe>{"kt_n_per_m", positive_number, [](auto& r) -> double& { return r.vehicle.half_car.kt_n_per_m; }},
    NumberKey<CarRecipe>{"is_kgm2", positive_number, [](auto& r) -> double& { return r.vehicle.half_car.is_kgm2; }},
    NumberKey<CarRecipe>{"l_m", positive_number, [](auto& r) -> double& { return r.vehicle.half_car.l_m; }},
    NumberKey<CarRecipe>{"wheelbase_m", positive_number, [](auto& r) -> double& { return r.vehicle.axles->wheelbase_m; }},
    NumberKey<CarRecipe>{"cg_to_front_m", positive_number, [](auto& r) -> double& { return r.vehicle.axles->cg_to_front_m; }},
    NumberKey<CarRecipe>{"dynamic_index", positive_number, [](auto& r) -> double& { return r.vehicle.axles->dynamic_index; }},
    NumberKey<CarRecipe>{"rear_ratio", positive_number, [](auto& r) -> double& { return r.vehicle.axles->rear_ratio; }},
    NumberKey<CarRecipe>{"imu_x_m", short_distance, [](auto& r) -> double& { return r.vehicle.imu.x_m; }},
    NumberKey<CarRecipe>{"imu_y_m", short_distance, [](auto& r) -> double& { return r.vehicle.imu.y_m; }},
    NumberKey<CarRecipe>{"imu_height_m", short_distance, [](auto& r) -> double& { return r.vehicle.imu.height_above_roll_axis_m; }},
    NumberKey<CarRecipe>{"friction_n", not_negative_number, [](auto& r) -> double& { return r.friction_n; }},
    NumberKey<CarRecipe>{"rebound_ratio", positive_number, [](auto& r) -> double& { return r.rebound_ratio; }},
    NumberKey<CarRecipe>{"bump_stop_gap_m", positive_number, [](auto& r) -> double& { return r.bump_stop_gap_m; }},
    NumberKey<CarRecipe>{"tyre_nonuniformity_n", not_negative_number, [](auto& r) -> double& { return r.tyre_nonuniformity_n; }},
    NumberKey<CarRecipe>{"antiroll_n_per_m", not_negative_number, [](auto& r) -> double& { return r.antiroll_n_per_m; }},
};
// clang-format on

/// The keys of one table, as they are asked for: what is left over is refused.
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
            place = bounds(key.name).value_or(place);
        }
        return recipe;
    }

    std::optional<Bounds> bounds(std::string_view key) {
        if (!has(key)) {
            return {};
        }
        const auto numbers = table_.numbers(key, not_negative_number);
        if (numbers.size() != 2 || numbers[0] > numbers[1]) {
            table_.refuse(key, "two numbers, the first not above the second");
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
    constexpr std::int64_t most_trips = 1'000'000;
    constexpr std::int64_t most_places = 100'000;
    const auto& table = reader.table();
    driving = reader.numbers(std::move(driving), driving_numbers);
    driving = reader.bounds(std::move(driving), driving_bounds);
    if (reader.has("count")) {
        driving.trips = static_cast<std::size_t>(table.integer("count", 1, most_trips));
    }
    if (reader.has("places")) {
        driving.places = static_cast<std::size_t>(table.integer("places", 2, most_places));
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
    if (driving.driver.low <= 0) {
        table.refuse("driver", "factors above 0");
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

std::vector<std::string> one_or_several(const TomlTable& table, std::string_view key) {
    return table.is_text(key) ? std::vector{table.text(key)} : table.texts(key);
}

RoadRule road_of(Reader reader) {
    constexpr std::int64_t most_id = std::int64_t{1} << 62;
    const auto& table = reader.table();
    auto rule = reader.numbers(RoadRule{}, road_numbers);
    rule.iri_mm_per_m = reader.bounds("iri_mm_per_m");
    if (reader.has("highway")) {
        rule.highways = one_or_several(table, "highway");
    }
    if (reader.has("way_id")) {
        rule.way_id = table.integer("way_id", -most_id, most_id);
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

/// An id becomes part of file names.
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
        if (std::size_t{car.acc} + car.gyro + car.wheel_speed != sensors.size()) {
            table.refuse("sensors", "some of 'acc', 'gyro' and 'speed', each once");
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

/// A recipe on its way: cars are made once all is read that holds for all of them.
struct Draft {
    FleetRecipe recipe;
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

/// What the tables of a recipe say, over what was said before.
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
            recipe.driving.speed_kmh[highway] = speeds->number(highway, positive_number);
        }
    }
    if (const auto knowledge = top.table("knowledge")) {
        constexpr std::array<std::string_view, 1> keys{"relative_sd"};
        knowledge->expect_only(keys);
        recipe.knowledge_sd =
            knowledge->maybe_number("relative_sd", share).value_or(recipe.knowledge_sd);
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

/// A recipe over the sample's, which stands for all that it leaves out.
FleetRecipe recipe_of(const TomlTable& top) {
    const auto sample = parse_toml(sample_recipe(), "the sample recipe");
    auto draft = with_tables(with_tables(Draft{}, sample), top);
    draft.recipe.cars = cars_of(draft.cars, draft.imu);
    return std::move(draft.recipe);
}

} // namespace

FleetRecipe parse_recipe(std::string_view text, const std::string& name) {
    return recipe_of(parse_toml(text, name));
}

FleetRecipe read_recipe(const std::filesystem::path& file) {
    return recipe_of(read_toml(file, "a recipe"));
}

} // namespace macadam
