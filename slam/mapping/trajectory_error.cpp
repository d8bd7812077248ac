#include "slam/mapping/trajectory_error.h"

#include "recordings/base/check.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace inlay {
namespace {

void require_pairs(std::span<const Pose> estimated, std::span<const Pose> reference,
                   std::size_t least) {
    require(estimated.size() == reference.size() && estimated.size() >= least,
            "trajectories of " + std::to_string(estimated.size()) + " and " +
                std::to_string(reference.size()) + " poses; needed are as many of both, and " +
                std::to_string(least) + " or more");
}

TrajectoryError summary(const std::vector<Pose>& differences) {
    TrajectoryError error;
    const double count = double(differences.size());
    for (const Pose& difference : differences) {
        const double distance = glm::length(difference.translation);
        const double angle = rotation_angle(Pose{}, difference);
        error.rms += distance * distance / count;
        error.mean += distance / count;
        error.largest = std::max(error.largest, distance);
        error.rms_angle += angle * angle / count;
    }
    error.rms = std::sqrt(error.rms);
    error.rms_angle = std::sqrt(error.rms_angle);
    return error;
}

glm::dvec3 mean_position(std::span<const Pose> poses) {
    glm::dvec3 sum(0);
    for (const Pose& pose : poses)
        sum += pose.translation;
    return sum / double(poses.size());
}

Eigen::Vector3d eigen(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

}  // namespace

Pose align(std::span<const Pose> estimated, std::span<const Pose> reference) {
    require_pairs(estimated, reference, 1);
    const glm::dvec3 from = mean_position(estimated), to = mean_position(reference);
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    for (std::size_t i = 0; i < estimated.size(); ++i) {
        covariance += eigen(reference[i].translation - to) *
                      eigen(estimated[i].translation - from).transpose();
    }
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance,
                                                Eigen::ComputeFullU | Eigen::ComputeFullV);
    Eigen::Vector3d signs(1, 1, 1);
    if ((svd.matrixU() * svd.matrixV().transpose()).determinant() < 0) signs[2] = -1;
    const Eigen::Matrix3d r = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
    Pose result;
    for (int column = 0; column < 3; ++column) {
        for (int row = 0; row < 3; ++row)
            result.rotation[column][row] = r(row, column);
    }
    result.translation = to - result.rotation * from;
    return result;
}

TrajectoryError absolute_error(std::span<const Pose> estimated, std::span<const Pose> reference) {
    require_pairs(estimated, reference, 1);
    const Pose reference_from_estimated = align(estimated, reference);
    std::vector<Pose> differences;
    differences.reserve(estimated.size());
    for (std::size_t i = 0; i < estimated.size(); ++i) {
        differences.push_back(inverse(reference[i]) * (reference_from_estimated * estimated[i]));
    }
    return summary(differences);
}

TrajectoryError relative_error(std::span<const Pose> estimated, std::span<const Pose> reference,
                               int frames) {
    require(frames >= 1, "the step of a relative error must be 1 frame or more");
    const auto step = std::size_t(frames);
    require_pairs(estimated, reference, step + 1);
    std::vector<Pose> differences;
    differences.reserve(estimated.size());
    for (std::size_t i = 0; i + step < estimated.size(); ++i) {
        const Pose true_motion = inverse(reference[i]) * reference[i + step];
        const Pose motion = inverse(estimated[i]) * estimated[i + step];
        differences.push_back(inverse(true_motion) * motion);
    }
    return summary(differences);
}

}  // namespace inlay
