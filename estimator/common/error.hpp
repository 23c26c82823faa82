#pragma once

#include <stdexcept>

namespace macadam {

/// Invalid input: a file, a row or a value. The message says where ("file:line" for a text file),
/// what was found and what was expected; lower case, no full stop. The program ends with exit
/// status 1. Programming errors are asserts, not exceptions.
struct InputError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

} // namespace macadam
