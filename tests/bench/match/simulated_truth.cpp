// How near matching comes to the truth on simulated drives over real networks: by sensors, by
// receivers, in outages.

#include "goal.hpp"
#include "off_network.hpp"
#include "simulated_world.hpp"

#include "estimator/common/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <exception>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace macadam::bench {
namespace {

constexpr std::string_view usage =
    "usage: simulated_truth [--drives N] [--seed N] [--each] NETWORKS...\n"
    "\n"
    "Drives over road networks (.osm.pbf files, or folders of them), records each drive with the\n"
    "errors of sensors, matches it and scores it against the truth. Prints Markdown.\n"
    "\n"
    "  --drives N  on each network (4)\n"
    "  --seed N    of routes (1)\n"
    "  --each      also one line for each drive with all sensors, sigma 3 m, 1 Hz\n";

struct Options {
    std::vector<std::filesystem::path> files;
    std::size_t drives = 4;
    std::uint64_t seed = 1;
    bool each = false;
};

std::uint64_t number_from(const std::string& word) {
    std::uint64_t number = 0;
    const auto end = word.data() + word.size();
    if (const auto [rest, error] = std::from_chars(word.data(), end, number);
        error != std::errc{} || rest != end) {
        throw InputError{fmt::format("'{}', expected a whole number", word)};
    }
    return number;
}

Options parsed(const std::vector<std::string>& words) {
    Options options;
    for (std::size_t i = 0; i < words.size(); ++i) {
        const bool last = i + 1 == words.size();
        if (words[i] == "--drives" && !last) {
            options.drives = number_from(words[++i]);
        } else if (words[i] == "--seed" && !last) {
            options.seed = number_from(words[++i]);
        } else if (words[i] == "--each") {
            options.each = true;
        } else if (std::filesystem::is_directory(words[i])) {
            const auto files = networks_in(words[i]);
            options.files.insert(options.files.end(), files.begin(), files.end());
        } else {
            options.files.emplace_back(words[i]);
        }
    }
    if (options.files.empty()) {
        throw InputError{"no network was named"};
    }
    return options;
}

struct NamedSet {
    const char* name;
    SensorSet sensors;
};
constexpr NamedSet sets[] = {{"positions", positions_only},
                             {"+ odometer", with_odometer},
                             {"+ course, speed of the receiver", with_course},
                             {"+ gyro", with_gyro},
                             {"all", with_all}};

/// The receiver's own speed and course are as late as its positions.
bool can_tell_latency(const SensorSet& sensors) {
    return sensors.wheel_speed || sensors.gyro;
}

std::string percent(double part, double whole, int digits = 2) {
    return whole > 0 ? fmt::format("{:.{}f}", 100 * part / whole, digits) : "";
}

std::string metres(double value) {
    return std::isnan(value) ? "" : fmt::format("{:.2f}", value);
}

std::string errors(const std::vector<float>& error_m) {
    return fmt::format("{} | {} | {}",
                       metres(quantile(error_m, 0.5)),
                       metres(absolute_quantile(error_m, 0.5)),
                       metres(absolute_quantile(error_m, 0.95)));
}

struct Row {
    const char* name;
    Scenario scenario;
    DriveScore score;
};

/// The row of a scenario; of the first one of these numbers.
const DriveScore&
score_in(const std::vector<Row>& rows, const char* name, const Scenario& scenario) {
    const auto found = std::ranges::find_if(rows, [&](const Row& row) {
        return row.name == std::string_view{name} && row.scenario.sigma_m == scenario.sigma_m &&
               row.scenario.fix_rate_hz == scenario.fix_rate_hz &&
               row.scenario.latency_stated == scenario.latency_stated;
    });
    return found->score;
}

std::vector<Row> ablation(const std::vector<DrivenNetwork>& world) {
    std::vector<Row> rows;
    for (const double rate_hz : {1.0, 0.2}) {
        for (const double sigma_m : {3.0, 10.0}) {
            for (const bool stated : {true, false}) {
                for (const auto& [name, sensors] : sets) {
                    if (!stated && !can_tell_latency(sensors)) {
                        continue;
                    }
                    const Scenario scenario{.sigma_m = sigma_m,
                                            .fix_rate_hz = rate_hz,
                                            .sensors = sensors,
                                            .latency_stated = stated};
                    rows.push_back({name, scenario, score_of(world, scenario)});
                }
            }
        }
    }
    return rows;
}

void print_row(const Row& row) {
    const auto& [name, scenario, score] = row;
    fmt::print("| {} | {:g} | {:g} | {} | {} | {} | {} | {} | {} | {} | {:.3f} | {} | {} | {} | {} "
               "|\n",
               name,
               scenario.sigma_m,
               scenario.fix_rate_hz,
               scenario.latency_stated ? "stated" : "sought",
               percent(score.right_m, score.length_m),
               percent(score.same_edge_m, score.length_m),
               percent(score.route.mismatch(), 1),
               percent(score.off_network_m + score.gap_m, score.length_m),
               errors(score.error_m),
               scenario.latency_stated ? ""
                                       : metres(absolute_quantile(score.latency_error_s, 0.95)),
               calibration_error(score),
               percent(score.sure_m, score.length_m, 1),
               percent(score.sure_wrong_m, score.sure_m),
               score.empty,
               score.gaps);
}

void print_plain(const Scenario& scenario, const RouteScore& score) {
    fmt::print(
        "| positions, plain Newson-Krumm | {:g} | {:g} |  |  |  | {} |  |  |  |  |  |  |  |  |  "
        "|  |\n",
        scenario.sigma_m,
        scenario.fix_rate_hz,
        percent(score.mismatch(), 1));
}

std::string at_least(double percent) {
    return fmt::format(">= {:g} %", percent);
}

void print_goals(const std::vector<Row>& rows,
                 const RouteScore& plain_3,
                 const RouteScore& plain_10) {
    const auto& all_3 = score_in(rows, "all", {});
    const auto& all_10 = score_in(rows, "all", {.sigma_m = 10});
    const auto& sought = score_in(rows, "all", {.latency_stated = false});
    const auto& positions_3 = score_in(rows, "positions", {});
    const auto& positions_10 = score_in(rows, "positions", {.sigma_m = 10});
    const auto share = [](const DriveScore& score) {
        return percent(score.right_m, score.length_m) + " %";
    };
    const auto plain = [](const RouteScore& score) {
        return percent(score.common_m, score.truth_m) + " % of the edges";
    };
    print_goal(
        {"right edge and direction, sigma 3 m, all sensors", at_least(99.8), share(all_3), ""});
    print_goal({"the same, positions alone", at_least(99.8), share(positions_3), plain(plain_3)});
    print_goal(
        {"right edge and direction, sigma 10 m, all sensors", at_least(99), share(all_10), ""});
    print_goal({"the same, positions alone", at_least(99), share(positions_10), plain(plain_10)});
    print_goal({"place along the edge p50, sigma 3 m, 1 Hz",
                "<= 1 m",
                metres(absolute_quantile(all_3.error_m, 0.5)) + " m",
                ""});
    print_goal({"place along the edge p95, sigma 3 m, 1 Hz",
                "<= 3 m",
                metres(absolute_quantile(all_3.error_m, 0.95)) + " m",
                ""});
    print_goal({"latency not stated: error p95",
                "<= 0.1 s",
                metres(absolute_quantile(sought.latency_error_s, 0.95)) + " s",
                ""});
    for (const auto& [name, score] :
         {std::pair{"all sensors", &all_3}, {"positions", &positions_3}}) {
        print_goal({fmt::format("confidence, {}, sigma 3 m: calibration error", name),
                    "<= 0.02",
                    fmt::format("{:.3f}", calibration_error(*score)),
                    ""});
        print_goal({fmt::format("confidence, {}, sigma 3 m: length at 0.95 or more", name),
                    at_least(97),
                    percent(score->sure_m, score->length_m) + " %",
                    ""});
        print_goal({fmt::format("confidence, {}, sigma 3 m: of that length wrong", name),
                    "<= 0.3 %",
                    percent(score->sure_wrong_m, score->sure_m) + " %",
                    ""});
    }
    std::size_t empty = 0;
    for (const auto& row : rows) {
        empty += row.score.empty;
    }
    print_goal({"empty traces of simulated drives", "0", std::to_string(empty), ""});
}

void print_ablation(const std::vector<DrivenNetwork>& world) {
    const auto rows = ablation(world);
    const auto plain_3 = plain_score_of(world, {});
    const auto plain_10 = plain_score_of(world, {.sigma_m = 10});
    print_goals(rows, plain_3, plain_10);
    fmt::print(
        "### Simulated truth, by sensors\n\n"
        "| sensors | sigma m | Hz | latency | right edge % | the same edge % | RMF % | off % | "
        "along it: middle m | p50 m | p95 m | latency p95 s | ECE | sure % | of it wrong % | "
        "empty | gaps |\n|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
    for (const auto& row : rows) {
        print_row(row);
    }
    print_plain({}, plain_3);
    print_plain({.sigma_m = 10}, plain_10);
    fmt::print("\n");
}

void print_outages(const std::vector<DrivenNetwork>& world) {
    std::string table;
    for (const double sigma_m : {3.0, 10.0}) {
        for (const auto& [name, sensors] : sets) {
            const auto score =
                score_of(world, {.sigma_m = sigma_m, .sensors = sensors, .outages_per_hour = 8});
            table += fmt::format("| {} | {:g} | {:.1f} | {} | {} | {} |\n",
                                 name,
                                 sigma_m,
                                 score.outage_m / 1000,
                                 percent(score.outage_right_m, score.outage_m),
                                 errors(score.outage_error_m),
                                 percent(score.right_m, score.length_m));
            if (sigma_m == 3 && name == std::string_view{"all"}) {
                print_goal({"place along the edge p95 inside outages of 60 s, all sensors",
                            "<= 8 m",
                            metres(absolute_quantile(score.outage_error_m, 0.95)) + " m",
                            ""});
            }
        }
    }
    fmt::print("### Outages of 60 s, eight an hour\n\n"
               "| sensors | sigma m | km inside | right edge inside % | inside: middle m | p50 m | "
               "p95 m | right edge in all % |\n|---|---|---|---|---|---|---|---|\n{}\n",
               table);
}

void print_off_network(const std::vector<DrivenNetwork>& world) {
    constexpr double share = 0.05;
    std::string table;
    for (const double sigma_m : {3.0, 10.0}) {
        for (const auto& [name, sensors] : sets) {
            const auto score =
                off_network_score(world, {.sigma_m = sigma_m, .sensors = sensors}, share, 1);
            table +=
                fmt::format("| {} | {:g} | {:.1f} | {:.1f} | {:.1f} | {:.2f} | {:.1f} | {:.1f} |\n",
                            name,
                            sigma_m,
                            score.deleted_m / 1000,
                            100 * score.recall(),
                            100 * score.precision(),
                            100 * score.false_share(),
                            score.beside_m / 1000,
                            100 * score.beside_false_share());
            if (sigma_m == 3 &&
                (name == std::string_view{"all"} || name == std::string_view{"positions"})) {
                print_goal({fmt::format("deleted edges, simulated, {}: recall", name),
                            at_least(95),
                            percent(score.recall(), 1) + " %",
                            ""});
                print_goal({fmt::format("deleted edges, simulated, {}: precision", name),
                            at_least(98),
                            percent(score.precision(), 1) + " %",
                            ""});
            }
        }
    }
    fmt::print("### Deleted edges: {:g} % of what was driven\n\n"
               "| sensors | sigma m | deleted km | recall % | precision % | falsely on a road % | "
               "with a neighbour km | of it falsely on a road % "
               "|\n|---|---|---|---|---|---|---|---|\n{}\n",
               100 * share,
               table);
}

void print_faults(const DrivenNetwork& network, const Drive& drive, const DriveScore& score) {
    for (const auto& fault : score.faults) {
        std::size_t edge = 0;
        while (drive.start_m[edge + 1] < fault.from_m) {
            ++edge;
        }
        const auto at =
            place_on(network.roads, drive.route[edge], fault.from_m - drive.start_m[edge]);
        fmt::print("    {:.0f} to {:.0f} m, {:.0f} s, {:.6f} {:.6f}: {}\n",
                   fault.from_m,
                   fault.to_m,
                   t_s_at(drive, fault.from_m),
                   at.lat_deg,
                   at.lon_deg,
                   fault.what);
    }
}

/// Where matching went wrong: for those who mend it.
void print_each(const std::vector<DrivenNetwork>& world) {
    const Scenario scenario{.sensors = with_all};
    for (const auto& network : world) {
        for (std::size_t i = 0; i < network.drives.size(); ++i) {
            const auto recording = recorded(network, i, scenario);
            const auto score =
                score_of(network.drives[i], recording, matched(recording.trip, network.roads));
            fmt::print("{} {}: {:.1f} km, wrong {} m, off {} m, gap {} m, p50 {:.2f} m, p95 {:.2f} "
                       "m, middle {:.2f} m\n",
                       network.name,
                       i,
                       score.length_m / 1000,
                       score.wrong_m,
                       score.off_network_m,
                       score.gap_m,
                       absolute_quantile(score.error_m, 0.5),
                       absolute_quantile(score.error_m, 0.95),
                       quantile(score.error_m, 0.5));
            print_faults(network, network.drives[i], score);
        }
    }
}

void measure(const Options& options) {
    std::vector<DrivenNetwork> world;
    double length_m = 0;
    for (const auto& file : options.files) {
        world.push_back(driven_network(file, options.drives, options.seed));
        for (const auto& drive : world.back().drives) {
            length_m += drive.start_m.back();
        }
    }
    fmt::print("{} drives over {} networks, {:.0f} km.\n\n",
               options.drives * world.size(),
               world.size(),
               length_m / 1000);
    if (options.each) {
        print_each(world);
        return;
    }
    print_ablation(world);
    print_outages(world);
    print_off_network(world);
}

} // namespace
} // namespace macadam::bench

int main(int count, char** words) {
    const std::vector<std::string> arguments(words + 1, words + count);
    if (arguments == std::vector<std::string>{"--help"}) {
        fmt::print("{}", macadam::bench::usage);
        return 0;
    }
    try {
        macadam::bench::measure(macadam::bench::parsed(arguments));
    } catch (const std::exception& error) {
        fmt::print(stderr, "simulated_truth: {}\n", error.what());
        return 1;
    }
}
