#pragma once

#include "app/cli/arguments.hpp"
#include "storage/text/unit_system.hpp"

namespace macadam {

/// System of units of the output; the IRI units stand for their system.
inline constexpr Option units_option =
    one_of("si|us|mm/m|in/mi",
           in_group("appearance",
                    {"--units", "SYSTEM", "si: mm/m, km and m; us: in/mi, miles and feet.", "si"}));

/// The same for commands that had --unit.
inline constexpr Option former_units_option = formerly("--unit", units_option);

/// The same for commands of which users may also set the default.
inline constexpr Option preferred_units_option = preference(former_units_option);

UnitSystem parse_units(const Arguments& arguments);

} // namespace macadam
