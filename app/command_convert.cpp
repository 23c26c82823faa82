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
#include <utility>

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

/// A name with another ending may be meant as a file: a folder of that name would surprise.
void expect_file_or_folder(const fs::path& output) {
    if (!names_a_file(output) && output.has_extension() && output.has_filename() &&
        !fs::is_directory(output)) {
        throw UsageError{fmt::format("-o is '{}', expected a name that ends in {}, or a folder (if "
                                     "it is new and has a dot in its name, with a '/' at its end)",
                                     output.string(),
                                     fmt::join(suffixes, ", "))};
    }
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
    expect_file_or_folder(*output);
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

std::string without_suffix(const std::string& name) {
    for (const std::string_view suffix : {".trip.csv.gz",
                                          ".trip.csv.zst",
                                          ".trip.csv",
                                          ".rawlog",
                                          ".gpx.gz",
                                          ".gpx.zst",
                                          ".gpx",
                                          ".zip",
                                          ".csv"}) {
        if (name.ends_with(suffix) && name.size() > suffix.size()) {
            return name.substr(0, name.size() - suffix.size());
        }
    }
    return name;
}

/// Where a trip lies below the path that was asked for, without suffixes: folders and archives
/// become folders.
fs::path place_below(const fs::path& asked, const TripSource& trip) {
    const auto name = fs::path{trip.name()}.lexically_normal();
    auto below = name.lexically_relative(asked.lexically_normal() / "");
    if (below.empty() || below == "." || *below.begin() == "..") {
        below = (name.has_filename() ? name : name.parent_path()).filename();
    }
    fs::path place;
    for (const auto& part : below) {
        if (!part.empty()) {
            place /= without_suffix(part.string());
        }
    }
    return place;
}

/// The trips of the paths that were asked for, each with its path, and why others have none.
struct Found {
    std::vector<std::pair<fs::path, TripSource>> trips;
    std::vector<std::string> refused;
};

Found trips_of(const ConvertOptions& options) {
    Found all;
    for (const auto& path : options.trips) {
        try {
            const auto trips = find_tracks(path, options.mapping).trips;
            if (trips.empty()) {
                throw InputError{fmt::format("{}: holds no trip", path.string())};
            }
            for (const auto& trip : trips) {
                all.trips.emplace_back(path, trip);
            }
        } catch (const InputError& error) {
            if (options.trips.size() == 1) {
                throw;
            }
            all.refused.emplace_back(error.what());
        }
    }
    return all;
}

/// What there is to do, and why the rest of what was asked for cannot be.
struct Tasks {
    std::vector<Task> tasks;
    std::vector<std::string> refused;
};

Tasks tasks_of(const ConvertOptions& options) {
    auto found = trips_of(options);
    if (names_a_file(options.output)) {
        if (found.trips.size() != 1) {
            throw InputError{fmt::format("{}: is one file, expected a folder for {} trips",
                                         options.output.string(),
                                         found.trips.size())};
        }
        return {{{found.trips.front().second, options.output}}, std::move(found.refused)};
    }
    Tasks all{{}, std::move(found.refused)};
    std::map<fs::path, std::string> taken;
    for (const auto& [asked, trip] : found.trips) {
        auto output = options.output / place_below(asked, trip);
        output += options.suffix;
        const auto [other, is_new] = taken.try_emplace(output, trip.name());
        if (is_new) {
            all.tasks.push_back({trip, output});
        } else {
            all.refused.push_back(
                fmt::format("{}: would be written twice, of {} and of {}; the second is left out",
                            output.string(),
                            other->second,
                            trip.name()));
        }
    }
    return all;
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

void make_folder(const fs::path& folder) {
    std::error_code failure;
    fs::create_directories(folder, failure);
    if (failure) {
        throw InputError{fmt::format("{}: cannot be made: {}", folder.string(), failure.message())};
    }
}

void convert(const Task& task, const ConvertOptions& options, const Console& console) {
    const TripNeeds all{.acc = true, .gyro = true, .speed = true, .fixes = true, .columns = {}};
    const auto& stop = console.stop();
    const auto trip = read_trip(task.trip, all, console.progress("reading"));
    if (!names_a_file(options.output)) {
        make_folder(task.output.parent_path());
    }
    const bool rawlog = task.output.extension() == rawlog_suffix;
    const auto written = rawlog ? write_rawlog(trip, task.output, options.level, stop)
                                : write_trip(trip, task.output, options.level, stop);
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

/// \returns how many could not be converted.
std::size_t convert_all(const Tasks& all, const ConvertOptions& options, const Console& console) {
    std::size_t failed = all.refused.size();
    for (std::size_t done = 0; done < all.tasks.size(); ++done) {
        try {
            convert(all.tasks[done], options, console);
        } catch (const InputError& error) {
            if (console.stop().stop_requested()) {
                throw InputError{fmt::format("interrupted: {} of {} were not converted",
                                             all.tasks.size() - done,
                                             counted(all.tasks.size(), "trip"))};
            }
            if (all.tasks.size() + all.refused.size() == 1) {
                throw;
            }
            ++failed;
            console.warn(error.what());
        }
    }
    return failed;
}

void run_convert(const Arguments& arguments, const Console& console) {
    const auto options = parse_convert(arguments);
    const auto all = tasks_of(options);
    for (const auto& why : all.refused) {
        console.warn(why);
    }
    std::vector<fs::path> inputs;
    inputs.reserve(all.tasks.size());
    for (const auto& task : all.tasks) {
        inputs.push_back(task.trip.file);
    }
    for (const auto& task : all.tasks) {
        refuse_to_replace(task.output, inputs);
    }
    if (const auto failed = convert_all(all, options, console); failed > 0) {
        const auto trips = all.tasks.size() + all.refused.size();
        throw InputError{fmt::format(
            "{} of {} could not be converted{}",
            failed,
            counted(trips, "trip"),
            failed == trips ? std::string{}
                            : fmt::format("; the others are in {}", options.output.string()))};
    }
}

constexpr std::array operands{Operand{
    "TRIP", "Trips in any format that 'import' reads: files, folders of them, archives.", true}};

constexpr std::array options{
    Option{"-o,--output",
           "FILE|DIR",
           "A file (.trip.csv, .trip.csv.gz, .trip.csv.zst, .rawlog), or a folder for any number."},
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
