#pragma once

#include "mapping/simulation/fleet_scenario.hpp"

#include <filesystem>
#include <string>
#include <string_view>

namespace macadam {
/// A fleet's recipe from its TOML file (docs/reference/simulation.md). Without [[car]] or [[road]]
/// those of sample_recipe() are taken.
///
/// \throws InputError  "file:line: ..." for a key that is not known or a value out of its range.
FleetScenario read_recipe(const std::filesystem::path& file);

/// The same of text; `name` stands for the file in messages.
FleetScenario parse_recipe(std::string_view text, const std::string& name);

} // namespace macadam
