#pragma once

namespace macadam {

/// Version of what passes_of() returns. It grows with every change by which a log gives other
/// passes: workers of one database must not mix them.
inline constexpr int results_version = 1;

} // namespace macadam
