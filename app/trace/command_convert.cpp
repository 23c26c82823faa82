#include "app/cli/commands.hpp"
#include "app/cli/overwrite_guard.hpp"
#include "app/import/trip_inputs.hpp"
#include "app/pipeline/column_mapping_option.hpp"
#include "app/pipeline/trip_preparation.hpp"

#include "estimator/common/error.hpp"
#include "storage/trips/log/trip_writer.hpp"
#include "storage/trips/rawlog/rawlog_reader.hpp"
#include "storage/trips/rawlog/rawlog_writer.hpp"
#include "storage/trips/trip_reader.hpp"
#include "storage/trips/trip_search.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <optional>
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
    std::string suffix; ///< suffix of the files in a folder
    int level;
    TripWalkConfig walk;
};

bool names_a_file(const fs::path& output) {
    const auto name = output.filename().string();
    return std::ranges::any_of(suffixes, [&](auto suffix) { return name.ends_with(suffix); });
}

/// Rejects other suffixes unless the folder exists: the user may have meant a file.
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
    if (arguments.value("--format") && names_a_file(*output)) {
        throw UsageError{fmt::format("--format requires a folder, but -o is '{}'", *output)};
    }
    expect_file_or_folder(*output);
    const auto& trips = arguments.operands("TRIP");
    return {.trips = {trips.begin(), trips.end()},
            .output = *output,
            .suffix = arguments.choice("--format"),
            .level = static_cast<int>(level),
            .walk = {.mapping = mapping_of(arguments),
                     .tracks = true,
                     .positions = arguments.value("--positions").value_or(""),
                     .max_files = max_members_of(arguments)}};
}

/// Trip and its output file.
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
                                          ".nmea",
                                          ".log",
                                          ".asc",
                                          ".mf4",
                                          ".h5",
                                          ".zip",
                                          ".csv"}) {
        if (name.ends_with(suffix) && name.size() > suffix.size()) {
            return name.substr(0, name.size() - suffix.size());
        }
    }
    return name;
}

/// Returns the path of a trip below the requested path, without suffixes; folders and archives
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

/// Requested paths with their trips, and the reasons why others have none.
struct Found {
    std::vector<std::pair<fs::path, TripWalk>> paths;
    std::vector<std::string> refused;

    /// Returns the number of trips; `std::nullopt` while an archive may hold more.
    std::optional<std::size_t> count() const {
        std::size_t sum = 0;
        for (const auto& [path, walk] : paths) {
            const auto count = walk.count();
            if (!count) {
                return std::nullopt;
            }
            sum += *count;
        }
        return sum;
    }

    std::vector<fs::path> files() const {
        std::vector<fs::path> all;
        for (const auto& [path, walk] : paths) {
            const auto files = walk.files();
            all.insert(all.end(), files.begin(), files.end());
        }
        return all;
    }
};

Found found_for(const ConvertOptions& options) {
    Found found;
    for (const auto& path : options.trips) {
        try {
            TripWalk walk{path, options.walk};
            if (walk.count() == std::size_t{0}) {
                throw InputError{fmt::format("{}: contains no trip", path.string())};
            }
            found.paths.emplace_back(path, std::move(walk));
        } catch (const InputError& error) {
            if (options.trips.size() == 1) {
                throw;
            }
            found.refused.emplace_back(error.what());
        }
    }
    return found;
}

/// Tasks in the order of the trips; those of archives become known as they are read.
class Tasks {
public:
    Tasks(const ConvertOptions& options, const Console& console)
        : options_{options}, console_{console}, found_{found_for(options)}, inputs_{
                                                                                found_.files()} {
        for (const auto& why : found_.refused) {
            refuse(why);
        }
    }

    /// Returns the next task; `std::nullopt` at the end.
    ///
    /// \throws InputError  if the output is one file and there is not exactly one trip.
    std::optional<Task> next() {
        if (!names_a_file(options_.output)) {
            return next_of_any();
        }
        return std::exchange(gave_only_, true) ? std::nullopt : std::optional{only()};
    }

    /// Number of trips; `std::nullopt`: not known.
    std::optional<std::size_t> count() const { return found_.count(); }
    std::size_t tasks() const { return tasks_; } ///< so far
    std::size_t refused() const { return refused_; }
    const std::vector<fs::path>& inputs() const { return inputs_; } ///< files that are read

private:
    std::optional<Task> next_of_any() {
        while (at_ < found_.paths.size()) {
            auto& [asked, walk] = found_.paths[at_];
            auto trip = walk.next();
            if (!trip) {
                ++at_;
                expect_some(walk, asked);
            } else if (auto task = task_for(asked, *trip)) {
                ++tasks_;
                return task;
            }
        }
        return std::nullopt;
    }

    Task only() {
        auto task = next_of_any();
        while (!found_.count() && next_of_any()) {
        }
        if (const auto count = found_.count(); count != std::size_t{1}) {
            throw InputError{fmt::format("{}: is one file, expected a folder for {} trips",
                                         options_.output.string(),
                                         *count)};
        }
        return std::move(*task);
    }

    void expect_some(const TripWalk& walk, const fs::path& asked) {
        if (walk.given() == 0) {
            const auto words = fmt::format("{}: contains no trip", asked.string());
            if (options_.trips.size() == 1) {
                throw InputError{words};
            }
            refuse(words);
        }
    }

