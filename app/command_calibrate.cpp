#include "app/calibration_output.hpp"
#include "app/commands.hpp"
#include "app/publication_words.hpp"
#include "app/segment_options.hpp"
#include "app/store_patience.hpp"

#include "estimator/common/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace macadam {
namespace {

void run_calibrate(const Arguments& arguments, const Console& console) {
    const auto file = store_file(arguments);
    const bool keep = !arguments.flag("--dry-run");
    expect_operator(opened_store(file, RoadStore::Access::read, console, Reader::operator_),
                    "calibrations of single cars");
    auto store = opened_store(file,
                              keep ? RoadStore::Access::write : RoadStore::Access::read,
                              console,
                              Reader::operator_);
    warn_of_waiting(store, file, console);
    const auto progress = console.progress("calibrating");
    const auto report = store.calibrate(keep, progress);
    if (arguments.flag("--json")) {
        print(json_of(report));
    } else {
        print_words(text_of(report));
    }
    const bool any = std::ranges::any_of(
        report.cars, [](const CalibratedCar& car) { return car.calibration.has_value(); });
    if (!any) {
        throw InputError{fmt::format("{}: no car could be calibrated: each needs 50 segments that "
                                     "others passed within a year, and a vehicle_id in its trips; "
                                     "the store is as it was",
                                     file.string())};
    }
    console.say(keep ? fmt::format("generation {}: all segments were fused by these rules",
                                   report.generation)
                     : std::string{"nothing was changed (--dry-run)"});
}

constexpr std::array operands{store_operand};
constexpr std::array options{Option{"--dry-run", "", "Only tell: leave the store as it is."},
                             Option{"--json", "", "What was found as one JSON object."}};

} // namespace

const Command calibrate_command{
    .name = "calibrate",
    .summary = "Find how each car reads from what others read of the same roads",
    .about = "Gives each car a gain and an offset, and the fleet the spread of its cars, trips and "
             "passes, and fuses all\npasses anew by them: a new generation, in one transaction. "
             "Readers see the numbers of before until all are\nmade; imports go on meanwhile and "
             "wait only while they are put in place. These rules then hold until the\nnext "
             "calibration, also for new trips. The mean of the cars is taken to be right: how far "
             "it may be off is\npart of every interval.",
    .example = "  macadam calibrate roads.gpkg --dry-run      what would be found\n"
               "  macadam calibrate roads.gpkg\n"
               "  macadam info roads.gpkg --audit             what was done when",
    .operands = operands,
    .options = options,
    .run = run_calibrate};

} // namespace macadam
