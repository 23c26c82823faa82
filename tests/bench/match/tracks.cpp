#include "tracks.hpp"
#include "mapping/network/build_network.hpp"

#include "estimator/common/error.hpp"
#include "storage/networks/network_reader.hpp"
#include "storage/trips/trip_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <string_view>

namespace macadam::bench {
namespace {

constexpr std::string_view truth_suffix = ".truth.csv";
constexpr double jitter_s = 0.5; // of stamps: fixes each 5 s are not thinned to one each 10 s

NodePair pair_of(const std::string& line, const std::string& where) {
    NodePair pair;
    const char* end = line.data() + line.size();
    const auto first = std::from_chars(line.data(), end, pair.first);
    const auto* comma = first.ptr;
    if (first.ec != std::errc{} || comma == end || *comma != ',' ||
        std::from_chars(comma + 1, end, pair.second).ec != std::errc{}) {
        throw InputError{fmt::format("{}: '{}', expected two node ids", where, line)};
    }
    return pair;
}

std::vector<NodePair> read_truth(const std::filesystem::path& file) {
    std::ifstream in{file};
    std::vector<NodePair> truth;
    std::string line;
    std::getline(in, line); // the header
    for (int row = 2; std::getline(in, line); ++row) {
        truth.push_back(pair_of(line, fmt::format("{}:{}", file.string(), row)));
    }
    return truth;
}

Track read_track(const std::filesystem::path& folder, const std::string& name) {
    auto ways = read_network(folder / (name + ".osm.pbf"));
    auto roads = build_network(ways);
    return {name,
            std::move(ways),
            std::move(roads),
            read_trip({folder / (name + ".trip.csv"), ""}, needs_of_match()),
            read_truth(folder / (name + std::string{truth_suffix}))};
}

} // namespace

std::vector<Track> read_tracks(const std::filesystem::path& folder) {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator{folder}) {
        const auto file = entry.path().filename().string();
        if (file.ends_with(truth_suffix)) {
            names.push_back(file.substr(0, file.size() - truth_suffix.size()));
        }
    }
    if (names.empty()) {
        throw InputError{fmt::format("{}: no file NAME{}", folder.string(), truth_suffix)};
    }
    std::sort(names.begin(), names.end());
    std::vector<Track> tracks;
    for (const auto& name : names) {
        tracks.push_back(read_track(folder, name));
    }
    return tracks;
}

TripLog thinned(TripLog trip, double step_s) {
    double last_s = -step_s;
    std::erase_if(trip.fixes, [&](const GnssFix& fix) {
        const bool early = !trip.fixes.empty() && fix.t_s < last_s + step_s - jitter_s;
        last_s = early ? last_s : fix.t_s;
        return early;
    });
    return trip;
}

} // namespace macadam::bench
