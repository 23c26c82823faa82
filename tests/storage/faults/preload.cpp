// Loaded before the program, puts the faulty disk below it: MACADAM_TEST_FAULT is "full", "broken"
// or "no_sync" and the number of the access that fails. Even numbers fail once, odd ones for good.

#include "faulty_disk.hpp"

#include <cstdlib>
#include <sstream>

namespace macadam::testing {
namespace {

[[gnu::constructor]] void put_faulty_disk_below() {
    const auto* const words = std::getenv("MACADAM_TEST_FAULT");
    if (words == nullptr) {
        return;
    }
    std::istringstream in{words};
    std::string fault;
    std::size_t number = 0;
    in >> fault >> number;
    auto* const disk = new FaultyDisk; // for as long as the program runs
    disk->plan({fault == "full"     ? Fault::full
                : fault == "broken" ? Fault::broken
                                    : Fault::no_sync,
                number,
                number % 2 == 0});
}

} // namespace
} // namespace macadam::testing
