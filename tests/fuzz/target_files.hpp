#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace macadam::fuzz {

struct TargetFile {
    std::string name;
    std::string content;
};

/// Good inputs of a target, in the order of their names.
std::vector<TargetFile> seeds_of(std::string_view target);

/// Inputs that were a finding once, or are refused on purpose; perhaps none.
std::vector<TargetFile> findings_of(std::string_view target);

/// Words of the target's dictionary, perhaps none.
std::vector<std::string> words_of(std::string_view target);

/// Names in targets.hpp, sorted.
std::vector<std::string> declared_targets();

/// Names in readers.txt, sorted.
std::vector<std::string> targets_with_readers();

/// Source files that readers.txt names and that do not exist.
std::vector<std::string> readers_that_are_not_there();

} // namespace macadam::fuzz
