#include "slam/track/constrained_step.h"

#include <Eigen/Dense>

namespace inlay {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

Matrix6 information(const IcpSystem& system) {
    Matrix6 a;
    std::size_t entry = 0;
    for (int row = 0; row < 6; ++row) {
        for (int column = row; column < 6; ++column) {
            a(row, column) = a(column, row) = system.a[entry++];
        }
    }
    return a;
}

}  // namespace

ConstrainedStep constrained_step(const IcpSystem& system, double least_information) {
    ConstrainedStep step;
    if (system.inliers == 0) return step;
    const double radius = system.distance / system.pairs;
    Vector6 unit;  // x = unit * (path lengths)
    unit << Vector6::Ones();
    unit.head<3>() /= radius;
    const Matrix6 a = unit.asDiagonal() * information(system) * unit.asDiagonal();
    const Vector6 b = unit.cwiseProduct(Eigen::Map<const Vector6>(system.b.data()));
    const Eigen::SelfAdjointEigenSolver<Matrix6> solver(a);
    const double weight = a.bottomRightCorner<3, 3>().trace();  // normals are unit vectors
    const double least = least_information * weight;
    Vector6 x = Vector6::Zero();
    for (int i = 0; i < 6; ++i) {
        const double value = solver.eigenvalues()[i];
        if (!(value > least)) continue;
        const Vector6 axis = solver.eigenvectors().col(i);
        x += axis * (axis.dot(b) / value);
        --step.free_axes;
    }
    x = unit.cwiseProduct(x);
    step.twist = {{x[0], x[1], x[2]}, {x[3], x[4], x[5]}};
    return step;
}

}  // namespace inlay
