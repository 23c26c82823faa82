#pragma once

namespace macadam {

/// Sample scenario with a comment on every key: five cars on existing roads. Its values are the
/// defaults of every scenario.
std::string_view sample_recipe();

} // namespace macadam
