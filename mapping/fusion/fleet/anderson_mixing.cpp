#include "mapping/fusion/fleet/anderson_mixing.hpp"

#include <Eigen/QR>

namespace macadam {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

VectorXd AndersonMixing::next(const VectorXd& x, const VectorXd& g) {
    constexpr double grown = 2;
    const VectorXd step = g - x;
    if (x_.empty() || step.norm() > grown * steps_.back().norm()) {
        x_.clear();
        steps_.clear();
    }
    x_.push_back(x);
    steps_.push_back(step);
    if (x_.size() > depth_ + 1) {
        x_.pop_front();
        steps_.pop_front();
    }
    const auto count = static_cast<Index>(x_.size()) - 1;
    if (count == 0) {
        return g;
    }
    MatrixXd differences(step.size(), count);
    for (Index i = 0; i < count; ++i) {
        const auto at = static_cast<std::size_t>(i);
        differences.col(i) = steps_[at + 1] - steps_[at];
    }
    const VectorXd shares = differences.colPivHouseholderQr().solve(step);
    VectorXd mixed = g;
    for (Index i = 0; i < count; ++i) {
        const auto at = static_cast<std::size_t>(i);
        mixed -= shares[i] * (x_[at + 1] - x_[at] + differences.col(i));
    }
    return mixed;
}

} // namespace macadam
