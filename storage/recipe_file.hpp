#pragma once

#include "mapping/simulation/fleet_recipe.hpp"

#include <filesystem>
#include <string>
#include <string_view>

namespace macadam {

/// A recipe to start from, with a remark on every key: five cars on roads as they are. What a
/// recipe leaves out is as here.
std::string_view sample_recipe();

/// A fleet's recipe from its TOML file (docs/simulation.md). Without [[car]] or [[road]] those of
/// sample_recipe() are taken.
///
/// \throws InputError  "file:line: ..." for a key that is not known or a value out of its range.
FleetRecipe read_recipe(const std::filesystem::path& file);

/// The same of text; `name` stands for the file in messages.
FleetRecipe parse_recipe(std::string_view text, const std::string& name);

} // namespace macadam
