#pragma once

namespace macadam::testing {

/// What is wanted of a figure, and what it is held to where that is not reached.
struct Bound {
    double wanted;
    double reached = wanted;
};

/// The figure is within the bound; says where it is not within the wanted one.
void expect_at_most(const char* what, double figure, const Bound& bound);

} // namespace macadam::testing
