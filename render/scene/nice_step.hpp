#pragma once

namespace macadam {

/// The smallest of 1, 2, 5, 10, ... (times a power of ten) that parts `most` into at most `parts`.
/// most > 0.
double nice_step(double most, int parts);

} // namespace macadam
