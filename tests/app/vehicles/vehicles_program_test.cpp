// Cars as users list, show and make them.

#include "app/pipeline/vehicle_lookup.hpp"
#include "estimator/vehicle/vehicle.hpp"
#include "storage/settings/vehicle_file.hpp"
#include "support/program/places.hpp"
#include "support/program/program.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

std::vector<std::string> add(std::vector<std::string> more) {
    std::vector<std::string> words{
        "vehicles", "add", "--mass", "1430", "--wheelbase", "2.62", "--body", "compact"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

TEST(VehiclesCommand, ListsTheBuiltInCarsAsTheHelpOfVehicleNamesThem) {
    const auto list = run_macadam({"vehicles"});
    EXPECT_EQ(list.exit_status, 0) << list.err;
    EXPECT_THAT(list.out, AllOf(HasSubstr("name "), HasSubstr("mass kg"), HasSubstr("stands for")));
    ASSERT_EQ(built_in_vehicles().size(), 6U);
    for (const auto& vehicle : built_in_vehicles()) {
        EXPECT_THAT(list.out, HasSubstr("\n" + vehicle.name + " "));
        EXPECT_THAT(std::string{vehicle_option.help}, HasSubstr(vehicle.name));
    }
}

TEST(VehiclesCommand, GivesTheSameRowsAsCsvAndJson) {
    const auto csv = run_macadam({"vehicles", "--format", "csv"}).out;
    EXPECT_THAT(csv,
                StartsWith("name,mass_kg,wheelbase_m,bounce_hz,bounce_damping,hop_hz,"
                           "iri_relative_sd,stands_for\n"));
    EXPECT_EQ(std::ranges::count(csv, '\n'), 7);
    EXPECT_THAT(run_macadam({"vehicles", "--json"}).out,
                HasSubstr("{\"name\":\"golden-car\",\"mass_kg\":1150,\"wheelbase_m\":null,"));
    const auto file = fresh_folder() / "cars.csv";
    EXPECT_EQ(run_macadam({"vehicles", "-o", file.string()}).out, "");
    EXPECT_EQ(read_file(file), csv);
}

TEST(VehiclesCommand, ShowsTheParametersOfACarWithUnitAndUncertainty) {
    const auto shown = run_macadam({"vehicles", "generic"});
    EXPECT_EQ(shown.exit_status, 0) << shown.err;
    EXPECT_THAT(shown.out,
                HasSubstr("ms_kg                 1500 kg      15 %  sprung mass, whole car\n"));
    EXPECT_THAT(shown.out, HasSubstr("bounce_hz "));
    EXPECT_EQ(shown.err, "");
    EXPECT_THAT(run_macadam({"vehicles", "generic", "--json"}).out,
                HasSubstr("{\"parameter\":\"ms_kg\",\"value\":1500,\"unit\":\"kg\","
                          "\"relative_sd\":0.15,\"meaning\":\"sprung mass, whole car\"}"));
}

TEST(VehiclesCommand, SaysWhatNoCarHas) {
    const auto file = fresh_folder() / "odd.toml";
    write_file(file,
               "name = \"odd\"\n[half_car]\nms_kg = 350\nmu_kg = 45\nks_n_per_m = 30000\n"
               "cs_ns_per_m = 2500\nkt_n_per_m = 2500000\nis_kgm2 = 500\nl_m = 1.5\n");
    const auto shown = run_macadam({"vehicles", file.string()});
    EXPECT_EQ(shown.exit_status, 0);
    EXPECT_THAT(shown.err,
                HasSubstr("odd: wheel hop is 37.2 Hz, usual are 8 to 18 Hz: check mu_kg"));
    EXPECT_THAT(shown.err,
                HasSubstr("odd: track width is 3 m, usual are 1.1 to 2.2 m: l_m is half"));
}

TEST(VehiclesCommand, NeverReplacesARoadDatabaseOrTheCarItReads) {
    const auto folder = fresh_folder();
    const auto store = (folder / "roads.gpkg").string();
    ASSERT_EQ(
        run_macadam(
            {"init", store, "--network", source_folder() + "/sample_data/fleet/network.osm.pbf"})
            .exit_status,
        0);
    const auto refused = run_macadam({"vehicles", "--format", "csv", "-o", store});
    EXPECT_EQ(refused.exit_status, 1);
    EXPECT_THAT(refused.err, HasSubstr("roads.gpkg: is a road database, expected another file"));

    const auto car = (folder / "golf.toml").string();
    ASSERT_EQ(run_macadam(add({"-o", car})).exit_status, 0);
    const auto before = read_file(car);
    const auto of_file = run_macadam({"vehicles", car, "--format", "csv", "-o", car});
    EXPECT_THAT(of_file.err, HasSubstr("golf.toml: is also an input"));
    const auto of_folder =
        run_macadam({"vehicles", "--vehicles", folder.string(), "--format", "csv", "-o", car});
    EXPECT_THAT(of_folder.err, HasSubstr("golf.toml: is also an input"));
    EXPECT_EQ(read_file(car), before);
}

TEST(VehiclesCommand, RefusesUnknownCarsWithTheNearestName) {
    const auto refused = [](const std::vector<std::string>& words) {
        const auto run = run_macadam(words);
        EXPECT_EQ(run.exit_status, 2) << run.err;
        return run.err;
    };
    EXPECT_THAT(refused({"vehicles", "generik"}),
                HasSubstr("unknown car 'generik'; did you mean generic?"));
    EXPECT_THAT(refused({"vehicles", "trabant"}), HasSubstr("'macadam vehicles' lists all"));
    EXPECT_THAT(refused({"vehicles", "--mass", "1430"}),
                HasSubstr("requires 'macadam vehicles add'"));
}

TEST(VehiclesCommand, MakesAFileOfWhatTheOwnerKnowsWhichIsThenListedAndShown) {
    const auto folder = fresh_folder();
    const auto file = (folder / "golf.toml").string();
    const auto made = run_macadam(add({"--tyres", "205/55R16", "-o", file}));
    EXPECT_EQ(made.exit_status, 0) << made.err;
    EXPECT_THAT(made.err, HasSubstr("golf: a pass is uncertain by "));
    EXPECT_THAT(read_file(file),
                StartsWith("# Estimated by 'macadam vehicles add --mass 1430 --wheelbase 2.62 "
                           "--body compact --tyres 205/55R16'.\n"));
    EXPECT_THAT(read_file(file), HasSubstr("docs/reference/vehicles.md"));
    const auto vehicle = read_vehicle(file);
    EXPECT_EQ(vehicle.name, "golf");
    EXPECT_EQ(vehicle.axles->wheelbase_m, 2.62);
    EXPECT_THAT(run_macadam({"vehicles", "--vehicles", folder.string()}).out,
                HasSubstr("trips with vehicle_id golf"));
    const auto shown = run_macadam({"vehicles", "golf", "--vehicles", folder.string()});
    EXPECT_EQ(shown.err, "");
    EXPECT_EQ(run_macadam({"vehicles", file}).out, shown.out);
}

TEST(VehiclesCommand, RefusesWhatNoSuchCarHasWithTheRange) {
    const auto refused = [](std::vector<std::string> words) {
        const auto run = run_macadam(words);
        EXPECT_EQ(run.exit_status, 2) << run.err;
        return run.err;
    };
    const auto file = (fresh_folder() / "golf.toml").string();
    const std::vector<std::string> begin{"vehicles", "add", "-o", file};
    const auto with = [&](const std::vector<std::string>& more) {
        auto words = begin;
        words.insert(words.end(), more.begin(), more.end());
        return words;
    };
    EXPECT_THAT(refused(with({"--mass", "1.43", "--wheelbase", "2.62", "--body", "compact"})),
                HasSubstr("--mass is 1.43, expected 800 to 2200 kg for --body compact"));
    EXPECT_THAT(refused(with({"--mass", "1430", "--wheelbase", "2620", "--body", "compact"})),
                HasSubstr("--wheelbase is 2620, expected 2.35 to 2.9 m for --body compact"));
    EXPECT_THAT(refused(with({"--mass", "1430", "--wheelbase", "2.62"})),
                HasSubstr("--body is missing, expected small, compact, saloon, estate, suv, van"));
    EXPECT_THAT(refused(with({"--body", "compact", "--wheelbase", "2.62"})),
                HasSubstr("--mass is missing"));
    EXPECT_THAT(refused(add({"-o", file, "--tyres", "round"})),
                HasSubstr("--tyres is 'round', expected a size as on the tyre: 205/55R16"));
    EXPECT_THAT(refused(add({"-o", file, "--sensor", "1200,0"})),
                HasSubstr("--sensor is 1200,0, expected -1 to 3.62 m behind the front axle"));
    EXPECT_THAT(refused(add({"-o", file, "--front-share", "0.6"})),
                HasSubstr("--front-share is 0.6, expected 35 to 70 %"));
    EXPECT_THAT(refused(add({"-o", file + ".csv"})),
                HasSubstr("expected a name that ends in .toml"));
    EXPECT_THAT(refused(add({})), HasSubstr("expected -o FILE.toml or --vehicle-id NAME"));
    EXPECT_THAT(refused(add({"--vehicle-id", "suv"})), HasSubstr("'suv' is a built-in car"));
    EXPECT_FALSE(fs::exists(file));
}

} // namespace
} // namespace macadam::testing
