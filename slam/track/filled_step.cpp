#include "slam/track/filled_step.h"

#include <Eigen/Dense>

#include <array>

namespace inlay {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

/// A x = b of path lengths (m): rotations as the path of a point at the surfaces' mean distance.
struct PathSystem {
    Matrix6 a;
    Vector6 b;
};

PathSystem path_system(const std::array<double, 21>& upper, const std::array<double, 6>& right,
                       const Vector6& unit) {
    PathSystem system;
    std::size_t entry = 0;
    for (int row = 0; row < 6; ++row) {
        system.b[row] = unit[row] * right[std::size_t(row)];
        for (int column = row; column < 6; ++column) {
            system.a(row, column) = system.a(column, row) =
                unit[row] * upper[entry++] * unit[column];
        }
    }
    return system;
}

/// Solves the system within the directions `free` (columns), but for those of them with no more
/// information than `least`; counts down `free_axes`.
Vector6 solved(const PathSystem& system, const Eigen::MatrixXd& free, double least,
               int& free_axes) {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(free.transpose() * system.a * free);
    Vector6 path = Vector6::Zero();
    for (int i = 0; i < int(free.cols()); ++i) {
        const double value = solver.eigenvalues()[i];
        if (!(value > least)) continue;
        const Vector6 axis = free * solver.eigenvectors().col(i);
        path += axis * (axis.dot(system.b) / value);
        --free_axes;
    }
    return path;
}

}  // namespace

ConstrainedStep filled_step(const ConstrainedStep& step, const IcpSystem& surfaces,
                            const PhotometricSystem& brightness, const BrightnessTrust& trust) {
    if (step.free_axes == 0 || surfaces.inliers == 0 || brightness.inliers == 0 ||
        double(brightness.pairs) < trust.least_share * double(brightness.seen)) {
        return step;
    }
    Vector6 unit = Vector6::Ones();
    unit.head<3>() *= double(surfaces.pairs) / surfaces.distance;
    const PathSystem known = path_system(surfaces.a, surfaces.b, unit);
    PathSystem light = path_system(brightness.a, brightness.b, unit);
    const glm::dvec3 turn = step.twist.rotation, shift = step.twist.translation;
    const Vector6 taken{{turn.x, turn.y, turn.z, shift.x, shift.y, shift.z}};
    light.b -= light.a * taken.cwiseQuotient(unit);
    const Eigen::SelfAdjointEigenSolver<Matrix6> directions(known.a);  // ascending
    const double least = trust.least_information * light.a.bottomRightCorner<3, 3>().trace();
    ConstrainedStep filled = step;
    const Vector6 x = unit.cwiseProduct(
        solved(light, directions.eigenvectors().leftCols(step.free_axes), least, filled.free_axes));
    filled.twist.rotation += glm::dvec3(x[0], x[1], x[2]);
    filled.twist.translation += glm::dvec3(x[3], x[4], x[5]);
    return filled;
}

}  // namespace inlay
