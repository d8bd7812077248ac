#include "slam/mapping/pose_graph.h"

#include "recordings/base/check.h"
#include "slam/track/se3.h"

#include <Eigen/Dense>
#include <Eigen/Sparse>

#include <algorithm>
#include <cmath>
#include <limits>

namespace inlay {
namespace {

constexpr int plain_iterations = 3;  // before edges are judged

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

Matrix6 matrix_of(const std::array<double, 21>& triangle) {
    Matrix6 a;
    std::size_t entry = 0;
    for (int row = 0; row < 6; ++row) {
        for (int column = row; column < 6; ++column)
            a(row, column) = a(column, row) = triangle[entry++];
    }
    return a;
}

Eigen::Matrix3d matrix_of(const glm::dmat3& m) {
    Eigen::Matrix3d result;
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column)
            result(row, column) = m[column][row];
    }
    return result;
}

/// How a twist looks after a motion. Murray, Li and Sastry 1994, eq. 2.58, rotation first.
Matrix6 adjoint(const Pose& motion) {
    const Eigen::Matrix3d r = matrix_of(motion.rotation);
    const glm::dvec3& t = motion.translation;
    Eigen::Matrix3d cross;
    cross << 0, -t.z, t.y, t.z, 0, -t.x, -t.y, t.x, 0;
    Matrix6 result;
    result << r, Eigen::Matrix3d::Zero(), cross * r, r;
    return result;
}

/// The twist by which the poses' motion differs from the edge's, in the frame of `from`.
Vector6 deviation(const PoseEdge& edge, const std::vector<Pose>& poses) {
    const Pose motion = inverse(poses[std::size_t(edge.from)]) * poses[std::size_t(edge.to)];
    const Twist twist = logarithm(motion * inverse(edge.motion));
    Vector6 e;
    e << twist.rotation.x, twist.rotation.y, twist.rotation.z, twist.translation.x,
        twist.translation.y, twist.translation.z;
    return e;
}

std::vector<double> squared_deviations(std::span<const PoseEdge> edges,
                                       const std::vector<Pose>& poses) {
    std::vector<double> result;
    result.reserve(edges.size());
    for (const PoseEdge& edge : edges) {
        const Vector6 e = deviation(edge, poses);
        result.push_back(e.dot(matrix_of(edge.information) * e));
    }
    return result;
}

double median_of(std::vector<double> values) {
    const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

double rms_of(const std::vector<double>& squares) {
    double sum = 0;
    for (const double square : squares)
        sum += square;
    return std::sqrt(sum / double(squares.size()));
}

/// The steps of all poses but the first, which has none.
class NormalEquations {
public:
    explicit NormalEquations(std::size_t poses)
        : right_(Eigen::VectorXd::Zero(Eigen::Index(6 * poses))) {}

    void add(const PoseEdge& edge, double weight, const std::vector<Pose>& poses) {
        const Pose motion = inverse(poses[std::size_t(edge.from)]) * poses[std::size_t(edge.to)];
        const Matrix6 information = weight * matrix_of(edge.information);
        const Vector6 e = deviation(edge, poses);
        const Matrix6 from = -Matrix6::Identity(), to = adjoint(motion);
        add_block(edge.from, edge.from, from.transpose() * information * from);
        add_block(edge.from, edge.to, from.transpose() * information * to);
        add_block(edge.to, edge.from, to.transpose() * information * from);
        add_block(edge.to, edge.to, to.transpose() * information * to);
        right_.segment<6>(6 * edge.from) -= from.transpose() * information * e;
        right_.segment<6>(6 * edge.to) -= to.transpose() * information * e;
    }

    Eigen::VectorXd solve() {
        const double tiny = 1e-9 * largest_;  // poses without edges get no step
        for (int i = 0; i < right_.size(); ++i)
            entries_.emplace_back(i, i, i < 6 ? 1e6 * largest_ : tiny);
        Eigen::SparseMatrix<double> a(right_.size(), right_.size());
        a.setFromTriplets(entries_.begin(), entries_.end());
        return Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(a).solve(right_);
    }

private:
    void add_block(int row, int column, const Matrix6& block) {
        for (int j = 0; j < 6; ++j) {
            for (int i = 0; i < 6; ++i)
                entries_.emplace_back(6 * row + i, 6 * column + j, block(i, j));
        }
        if (row == column) largest_ = std::max(largest_, block.diagonal().maxCoeff());
    }

    std::vector<Eigen::Triplet<double>> entries_;
    Eigen::VectorXd right_;
    double largest_ = 1e-30;
};

/// Moves the poses by their steps; the largest step (rad or m).
double move(std::vector<Pose>& poses, const Eigen::VectorXd& steps) {
    double largest = 0;
    for (std::size_t i = 1; i < poses.size(); ++i) {
        const Vector6 s = steps.segment<6>(Eigen::Index(6 * i));
        poses[i] =
            orthonormalized(poses[i] * exponential({{s[0], s[1], s[2]}, {s[3], s[4], s[5]}}));
        largest = std::max(largest, s.cwiseAbs().maxCoeff());
    }
    return largest;
}

}  // namespace

std::array<double, 2> optimize_poses(std::vector<Pose>& world_from_camera,
                                     std::span<const PoseEdge> edges,
                                     const PoseGraphSettings& settings) {
    for (const PoseEdge& edge : edges) {
        const auto there = [&](int i) { return i >= 0 && i < int(world_from_camera.size()); };
        require(there(edge.from) && there(edge.to) && edge.from != edge.to,
                "an edge of the pose graph leads nowhere");
    }
    if (edges.empty()) return {0, 0};
    std::vector<double> squares = squared_deviations(edges, world_from_camera);
    const double before = rms_of(squares);
    for (int i = 0; i < settings.iterations; ++i) {
        // At first a chain of motions agrees with itself, and only what closes it deviates.
        const double half_weight = i < plain_iterations ? std::numeric_limits<double>::infinity()
                                                        : settings.outlier * settings.outlier *
                                                              std::max(median_of(squares), 1e-30);
        NormalEquations equations(world_from_camera.size());
        for (std::size_t k = 0; k < edges.size(); ++k)
            equations.add(edges[k], 1 / (1 + squares[k] / half_weight), world_from_camera);
        const double step = move(world_from_camera, equations.solve());
        squares = squared_deviations(edges, world_from_camera);
        if (i >= plain_iterations && step < settings.still) break;
    }
    return {before, rms_of(squares)};
}

}  // namespace inlay
