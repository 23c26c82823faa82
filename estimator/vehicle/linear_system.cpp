#include "estimator/vehicle/linear_system.hpp"

#include <unsupported/Eigen/MatrixFunctions>

namespace macadam {

Eigen::MatrixXd exponential(const Eigen::MatrixXd& matrix) {
    return matrix.exp();
}

} // namespace macadam
