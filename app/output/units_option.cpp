#include "app/output/units_option.hpp"

namespace macadam {

UnitSystem parse_units(const Arguments& arguments) {
    const auto word = arguments.value("--units").value_or("si");
    return word == "us" || word == "in/mi" ? UnitSystem::us : UnitSystem::si;
}

} // namespace macadam
