#include "app/cli/commands.hpp"
#include "app/cli/overwrite_guard.hpp"
#include "app/cli/row_output.hpp"
#include "app/database/lock_wait_messages.hpp"
#include "app/database/publication_messages.hpp"
#include "app/database/segment_options.hpp"
#include "app/database/server_store.hpp"
#include "app/output/units_option.hpp"
#include "app/store/calibration_output.hpp"

#include "estimator/common/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>
#include <string_view>

namespace macadam {
namespace {

CalibrationReport calibrated(const std::filesystem::path& file, bool keep, const Console& console) {
    if (!keep) {
        const auto store = opened_reader(file, console, Audience::operator_);
        warn_of_waiting(store, file, console);
        return store.estimate_calibration(console.progress("calibrating"));
    }
    auto store = opened_store(file, console);
    warn_of_waiting(store, file, console);
    return store.maintenance.calibrate(console.progress("calibrating"));
}

void write_rows(const CalibrationReport& report,
                std::string_view format,
                UnitSystem units,
                const std::optional<std::filesystem::path>& file) {
    RowOutput output{file};
    if (format == "table") {
        print_words(text_of(report, units));
    } else {
        print(format == "json" ? json_of(report, units) : csv_of(report, units));
    }
    output.commit();
}

void run_calibrate(const Arguments& arguments, const Console& console) {
    const auto file = file_or_server(arguments);
    const auto format = row_format_of(arguments);
    const auto output = row_file_of(arguments);
    if (output) {
        refuse_to_replace(*output, {file});
    }
    const bool keep = !arguments.flag("--dry-run");
    expect_operator(opened_reader(file, console, Audience::operator_),
                    "calibrations of single cars");
    const auto report = calibrated(file, keep, console);
    write_rows(report, format, parse_units(arguments), output);
    const bool any = std::ranges::any_of(
        report.cars, [](const CalibratedCar& car) { return car.calibration.has_value(); });
    if (!any) {
        throw InputError{fmt::format("{}: no car could be calibrated: each needs 50 segments "
                                     "that other cars passed within a year, and a vehicle_id "
                                     "in its trips; the database is unchanged",
                                     file.string())};
    }
    console.say(keep ? fmt::format("generation {}: all segments were fused with this "
                                   "calibration",
                                   report.generation)
                     : std::string{"the database is unchanged (--dry-run)"});
}

constexpr std::array operands{import_operand};
constexpr std::array options{
    Option{"--dry-run",
           "",
           "Only report: leave the database "
           "unchanged."},
    one_of("table|csv|json",
           {"--format", "NAME", "table, csv (a row for each car) or json.", "table"}),
    row_output_option,
    json_option,
    units_option};

} // namespace

const Command calibrate_command{
    .name = "calibrate",
    .summary = "Calibrate each car against other cars on the same roads",
    .about = "Estimates a gain and an offset for each car, and how much cars, trips and passes "
             "vary, and fuses all\n"
             "passes again with them: a new generation, in one transaction. Until it is "
             "committed, readers see the old\n"
             "values and imports continue; they wait only for the final write. The calibration "
             "applies until the next\n"
             "one, also to new trips. The mean of all cars is assumed to be right; its "
             "possible bias is part of every\n"
             "interval.",
    .example = "  macadam calibrate roads.gpkg --dry-run      preview of the result\n"
               "  macadam calibrate roads.gpkg\n"
               "  macadam info roads.gpkg --audit             past operations",
    .operands = operands,
    .options = options,
    .run = run_calibrate};

} // namespace macadam
