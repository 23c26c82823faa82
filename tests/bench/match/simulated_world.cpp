#include "simulated_world.hpp"
#include "mapping/network/build_network.hpp"

#include "estimator/common/error.hpp"
#include "estimator/simulation/random.hpp"
#include "storage/networks/network_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace macadam::bench {
namespace {

constexpr double outage_s = 60;

std::uint64_t hash_of(const std::string& name) {
    std::uint64_t hash = 0;
    for (const char letter : name) {
        hash = seed_of({hash, static_cast<std::uint64_t>(static_cast<unsigned char>(letter))});
    }
    return hash;
}

} // namespace

std::vector<std::filesystem::path> networks_in(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator{folder}) {
        if (entry.path().string().ends_with(".osm.pbf")) {
            files.push_back(entry.path());
        }
    }
    if (files.empty()) {
        throw InputError{
            fmt::format("{}: holds no network, expected .osm.pbf files", folder.string())};
    }
    std::ranges::sort(files);
    return files;
}

DrivenNetwork
driven_network(const std::filesystem::path& file, std::size_t drives, std::uint64_t seed) {
    const auto filename = file.filename().string();
    DrivenNetwork network{.name = filename.substr(0, filename.find('.')),
                          .ways = read_network(file),
                          .roads = {},
                          .drives = {}};
    network.roads = build_network(network.ways);
    const auto driving = standard_recipe(0, 1).driving;
    const auto own_seed = seed_of({seed, hash_of(network.name)});
    const auto map = make_route_map(network.roads, driving, own_seed);
    for (std::size_t i = 0; i < drives; ++i) {
        network.drives.push_back(make_drive(network.roads, map, driving, own_seed, i));
    }
    return network;
}

ScoreRule rule_of(const Scenario& scenario) {
    return {.junction_m = std::max(10.0, 2 * scenario.sigma_m)};
}

DriveRecipe recipe_of(const Scenario& scenario) {
    auto recipe = standard_recipe(scenario.sigma_m, scenario.fix_rate_hz);
    recipe.gnss.latency_stated = scenario.latency_stated;
    recipe.gnss.outages_per_hour = scenario.outages_per_hour;
    recipe.gnss.outage_s = {outage_s, outage_s};
    return recipe;
}

Recording recorded(const DrivenNetwork& network, std::size_t drive, const Scenario& scenario) {
    return recorded(network.drives[drive],
                    recipe_of(scenario),
                    scenario.sensors,
                    seed_of({hash_of(network.name), drive}));
}

DriveScore score_of(std::span<const DrivenNetwork> world,
                    const Scenario& scenario,
                    const MatchConfig& config) {
    DriveScore sum;
    for (const auto& network : world) {
        for (std::size_t i = 0; i < network.drives.size(); ++i) {
            const auto recording = recorded(network, i, scenario);
            const auto found = matched(recording.trip, network.roads, config);
            sum = together(std::move(sum),
                           score_of(network.drives[i], recording, found, rule_of(scenario)));
        }
    }
    return sum;
}

RouteScore plain_score_of(std::span<const DrivenNetwork> world, const Scenario& scenario) {
    RouteScore sum;
    for (const auto& network : world) {
        for (std::size_t i = 0; i < network.drives.size(); ++i) {
            const auto recording = recorded(network, i, scenario);
            const auto edges = newson_krumm(recording.trip, network.roads);
            sum = together(sum, route_score_of(network.drives[i], recording, edges));
        }
    }
    return sum;
}

} // namespace macadam::bench
