#pragma once

#include <stdexcept>

namespace macadam {

/// What we were given cannot be used: a file, a row, a value. The message says where ("file:line"
/// for a text file), what is there, and what was expected; lower case, no full stop. The program
/// ends with exit status 1. Our own mistakes are asserts, not exceptions.
struct InputError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

} // namespace macadam
