#include "app/commands.hpp"
#include "app/mapping_option.hpp"
#include "app/output_guard.hpp"

#include "estimator/common/error.hpp"
#include "storage/rawlog_reader.hpp"
#include "storage/rawlog_writer.hpp"
#include "storage/trip_reader.hpp"
#include "storage/trip_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <set>

namespace macadam {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 4> suffixes{
    ".trip.csv.gz", ".trip.csv", ".trip.csv.zst", rawlog_suffix};
constexpr std::int64_t usual_level = 6;

struct ConvertOptions {
    std::vector<fs::path> trips;
    fs::path output;
    std::string suffix; ///< of the files in a folder
    int level;
    std::shared_ptr<const TripMapping> mapping;
};

bool names_a_file(const fs::path& output) {
    const auto name = output.filename().string();
    return std::ranges::any_of(suffixes, [&](auto suffix) { return name.ends_with(suffix); });
}

ConvertOptions parse_convert(const Arguments& arguments) {
    const auto output = arguments.value("--output");
    if (!output) {
        throw UsageError{"-o FILE|DIR is missing"};
    }
    const auto level = arguments.integer("--level").value_or(usual_level);
    if (level < 1 || level > 9) {
        throw UsageError{fmt::format("--level is {}, expected 1 to 9", level)};
    }
    if (arguments.value("--to") && names_a_file(*output)) {
        throw UsageError{fmt::format("--to is for a folder, but -o is '{}'", *output)};
    }
    const auto& trips = arguments.operands("TRIP");
    return {.trips = {trips.begin(), trips.end()},
            .output = *output,
            .suffix = arguments.choice("--to", suffixes),
            .level = static_cast<int>(level),
            .mapping = mapping_of(arguments)};
}

/// A trip and where it goes.
struct Task {
    TripSource trip;
    fs::path output;
};

/// The name of a trip without folder and suffix.
std::string stem_of(const TripSource& trip) {
    auto name = fs::path{trip.name()};
    auto stem = (name.has_filename() ? name : name.parent_path()).filename().string();
    for (const std::string_view suffix :
         {".trip.csv.gz", ".trip.csv.zst", ".trip.csv", ".rawlog", ".zip", ".csv"}) {
        if (stem.ends_with(suffix) && stem.size() > suffix.size()) {
            return stem.substr(0, stem.size() - suffix.size());
        }
    }
    return stem;
}

std::vector<TripSource> trips_of(const ConvertOptions& options) {
    std::vector<TripSource> trips;
    for (const auto& path : options.trips) {
        const auto found = find_trips(path, options.mapping).trips;
        if (found.empty()) {
            throw InputError{fmt::format("{}: holds no trip", path.string())};
        }
        trips.insert(trips.end(), found.begin(), found.end());
    }
    return trips;
}

std::vector<Task> tasks_of(const ConvertOptions& options) {
    const auto trips = trips_of(options);
    if (names_a_file(options.output)) {
        if (trips.size() != 1) {
            throw InputError{fmt::format("{}: is one file, expected a folder for {} trips",
                                         options.output.string(),
                                         trips.size())};
        }
        return {{trips.front(), options.output}};
    }
    std::vector<Task> tasks;
    std::map<fs::path, std::string> taken;
    for (const auto& trip : trips) {
        const auto output = options.output / (stem_of(trip) + options.suffix);
        const auto [other, is_new] = taken.try_emplace(output, trip.name());
        if (!is_new) {
            throw InputError{fmt::format("{}: would be written twice, of {} and of {}",
                                         output.string(),
                                         other->second,
                                         trip.name())};
        }
        tasks.push_back({trip, output});
    }
    return tasks;
}

std::string not_kept(const TripLog& trip) {
    std::map<std::string, std::size_t> reasons;
    for (const auto row : trip.rows) {
        if (row >= static_cast<std::uint8_t>(RowReason::wrong_cell_count)) {
            ++reasons[name_of(static_cast<RowReason>(row))];
        }
    }
    std::string words;
    for (const auto& [reason, count] : reasons) {
        words +=
            fmt::format("{}{} {}", words.empty() ? "; without a sample: " : ", ", count, reason);
    }
    return words;
}

void convert(const Task& task, const ConvertOptions& options, const Console& console) {
    const TripNeeds all{.acc = true, .gyro = true, .speed = true, .fixes = true, .columns = {}};
    const auto trip = read_trip(task.trip, all, console.progress("reading"));
    const bool rawlog = task.output.extension() == rawlog_suffix;
    const auto written = rawlog ? write_rawlog(trip, task.output, options.level)
                                : write_trip(trip, task.output, options.level);
    console.say(fmt::format("{}: {} read, {} written{}",
                            task.output.string(),
                            counted(trip.rows.size(), "row"),
                            counted(written, rawlog ? "object" : "row"),
                            not_kept(trip)));
    if (!trip.unknown_columns.empty()) {
        console.warn(fmt::format("{}: columns that are not known were left out: {}",
                                 task.trip.name(),
                                 fmt::join(trip.unknown_columns, ", ")));
    }
}

void make_folder(const fs::path& folder) {
    std::error_code failure;
    fs::create_directories(folder, failure);
    if (failure) {
        throw InputError{fmt::format("{}: cannot be made: {}", folder.string(), failure.message())};
    }
}

void run_convert(const Arguments& arguments, const Console& console) {
    const auto options = parse_convert(arguments);
    const auto tasks = tasks_of(options);
    std::vector<fs::path> inputs;
    inputs.reserve(tasks.size());
    for (const auto& task : tasks) {
        inputs.push_back(task.trip.file);
    }
    for (const auto& task : tasks) {
        refuse_to_replace(task.output, inputs);
    }
    if (!names_a_file(options.output)) {
        make_folder(options.output);
    }
    std::size_t failed = 0;
    for (const auto& task : tasks) {
        try {
            convert(task, options, console);
        } catch (const InputError& error) {
            if (tasks.size() == 1) {
                throw;
            }
            ++failed;
            console.warn(error.what());
        }
    }
    if (failed > 0) {
        throw InputError{fmt::format("{} of {} could not be converted; the others are in {}",
                                     failed,
                                     counted(tasks.size(), "trip"),
                                     options.output.string())};
    }
}

constexpr std::array operands{Operand{
    "TRIP", "Trips in any format that 'import' reads: files, folders of them, archives.", true}};

constexpr std::array options{
    Option{"-o,--output",
           "FILE|DIR",
           "Where to: a file (.trip.csv, .trip.csv.gz, .trip.csv.zst, .rawlog) for one trip, or a "
           "folder."},
    Option{"--to", "SUFFIX", "What the files in a folder become.", ".trip.csv.gz"},
    Option{"--level", "N", "Of compression: 1 is fast, 9 small.", "6"},
    mapping_option};

} // namespace

const Command convert_command{
    .name = "convert",
    .summary = "Turn trips into native logs or rawlogs of MRPT",
    .about =
        "Every sample of every sensor that is read is written, with the head of the trip; rows "
        "that gave\n"
        "no sample are counted with their reasons. A file appears when it is whole. Of several "
        "trips, one\n"
        "that cannot be read does not stop the others; the exit status is then 1.",
    .example =
        "  macadam convert phone_export.zip -o drive.trip.csv.gz\n"
        "  macadam convert drive.rawlog -o drive.trip.csv        to look at\n"
        "  macadam convert trips/ -o rawlogs/ --to .rawlog       for RawLogViewer and others",
    .operands = operands,
    .options = options,
    .run = run_convert};

} // namespace macadam
