#pragma once

#include "app/cli/arguments.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

namespace macadam {

/// Joins lists of options to the table of a command, so that commands share groups of options.
template <std::size_t... Counts>
constexpr auto joined(const std::array<Option, Counts>&... lists) {
    std::array<Option, (Counts + ...)> all{};
    auto end = all.begin();
    ((end = std::ranges::copy(lists, end).out), ...);
    return all;
}

} // namespace macadam
