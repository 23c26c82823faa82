#include "app/cli/commands.hpp"
#include "app/cli/overwrite_guard.hpp"
#include "app/cli/row_output.hpp"
#include "app/pipeline/vehicle_lookup.hpp"
#include "app/vehicles/vehicle_rows.hpp"

#include "estimator/common/error.hpp"
#include "estimator/smoother/car_tuning.hpp"
#include "estimator/vehicle/vehicle_prior.hpp"
#include "storage/settings/vehicle_file.hpp"
#include "storage/settings/vehicle_writer.hpp"
#include "storage/text/spelling.hpp"
#include "storage/text/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>

namespace macadam {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view add_word = "add";
constexpr std::string_view of_add = "of 'vehicles add'";
constexpr std::array<std::string_view, 7> owner_options{
    "--mass", "--wheelbase", "--body", "--tyres", "--front-share", "--sensor", "--mount"};

/// Returns the built-in cars, or those of --vehicles.
std::vector<ListedVehicle> asked_vehicles(const Arguments& arguments) {
    const auto folder = arguments.value("--vehicles");
    if (!folder) {
        return listed_built_in_vehicles();
    }
    if (!fs::is_directory(*folder)) {
        throw InputError{
            fmt::format("{}: is not a folder, expected a folder of vehicle files", *folder)};
    }
    std::vector<ListedVehicle> listed;
    for (auto& [name, vehicle] : vehicles_in(*folder)) {
        listed.push_back({vehicle, fmt::format("trips with vehicle_id {}", name)});
    }
    if (listed.empty()) {
        throw InputError{fmt::format("{}: contains no vehicle file (*.toml); 'macadam vehicles "
                                     "add' makes one",
                                     *folder)};
    }
    return listed;
}

/// Finds a car by name, or reads its file.
Vehicle asked_vehicle(const std::string& name, const Arguments& arguments) {
    const auto listed = asked_vehicles(arguments);
    std::vector<std::string> names;
    for (const auto& [vehicle, words] : listed) {
        if (vehicle.name == name) {
            return vehicle;
        }
        names.push_back(vehicle.name);
    }
    if (fs::exists(name) || name.ends_with(".toml")) {
        return read_vehicle(name);
    }
    names.emplace_back(add_word);
    const auto nearest = suggestion(name, names);
    throw UsageError{fmt::format(
        "unknown car {}{}",
        in_quotes(name),
        nearest.empty() ? "; 'macadam vehicles' lists all, or give a TOML file" : nearest)};
}

/// Returns the vehicle files that the rows may come of.
std::vector<fs::path> files_read(const std::string& car, const Arguments& arguments) {
    std::vector<fs::path> files;
    if (!car.empty()) {
        files.emplace_back(car);
    }
    if (const auto folder = arguments.value("--vehicles"); folder && fs::is_directory(*folder)) {
        for (const auto& entry : fs::directory_iterator{*folder}) {
            files.push_back(entry.path());
        }
    }
    return files;
}

double number_in(const Arguments& arguments,
                 std::string_view name,
                 const ValueRange& range,
                 std::string_view unit,
                 const std::string& of) {
    const auto value = arguments.number(name);
    if (!value) {
        throw UsageError{fmt::format("{} is missing", name)};
    }
    if (!range.contains(*value)) {
        throw UsageError{fmt::format(
            "{} is {}, expected {} to {} {}{}", name, *value, range.min, range.max, unit, of)};
    }
    return *value;
}

BodyType body_in(const Arguments& arguments) {
    if (!arguments.value("--body")) {
        throw UsageError{fmt::format("--body is missing, expected {}",
                                     fmt::join(arguments.choices("--body"), ", "))};
    }
    return *std::ranges::find(body_types(), arguments.choice("--body"), &BodyType::name);
}

OwnersData parse_owners_data(const Arguments& arguments) {
    const auto body = body_in(arguments);
    const auto of_body = fmt::format(" for --body {}", body.name);
    OwnersData known{
        .mass_kg = number_in(arguments, "--mass", body.mass_kg, "kg", of_body),
        .wheelbase_m = number_in(arguments, "--wheelbase", body.wheelbase_m, "m", of_body),
        .body = body,
        .mount = arguments.choice("--mount") == "fixed" ? SensorMount::fixed : SensorMount::holder};
    if (arguments.value("--front-share")) {
        known.front_share = number_in(arguments, "--front-share", {35, 70}, "%", "") / 100;
    }
    if (const auto size = arguments.value("--tyres")) {
        known.tyres = parse_tyre_size(*size);
        if (!known.tyres) {
            throw UsageError{fmt::format("--tyres is {}, expected a size as on the tyre: 205/55R16",
                                         in_quotes(*size))};
        }
    }
    if (const auto place = arguments.numbers("--sensor", 2)) {
        const ValueRange behind_m{-1, known.wheelbase_m + 1};
        constexpr ValueRange left_m{-1, 1};
        if (!behind_m.contains((*place)[0]) || !left_m.contains((*place)[1])) {
            throw UsageError{fmt::format("--sensor is {},{}, expected {} to {} m behind the front "
                                         "axle and {} to {} m left of the middle",
                                         (*place)[0],
                                         (*place)[1],
                                         behind_m.min,
                                         behind_m.max,
                                         left_m.min,
                                         left_m.max)};
        }
        known.sensor_behind_front_axle_m = (*place)[0];
        known.sensor_left_m = (*place)[1];
    }
    return known;
}

std::string name_of_new(const Arguments& arguments, const std::optional<fs::path>& output) {
    const auto stem = output ? output->stem().string() : "";
    const bool is_plain = std::ranges::none_of(stem, [](unsigned char c) { return c < 0x20; });
    const auto name = parse_vehicle_id(arguments).value_or(is_plain ? stem : "");
    if (name.empty()) {
        throw UsageError{"expected -o FILE.toml or --vehicle-id NAME: what the car is called"};
    }
    if (built_in_vehicle(name) != nullptr) {
        throw UsageError{fmt::format("{} is a built-in car, expected another name: -o FILE.toml or "
                                     "--vehicle-id NAME",
                                     in_quotes(name))};
    }
    return name;
}

/// Returns what the owner said, as the first line of the file.
std::string origin_of(const Arguments& arguments) {
    std::string words;
    for (const auto option : owner_options) {
        if (const auto value = arguments.value(option)) {
            words += fmt::format(" {} {}", option, *value);
        }
    }
    return words;
}

void add_vehicle(const Arguments& arguments, const Console& console) {
    const auto output = arguments.value("--output");
    if (arguments.value("--format") || arguments.flag("--json") || arguments.value("--vehicles")) {
        throw UsageError{"--format, --json and --vehicles do not belong to 'vehicles add', which "
                         "writes TOML"};
    }
    if (output && fs::path{*output}.extension() != ".toml") {
        throw UsageError{fmt::format("-o is '{}', expected a name that ends in .toml", *output)};
    }
    const auto vehicle = vehicle_of(parse_owners_data(arguments), name_of_new(arguments, output));
    if (output) {
        refuse_to_replace(*output, {});
    }
    RowOutput file{output};
    print(fmt::format(
        "# Estimated by 'macadam vehicles add{}'.\n"
        "# The values are usual for such cars, the uncertainties how much cars of one "
        "kind differ. Sources:\n"
        "# docs/reference/vehicles.md. Replace what you know better; 'macadam identify' "
        "finds it from a drive.\n{}",
        origin_of(arguments),
        vehicle_text(vehicle)));
    file.commit();
    const double generic_sd = untuned_iri_sd(*built_in_vehicle("generic"), true);
    console.say(fmt::format("{}: a pass is uncertain by {:.0f} % of the IRI because of the car "
                            "('generic': {:.0f} %)",
                            vehicle.name,
                            100 * untuned_iri_sd(vehicle, true),
                            100 * generic_sd));
}

void expect_no_data_of_owner(const Arguments& arguments) {
    std::vector<std::string_view> names{owner_options.begin(), owner_options.end()};
    names.emplace_back("--vehicle-id");
    for (const auto option : names) {
        if (arguments.value(option)) {
            throw UsageError{fmt::format("{} requires 'macadam vehicles add'", option)};
        }
    }
}

void run_vehicles(const Arguments& arguments, const Console& console) {
    const auto& cars = arguments.operands("CAR"); // at most one
    const auto car = cars.empty() ? std::string{} : cars.front();
    if (car == add_word) {
        add_vehicle(arguments, console);
        return;
    }
    expect_no_data_of_owner(arguments);
    const auto format = row_format_of(arguments);
    const auto file = row_file_of(arguments);
    if (file) {
        refuse_to_replace(*file, files_read(car, arguments));
    }
    RowOutput output{file};
    if (car.empty()) {
        print_words(vehicles_text(asked_vehicles(arguments), format));
    } else {
        const auto vehicle = asked_vehicle(car, arguments);
        print_words(parameters_text(vehicle, format));
        for (const auto& sentence : implausible_in(vehicle)) {
            console.warn(fmt::format("{}: {}", vehicle.name, sentence));
        }
    }
    output.commit();
}

constexpr std::array operands{
    Operand{.name = "CAR",
            .help = "Show this car: a built-in name, a name in --vehicles, or a TOML file. add: "
                    "make a vehicle file.",
            .optional = true,
            .choices = "add|golden-car|audi-a6-etron|generic|small-car|suv|van"}};

constexpr std::array options{
    Option{"--vehicles", "DIR", "The cars of a folder of TOML files instead of the built-in ones."},
    one_of("table|json|csv",
           {"--format", "FORMAT", "Format of the rows; otherwise by the suffix of -o.", "table"}),
    row_output_option,
    json_option,
    in_group(of_add,
             {"--mass", "KG", "Kerb mass, as in the registration papers; add a usual load."}),
    in_group(of_add, {"--wheelbase", "METRES", "Distance between the axles."}),
    in_group(of_add,
             one_of("small|compact|saloon|estate|suv|van|pickup",
                    {"--body", "BODY", "small, compact, saloon, estate, suv, van or pickup."})),
    in_group(of_add, {"--tyres", "SIZE", "Size as on the tyre, such as 205/55R16."}),
    in_group(of_add,
             {"--front-share", "PERCENT", "Share of the mass on the front axle.", "by --body"}),
    in_group(of_add,
             {"--sensor",
              "X,Y",
              "Place of the sensor: metres behind the front axle, metres left of the middle.",
              "on the dashboard"}),
    in_group(of_add,
             one_of("holder|fixed",
                    {"--mount",
                     "MOUNT",
                     "holder (of a phone) or fixed (screwed or taped to the car).",
                     "holder"})),
    in_group(of_add,
             {"--vehicle-id", "NAME", "Name of the car in its trips.", "the name of the file"})};

} // namespace

const Command vehicles_command{
    .name = "vehicles",
    .summary = "List the known cars, show one, or make one from what its owner knows",
    .about = "Without CAR, lists the built-in cars, or those of a folder: mass, wheelbase, natural "
             "frequencies of body and\n"
             "wheels, damping, and by how much a pass over a road is uncertain because of the car "
             "(IRI +-). With CAR, its\n"
             "parameters. 'vehicles add' estimates all parameters of a car, each with its "
             "uncertainty, from mass, wheelbase\n"
             "and body, and writes a vehicle file: better than an average car, worse than "
             "'macadam identify'.",
    .example = "  macadam vehicles --format csv\n"
               "  macadam vehicles generic\n"
               "  macadam vehicles add --mass 1430 --wheelbase 2.62 --body compact -o golf.toml\n"
               "  macadam import roads.gpkg trips/ --vehicle golf.toml --vehicle-id golf",
    .operands = operands,
    .options = options,
    .run = run_vehicles};

} // namespace macadam
