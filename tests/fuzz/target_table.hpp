#pragma once

#include "targets.hpp"

#include <ostream>
#include <span>

namespace macadam::fuzz {

/// A target as tests go through all of them.
struct Target {
    std::string_view name;
    Answer (*run)(std::string_view input);
    int usual_mutations; ///< that the ordinary tests try; `./run test --all` tries 4,000 of each
    int slices;          ///< tests that share them
};

inline void PrintTo(const Target& target, std::ostream* out) { // GoogleTest's name for it
    *out << target.name;
}

/// Every target of targets.hpp.
std::span<const Target> targets();

} // namespace macadam::fuzz
