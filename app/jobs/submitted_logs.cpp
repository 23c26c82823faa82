#include "app/jobs/submitted_logs.hpp"

#include "estimator/common/ascii.hpp"
#include "estimator/common/error.hpp"
#include "storage/files/byte_stream.hpp"
#include "storage/files/sha256.hpp"
#include "storage/trips/trip_search.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string_view>

namespace macadam {
namespace {

namespace fs = std::filesystem;

/// Returns the end of a name from which readers know the format: the last suffix, with those of
/// "trip" and of compression. A longer or odd one is none.
std::string suffix_of(const fs::path& file) {
    constexpr std::size_t longest = 16;
    const auto name = in_lower_case(file.filename().string());
    auto at = name.rfind('.');
    for (const std::string_view outer : {".gz", ".zst"}) {
        if (at != std::string::npos && at > 0 && name.substr(at) == outer) {
            at = name.rfind('.', at - 1);
        }
    }
    constexpr std::string_view of_trips = ".trip";
    if (at != std::string::npos && at >= of_trips.size() &&
        name.substr(at - of_trips.size(), of_trips.size()) == of_trips) {
        at -= of_trips.size();
    }
    const auto suffix = at == std::string::npos ? std::string{} : name.substr(at);
    const bool is_plain =
        suffix.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789.") == std::string::npos;
    return is_plain && suffix.size() <= longest ? suffix : std::string{};
}

/// Several files that belong together are no object.
std::string refusal_of(const TripSource& source) {
    return source.contents == nullptr && (!source.files.empty() || !source.positions.empty())
               ? fmt::format("{}: consists of several files, expected one: a trip log made by "
                             "'macadam convert', or an archive",
                             source.name())
               : std::string{};
}

} // namespace

std::vector<SubmittedLog> logs_to_submit(const std::vector<std::string>& paths,
                                         const Console& console) {
    std::vector<SubmittedLog> logs;
    for (const fs::path path : paths) {
        if (!fs::is_directory(path)) {
            logs.push_back({.file = path});
            continue;
        }
        TripWalk walk{path, {.search = console.progress("searching")}};
        while (const auto source = walk.next()) {
            if (logs.empty() || logs.back().file != source->file) { // members of one archive
                logs.push_back({.file = source->file, .refusal = refusal_of(*source)});
            }
        }
        if (walk.other_files() > 0) {
            console.say(fmt::format("{}: {} no trips, such as {}",
                                    path.string(),
                                    counted(walk.other_files(), "file") +
                                        (walk.other_files() == 1 ? " is" : " are"),
                                    walk.first_other_file()));
        }
    }
    return logs;
}

Job job_of(const fs::path& file) {
    constexpr std::size_t block_bytes = 64 << 10;
    const auto from = file_bytes(file);
    const auto block = std::make_unique<std::array<char, block_bytes>>();
    Sha256 hash;
    Job job{.sha256 = {}, .suffix = suffix_of(file)};
    while (const auto count = from->read(*block)) {
        hash.add({block->data(), count});
        job.bytes += static_cast<std::int64_t>(count);
    }
    job.sha256 = hash.hex();
    return job;
}

} // namespace macadam
