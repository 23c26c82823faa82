#pragma once

#include "storage/settings/scenario_file.hpp"

namespace macadam {

/// A recipe to start from, with a remark on every key: five cars on roads as they are. What a
/// recipe leaves out is as here.
std::string_view sample_recipe();

} // namespace macadam
