#include "app/import/trip_inputs.hpp"

#include "estimator/common/error.hpp"
#include "storage/trips/source/trip_contents.hpp"
#include "storage/trips/trip_file_names.hpp"

#include <fmt/format.h>

#include <memory>
#include <utility>

namespace macadam {

std::size_t max_members_of(const Arguments& arguments) {
    constexpr std::int64_t most = 100'000'000;
    const auto count = arguments.integer("--max-members").value_or(std::int64_t{max_archive_files});
    if (count < 1 || count > most) {
        throw UsageError{fmt::format("--max-members is {}, expected 1 to {}", count, most)};
    }
    return static_cast<std::size_t>(count);
}

AskedTrips::AskedTrips(const std::vector<std::filesystem::path>& paths,
                       const TripWalkConfig& config,
                       const Console& console)
    : config_{config} {
    auto walking = config;
    walking.search = console.progress("looking for logs", {.name = "file"});
    for (const auto& path : paths) {
        Path asked{.path = path, .walk = {}, .refusal = {}};
        try {
            asked.walk.emplace(path, walking);
            if (asked.walk->count()) {
                tell(asked, console);
                asked.is_reported = true;
            }
        } catch (const InputError& error) {
            asked.refusal = error.what();
        }
        recount({.at_least = 0}, count_of(asked));
        paths_.push_back(std::move(asked));
    }
}

void AskedTrips::add(std::filesystem::path name, FileMaker make) {
    Path asked{.path = std::move(name), .walk = {}, .refusal = {}, .make = std::move(make)};
    recount({.at_least = 0}, count_of(asked));
    paths_.push_back(std::move(asked));
}

void AskedTrips::make_file(Path& path) const {
    try {
        path.held = path.make();
        path.walk.emplace(*path.held, config_);
    } catch (const InputError& error) {
        path.refusal = error.what();
    }
    path.make = {};
}

AskedTrips::Count AskedTrips::count_of(const Path& path) {
    if (!path.walk) {
        return {.at_least = 1,
                .unknown = path.make && is_archive_name(path.path.string()) ? 1U : 0};
    }
    const auto count = path.walk->count();
    return {.at_least = count.value_or(path.walk->given() + 1), .unknown = count ? 0U : 1U};
}

void AskedTrips::recount(const Count& before, const Count& after) {
    const std::scoped_lock counting{counting_};
    count_.at_least += after.at_least - before.at_least;
    count_.unknown += after.unknown - before.unknown;
}

std::optional<TripSource> AskedTrips::next() {
    const std::scoped_lock lock{asking_};
    for (; at_ < paths_.size(); ++at_) {
        auto& asked = paths_[at_];
        const auto before = count_of(asked);
        if (asked.make) {
            make_file(asked);
        }
        auto trip = asked.walk ? asked.walk->next() : std::nullopt;
        recount(before, count_of(asked));
        if (!asked.walk) {
            ++at_;
            return TripSource{.file = asked.path,
                              .member = {},
                              .contents = std::make_shared<const TripContents>(
                                  TripContents{{{"", "", asked.refusal}}})};
        }
        if (trip) {
            trip->held = asked.held;
            return trip;
        }
        asked.held.reset();
    }
    return std::nullopt;
}

std::optional<std::size_t> AskedTrips::count() const {
    const std::scoped_lock lock{counting_};
    return count_.unknown > 0 ? std::nullopt : std::optional{count_.at_least};
}

std::size_t AskedTrips::at_least() const {
    const std::scoped_lock lock{counting_};
    return count_.at_least;
}

void AskedTrips::tell(const Path& path, const Console& console) {
    const auto& walk = *path.walk;
    if (walk.count() == std::size_t{0}) {
        console.warn(fmt::format(
            "{}: contains no trip log (*.trip.csv, *.trip.csv.gz, *.trip.csv.zst, *.rawlog) "
            "and no export of phyphox or Sensor Logger; for other files see 'macadam inspect'",
            path.path.string()));
    }
    if (const auto others = walk.other_files(); others > 0) {
        console.say(fmt::format("{}: {} ignored: {}{}",
                                path.path.string(),
                                counted(others, "file"),
                                walk.first_other_file(),
                                others > 1 ? fmt::format(" and {} more", others - 1) : ""));
    }
}

void AskedTrips::tell_rest(const Console& console) const {
    for (const auto& path : paths_) {
        if (path.walk && !path.is_reported) {
            tell(path, console);
        }
    }
}

} // namespace macadam
