#pragma once

namespace macadam {

/// Returns the smallest of 1, 2, 5, 10, ... (times a power of ten) that divides `most` into at most
/// `parts`. most > 0.
double nice_step(double most, int parts);

} // namespace macadam
