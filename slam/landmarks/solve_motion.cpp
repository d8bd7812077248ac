#include "slam/landmarks/solve_motion.h"

#include "recordings/base/random.h"
#include "slam/depth/filter_depth.h"
#include "slam/track/se3.h"

#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cmath>

namespace inlay {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

constexpr int most_samples = 2000;         // triples
constexpr double miss = 1e-6;              // chance that no triple of inliers is among them
constexpr int rounds = 6;                  // of refinement
constexpr double corner_sigma = 0.004;     // rad, of the angle between two sights of a corner
constexpr double reach = 3;                // sigma, of inliers
constexpr double sample_reach = 6;         // sigma, of inliers of a motion from a triple
constexpr double least_side = 0.1;         // m, of a triple's triangle
constexpr double least_area = 0.01;        // m^2, of the parallelogram on two of its sides
constexpr double nearest = 0.05;           // m, from the camera
constexpr double least_condition = 1e-12;  // of the normal equations

/// Standard deviation (m) of the difference of two measured depths.
double depth_noise(double z) { return 1.5 * double(depth_sigma(float(z))) + 0.005; }

/// How far (sigma) the motion takes a point from where it was seen: two angles and the depth.
Eigen::Vector3d residual(const glm::dvec3& moved, const glm::dvec3& seen) {
    return {(moved.x / moved.z - seen.x / seen.z) / corner_sigma,
            (moved.y / moved.z - seen.y / seen.z) / corner_sigma,
            (moved.z - seen.z) / depth_noise(seen.z)};
}

bool agrees(const Pose& from_to, const PointPair& pair, double most) {
    const glm::dvec3 moved = from_to * pair.to;
    return moved.z > nearest && residual(moved, pair.from).squaredNorm() < most * most;
}

std::vector<int> inliers_of(const Pose& from_to, std::span<const PointPair> pairs, double most) {
    std::vector<int> inliers;
    for (int i = 0; i < int(pairs.size()); ++i) {
        if (agrees(from_to, pairs[std::size_t(i)], most)) inliers.push_back(i);
    }
    return inliers;
}

using Triple = std::array<PointPair, 3>;

/// Whether the triangle is as large in both views, and large enough to tell a motion.
bool alike(const Triple& triple) {
    for (std::size_t i = 0; i < 3; ++i) {
        const PointPair &a = triple[i], &b = triple[(i + 1) % 3];
        const double from = glm::length(a.from - b.from), to = glm::length(a.to - b.to);
        const double noise = depth_noise(a.from.z) + depth_noise(b.from.z);
        if (from < least_side || to < least_side || std::abs(from - to) > 2 * noise) return false;
    }
    const auto area = [](const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
        return glm::length(glm::cross(b - a, c - a));
    };
    return area(triple[0].from, triple[1].from, triple[2].from) > least_area &&
           area(triple[0].to, triple[1].to, triple[2].to) > least_area;
}

/// Axes along the triangle's first side and normal.
glm::dmat3 axes_of(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    const glm::dvec3 x = glm::normalize(b - a);
    const glm::dvec3 z = glm::normalize(glm::cross(x, c - a));
    return {x, glm::cross(z, x), z};
}

/// The motion that takes one triangle onto the other.
Pose motion_of(const Triple& t) {
    const glm::dmat3 rotation = axes_of(t[0].from, t[1].from, t[2].from) *
                                glm::transpose(axes_of(t[0].to, t[1].to, t[2].to));
    const glm::dvec3 from = (t[0].from + t[1].from + t[2].from) / 3.0;
    const glm::dvec3 to = (t[0].to + t[1].to + t[2].to) / 3.0;
    return {rotation, from - rotation * to};
}

/// How many triples have to be tried for one of them, all but surely, to hold inliers only.
double samples_for(double inlier_share) {
    const double hit = inlier_share * inlier_share * inlier_share;
    return hit < 1 ? std::log(miss) / std::log1p(-hit) : 1;
}

/// Normal equations of the twist that improves a motion.
struct NormalEquations {
    Matrix6 a = Matrix6::Zero();
    Vector6 b = Vector6::Zero();
};

NormalEquations equations_of(const Pose& from_to, std::span<const PointPair> pairs,
                             std::span<const int> inliers) {
    NormalEquations equations;
    for (const int i : inliers) {
        const PointPair& pair = pairs[std::size_t(i)];
        const glm::dvec3 p = from_to * pair.to;
        Eigen::Matrix3d by_point;
        by_point << 1 / p.z, 0, -p.x / (p.z * p.z), 0, 1 / p.z, -p.y / (p.z * p.z), 0, 0, 1;
        by_point.topRows<2>() /= corner_sigma;
        by_point.row(2) /= depth_noise(pair.from.z);
        Eigen::Matrix<double, 3, 6> by_twist;  // of a point: rotation x p + translation
        by_twist << 0, p.z, -p.y, 1, 0, 0, -p.z, 0, p.x, 0, 1, 0, p.y, -p.x, 0, 0, 0, 1;
        const Eigen::Matrix<double, 3, 6> j = by_point * by_twist;
        equations.a += j.transpose() * j;
        equations.b -= j.transpose() * residual(p, pair.from);
    }
    return equations;
}

Twist to_twist(const Vector6& x) { return {{x[0], x[1], x[2]}, {x[3], x[4], x[5]}}; }

double largest_deviation(const Eigen::Matrix3d& covariance) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance, Eigen::EigenvaluesOnly);
    return std::sqrt(solver.eigenvalues()[2]);
}

}  // namespace

std::optional<Pose> sample_motion(std::span<const PointPair> pairs) {
    if (pairs.size() < 4) return std::nullopt;
    std::optional<Pose> best;
    std::size_t most = 3;
    double needed = most_samples;
    for (std::uint32_t sample = 0; sample < needed; ++sample) {
        const auto pick = [&](std::uint32_t i) {
            return pairs[std::size_t(double(uniform({1, 0, 0, sample}, i)) * double(pairs.size()))];
        };
        const Triple triple{pick(0), pick(1), pick(2)};
        if (!alike(triple)) continue;
        const Pose motion = motion_of(triple);
        const std::size_t inliers = inliers_of(motion, pairs, sample_reach).size();
        if (!(inliers > most)) continue;
        most = inliers;
        best = motion;
        needed = std::min(needed, samples_for(double(inliers) / double(pairs.size())));
    }
    return best;
}

std::optional<SolvedMotion> refine_motion(const Pose& start, std::span<const PointPair> pairs) {
    SolvedMotion result{start, inliers_of(start, pairs, sample_reach)};
    Matrix6 information = Matrix6::Zero();
    for (int round = 0; round < rounds; ++round) {
        if (result.inliers.size() < 4) return std::nullopt;
        const NormalEquations equations = equations_of(result.from_to, pairs, result.inliers);
        const Eigen::LDLT<Matrix6> solver(equations.a);
        if (!solver.isPositive() || !(solver.rcond() > least_condition)) return std::nullopt;
        result.from_to =
            orthonormalized(exponential(to_twist(solver.solve(equations.b))) * result.from_to);
        result.inliers = inliers_of(result.from_to, pairs, reach);
        information = equations.a;
    }
    const Matrix6 covariance = information.inverse();
    result.rotation_sigma = largest_deviation(covariance.topLeftCorner<3, 3>());
    result.sigma = largest_deviation(covariance.bottomRightCorner<3, 3>());
    return result;
}

}  // namespace inlay
