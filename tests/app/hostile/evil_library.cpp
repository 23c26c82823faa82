// A library that leaves a mark when a program loads it.

#include <fstream>

namespace {
const bool was_loaded = [] {
    std::ofstream{"CODE_RAN"} << "code ran\n";
    return true;
}();
}
