#pragma once

namespace macadam {

inline constexpr double standard_gravity_mps2 = 9.80665; ///< CGPM 1901; ISO 80000-3

}
