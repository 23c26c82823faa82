#pragma once

namespace macadam {

/// Version of what an import writes. It grows with every change by which a log gives other passes
/// or other fused values, as a test notices (tests/app/import/results_version_test.cpp): programs
/// that write to one database must not mix them.
inline constexpr int results_version = 2;

} // namespace macadam
