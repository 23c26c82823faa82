#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <deque>

namespace macadam {

/// Accelerates the iteration x = g(x) to a fixed point: the next x is the combination of the last
/// ones for which g(x) - x, taken for linear, is smallest. For a linear g it converges like GMRES,
/// where the plain iteration takes as many steps as there are unknowns in a chain.
///
/// Source: D. G. Anderson, "Iterative procedures for nonlinear integral equations", Journal of the
/// ACM 12 (1965), pp. 547-560; H. F. Walker and P. Ni, "Anderson acceleration for fixed-point
/// iterations", SIAM Journal on Numerical Analysis 49 (2011), pp. 1715-1735.
class AndersonMixing {
public:
    /// \param depth  differences that are remembered
    explicit AndersonMixing(std::size_t depth) : depth_{depth} {}

    /// Returns the next x. Forgets the past if the step g - x has grown, as it may where g is far
    /// from linear.
    /// \param x  last one
    /// \param g  its image
    Eigen::VectorXd next(const Eigen::VectorXd& x, const Eigen::VectorXd& g);

    /// Forgets the past, because g changed.
    void restart() { x_.clear(); }

private:
    std::size_t depth_;
    std::deque<Eigen::VectorXd> x_; ///< last ones, oldest first
    std::deque<Eigen::VectorXd> steps_;
};

} // namespace macadam
