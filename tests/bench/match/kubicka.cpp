// Scores matching on recorded trips whose driven arcs are known: the set of Kubicka et al., beside
// the plain method of Newson and Krumm.

#include "bench/match/newson_krumm.hpp"
#include "deleted_edges.hpp"
#include "estimator/common/error.hpp"
#include "estimator/motion/make_odometer.hpp"
#include "mapping/matching/arcs.hpp"
#include "scoring.hpp"
#include "tracks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <functional>
#include <set>
#include <string_view>

namespace macadam::bench {
namespace {

constexpr std::string_view usage = R"(usage: kubicka_bench FOLDER [OPTION...]

Matches every trip of FOLDER (NAME.osm.pbf, NAME.trip.csv, NAME.truth.csv) by its positions alone,
with the defaults, and prints how much of it is right.

  --write FOLDER  also writes the arcs of each trip, as `macadam match --arcs` does
  --tracks        also prints what each track loses, the worst first
  --bins          also prints confidence by tenths
  --plain         also scores the plain method of Newson and Krumm
  --deleted       also matches on maps that lack 5 % of what was driven
  --turns N       matches all N times, for the speed (3)
  --help          prints this

The data: M. Kubicka et al., "Dataset for testing and training of map-matching algorithms", IEEE
Intelligent Vehicles Symposium 2015; doi:10.5281/zenodo.57731.
)";

struct Options {
    std::filesystem::path folder;
    std::filesystem::path write;
    bool tracks = false;
    bool bins = false;
    bool plain = false;
    bool deleted = false;
    int turns = 3;
};

using Matcher = std::function<MatchedTrace(const TripLog&, const RoadNetwork&)>;

MatchedTrace match(const TripLog& trip, const RoadNetwork& roads) {
    const auto odometer = make_odometer(trip, {}).odometer;
    return map_match(trip, odometer, roads, {}).trace;
}

MatchedTrace match_plainly(const TripLog& trip, const RoadNetwork& roads) {
    MatchedTrace trace;
    for (const auto& [edge, from_m, to_m] : newson_krumm(trip, roads)) {
        trace.push_back({IntervalKind::road, edge, 0, 0, from_m, to_m, 0, 0, 1, ""});
    }
    return trace;
}

double cpu_s() {
    return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

struct Result {
    std::vector<Score> scores; ///< per track
    Calibration calibration;
    double positions_per_s; ///< of CPU
};

Result
result_of(const std::vector<Track>& tracks, double step_s, int turns, const Matcher& matcher) {
    std::vector<TripLog> trips;
    std::size_t positions = 0;
    for (const auto& track : tracks) {
        trips.push_back(step_s > 1 ? thinned(track.trip, step_s) : track.trip);
        positions += trips.back().fixes.size();
    }
    Result result{};
    std::vector<double> took_s;
    for (int turn = 0; turn < turns; ++turn) {
        std::vector<MatchedTrace> traces;
        const double begin_s = cpu_s();
        for (std::size_t i = 0; i < tracks.size(); ++i) {
            traces.push_back(matcher(trips[i], tracks[i].roads));
        }
        took_s.push_back(cpu_s() - begin_s);
        for (std::size_t i = 0; turn == 0 && i < tracks.size(); ++i) {
            const ArcLengths length_m{tracks[i].ways};
            const auto found = found_arcs(traces[i], tracks[i].roads);
            result.scores.push_back(score_of(tracks[i].truth, found, length_m));
            result.calibration.add(tracks[i].truth, found, length_m);
        }
    }
    std::sort(took_s.begin(), took_s.end());
    result.positions_per_s = static_cast<double>(positions) / took_s[took_s.size() / 2];
    return result;
}

void print_head() {
    fmt::print("{:30} {:>8} {:>8} {:>8} {:>6} {:>12}\n",
               "positions",
               "WCF",
               "MCF",
               "RMF",
               "empty",
               "positions/s");
}

void print_line(const std::string& name, const Result& result) {
    const auto totals = totals_of(result.scores);
    fmt::print("{:30} {:8.5f} {:8.5f} {:8.5f} {:6} {:12.0f}\n",
               name,
               totals.wcf,
               totals.mcf,
               totals.rmf,
               totals.empty,
               result.positions_per_s);
}

void print_tracks(const std::vector<Track>& tracks, const std::vector<Score>& scores) {
    std::vector<std::size_t> order(tracks.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        order[i] = i;
    }
    const auto lost_m = [&](std::size_t i) { return scores[i].wrong_m() + scores[i].missed_m(); };
    std::sort(order.begin(), order.end(), [&](auto a, auto b) { return lost_m(a) > lost_m(b); });
    fmt::print("\n{:12} {:>9} {:>9} {:>9}\n", "track", "truth m", "wrong m", "missed m");
    for (const auto i : order) {
        fmt::print("{:12} {:9.0f} {:9.0f} {:9.0f}\n",
                   tracks[i].name,
                   scores[i].truth_m,
                   scores[i].wrong_m(),
                   scores[i].missed_m());
    }
}

void print_calibration(const Calibration& calibration, bool bins) {
    fmt::print(
        "\nconfidence: expected calibration error {:.4f}; at {:.2f} or above {:.2f} % of the "
        "length, of that {:.2f} % wrong\n",
        calibration.expected_error(),
        Calibration::sure_from,
        100 * calibration.sure_share(),
        100 * calibration.sure_wrong_share());
    for (std::size_t i = 0; bins && i < calibration.bins().size(); ++i) {
        const auto& bin = calibration.bins()[i];
        if (bin.length_m > 0) {
            fmt::print("  {:.1f}  {:10.0f} m, told {:.3f}, right {:.3f}\n",
                       0.1 * static_cast<double>(i),
                       bin.length_m,
                       bin.confidence_m / bin.length_m,
                       bin.right_m / bin.length_m);
        }
    }
}

void print_deleted(const std::vector<Track>& tracks) {
    constexpr double share = 0.05;
    constexpr std::uint64_t draws = 3;
    Deletion all;
    for (std::uint64_t seed = 1; seed <= draws; ++seed) {
        for (const auto& track : tracks) {
            all = all + match_without_edges(track, share, seed);
        }
    }
    fmt::print("\ndeleted edges: {:.2f} % of the driven length; off the network: recall {:.4f}, "
               "precision {:.4f}; on a road not driven {:.4f} of the deleted\n",
               100 * all.deleted_m / all.driven_m,
               all.recall(),
               all.precision(),
               all.false_share());
}

void write_arcs(const std::vector<Track>& tracks, const std::filesystem::path& folder) {
    std::filesystem::create_directories(folder);
    for (const auto& track : tracks) {
        std::ofstream out{folder / (track.name + ".csv")};
        out << "from_node,to_node,way_id,t_enter_s,confidence\n";
        for (const auto& arc : arcs_of(match(track.trip, track.roads), track.roads)) {
            out << fmt::format("{},{},{},{:.3f},{:.4f}\n",
                               arc.from_node,
                               arc.to_node,
                               arc.way_id,
                               arc.t_enter_s,
                               arc.confidence);
        }
    }
}

void score(const Options& options) {
    const auto tracks = read_tracks(options.folder);
    print_head();
    const auto whole = result_of(tracks, 1, options.turns, match);
    print_line("as recorded, 1 s", whole);
    for (const double step_s : {5, 15, 30}) {
        print_line(fmt::format("each {} s", step_s), result_of(tracks, step_s, 1, match));
    }
    if (options.plain) {
        print_line("plain Newson-Krumm, 1 s", result_of(tracks, 1, 1, match_plainly));
    }
    print_calibration(whole.calibration, options.bins);
    if (options.deleted) {
        print_deleted(tracks);
    }
    if (options.tracks) {
        print_tracks(tracks, whole.scores);
    }
    if (!options.write.empty()) {
        write_arcs(tracks, options.write);
    }
}

/// \throws InputError  if they are not what `usage` says.
Options parse(const std::vector<std::string>& words) {
    Options options;
    for (std::size_t i = 0; i < words.size(); ++i) {
        const bool more = i + 1 < words.size();
        if (words[i] == "--tracks") {
            options.tracks = true;
        } else if (words[i] == "--bins") {
            options.bins = true;
        } else if (words[i] == "--plain") {
            options.plain = true;
        } else if (words[i] == "--deleted") {
            options.deleted = true;
        } else if (words[i] == "--write" && more) {
            options.write = words[++i];
        } else if (words[i] == "--turns" && more) {
            options.turns = std::max(1, std::atoi(words[++i].c_str()));
        } else if (options.folder.empty() && !words[i].starts_with("--")) {
            options.folder = words[i];
        } else {
            throw InputError{fmt::format("'{}' is not understood; see --help", words[i])};
        }
    }
    if (options.folder.empty()) {
        throw InputError{"FOLDER is missing; see --help"};
    }
    return options;
}

} // namespace
} // namespace macadam::bench

int main(int argc, char** argv) {
    const std::vector<std::string> words{argv + 1, argv + argc};
    if (std::find(words.begin(), words.end(), "--help") != words.end()) {
        std::fputs(macadam::bench::usage.data(), stdout);
        return 0;
    }
    try {
        macadam::bench::score(macadam::bench::parse(words));
    } catch (const std::exception& error) {
        std::fprintf(stderr, "kubicka_bench: %s\n", error.what());
        return 1;
    }
}
