#pragma once

#include <fmt/format.h>

#include <string>

namespace macadam::bench {

/// What was wanted of something, what was measured, and what the plain method of Newson and Krumm
/// comes to, "" where it says nothing of it.
struct Goal {
    std::string what;
    std::string wanted;
    std::string measured;
    std::string plain;
};

/// A line that tests/bench/measure.py gathers into one table.
inline void print_goal(const Goal& goal) {
    fmt::print("goal\t{}\t{}\t{}\t{}\n", goal.what, goal.wanted, goal.measured, goal.plain);
}

} // namespace macadam::bench
