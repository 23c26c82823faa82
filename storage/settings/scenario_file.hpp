#pragma once

#include "mapping/simulation/fleet_scenario.hpp"

#include <filesystem>
#include <string>
#include <string_view>

namespace macadam {
/// Reads a fleet scenario from a TOML file (docs/reference/simulation.md). Without [[car]] or
/// [[road]], those of sample_recipe() are used.
///
/// \throws InputError  "file:line: ..." for an unknown key or a value out of range.
FleetScenario read_recipe(const std::filesystem::path& file);

/// Parses text like read_recipe(); `name` stands for the file in messages.
FleetScenario parse_recipe(std::string_view text, const std::string& name);

} // namespace macadam