    void refuse(const std::string& why) {
        ++refused_;
        console_.warn(why);
    }

    std::optional<Task> task_for(const fs::path& asked, const TripSource& trip) {
        if (names_a_file(options_.output)) {
            return Task{trip, options_.output};
        }
        auto output = options_.output / place_below(asked, trip);
        output += options_.suffix;
        const auto [other, is_new] = taken_.try_emplace(output, trip.name());
        if (is_new) {
            return Task{trip, output};
        }
        refuse(fmt::format("{}: would be written twice, from {} and from {}; the second is "
                           "skipped",
                           output.string(),
                           other->second,
                           trip.name()));
        return std::nullopt;
    }

    const ConvertOptions& options_;
    const Console& console_;
    Found found_;
    std::vector<fs::path> inputs_;
    std::size_t at_ = 0;
    std::map<fs::path, std::string> taken_;
    std::size_t tasks_ = 0;
    std::size_t refused_ = 0;
    bool gave_only_ = false;
};

std::string not_kept(const TripLog& trip) {
    std::map<std::string, std::size_t> reasons;
    for (const auto row : trip.rows) {
        if (row >= code(RowReason::wrong_cell_count)) {
            ++reasons[name_of(static_cast<RowReason>(row))];
        }
    }
    std::string words;
    for (const auto& [reason, count] : reasons) {
        words += fmt::format("{}{} {}", words.empty() ? "; skipped: " : ", ", count, reason);
    }
    return words;
}

void make_folder(const fs::path& folder) {
    std::error_code failure;
    fs::create_directories(folder, failure);
    if (failure) {
        throw InputError{
            fmt::format("{}: cannot be created: {}", folder.string(), failure.message())};
    }
}

void convert(const Task& task, const ConvertOptions& options, const Console& console) {
    const TripNeeds all{.acc = true, .gyro = true, .speed = true, .fixes = true};
    const auto& stop = console.stop();
    const auto trip = read_trip(task.trip, all, console.progress("reading"));
    for (const auto& words : reading_notes(trip.meta)) {
        console.say(fmt::format("{}: {}", task.trip.name(), words));
    }
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
        console.warn(fmt::format("{}: unknown columns ignored: {}",
                                 task.trip.name(),
                                 fmt::join(trip.unknown_columns, ", ")));
    }
}

/// Converts all trips.
/// \returns  number of trips that could not be converted
std::size_t convert_all(Tasks& tasks, const ConvertOptions& options, const Console& console) {
    std::size_t failed = 0;
    while (const auto task = tasks.next()) {
        refuse_to_replace(task->output, tasks.inputs());
        try {
            convert(*task, options, console);
        } catch (const InputError& error) {
            if (console.stop().stop_requested()) {
                const auto count = tasks.count();
                throw InputError{fmt::format(
                    "interrupted: {} were not converted",
                    count ? fmt::format(
                                "{} of {}", *count - tasks.tasks() + 1, counted(*count, "trip"))
                          : std::string{"the rest of the trips in archives"})};
            }
            if (tasks.count() == std::size_t{1} && tasks.refused() == 0) {
                throw;
            }
            ++failed;
            console.warn(error.what());
        }
    }
    return failed + tasks.refused();
}

void run_convert(const Arguments& arguments, const Console& console) {
    const auto options = parse_convert(arguments);
    Tasks tasks{options, console};
    if (const auto failed = convert_all(tasks, options, console); failed > 0) {
        const auto trips = tasks.tasks() + tasks.refused();
        throw InputError{fmt::format(
            "{} of {} could not be converted{}",
            failed,
            counted(trips, "trip"),
            failed == trips ? std::string{}
                            : fmt::format("; the others are in {}", options.output.string()))};
    }
}

constexpr std::array operands{
    Operand{"TRIP", "Trips in any format that 'import' reads: files, folders or archives.", true}};

constexpr std::array options{
    Option{"-o,--output",
           "FILE|DIR",
           "Output file (.trip.csv, .trip.csv.gz, .trip.csv.zst, .rawlog), or a folder for "
           "several trips."},
    formerly(
        "--to",
        one_of(".trip.csv.gz|.trip.csv|.trip.csv.zst|.rawlog",
               {"--format", "SUFFIX", "Format of files in an output folder.", ".trip.csv.gz"})),
    Option{"--level", "N", "Compression level: 1 is fast, 9 small.", "6"},
    max_members_option,
    mapping_option,
    positions_option};

} // namespace

const Command convert_command{
    .name = "convert",
    .summary = "Convert trips to Macadam logs or MRPT rawlogs",
    .about = "Writes every sample of every sensor, with the header of the trip; rows without a "
             "sample are counted by\n"
             "reason. A file appears only when it is complete. If one of several trips cannot be "
             "read, the others are\n"
             "still converted; the exit status is then 1.",
    .example =
        "  macadam convert phone_export.zip -o drive.trip.csv.gz\n"
        "  macadam convert drive.rawlog -o drive.trip.csv        to look at\n"
        "  macadam convert trips/ -o rawlogs/ --format .rawlog   for RawLogViewer and others",
    .operands = operands,
    .options = options,
    .run = run_convert};

} // namespace macadam
