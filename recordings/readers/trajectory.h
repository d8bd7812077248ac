// Trajectories: timed poses read, checked, written and interpolated (TUM and .log files).
#pragma once

#include "recordings/base/pose.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace inlay {

/// A pose as a file holds it: usable, or with the reason why not.
struct CheckedPose {
    Pose pose;
    std::string fault;  // empty: the pose is usable
    bool usable() const { return fault.empty(); }
};

/// From 16 numbers, row-major. A fault: numbers that are not finite, a last row other than
/// 0 0 0 1, or a rotation whose determinant is off 1 or whose columns are off orthonormal by more
/// than 1e-3. Smaller deviations are taken out: the nearest orthonormal matrix is returned.
CheckedPose pose_from_rows(std::span<const double, 16> rows);

/// From tx ty tz qx qy qz qw. A fault: numbers that are not finite, or a quaternion whose length is
/// off 1 by more than 1e-3; smaller deviations are normalised away.
CheckedPose pose_from_quaternion(std::span<const double, 7> values);

struct TimedPose {
    std::int64_t time_ns = 0;
    CheckedPose world_from_camera;
};

/// In order of time, each time once.
struct Trajectory {
    std::vector<TimedPose> poses;
    std::vector<std::string> warnings;  // what was wrong with the file, if anything
};

/// Reads `t tx ty tz qx qy qz qw` a line, t in s. Rows out of order are sorted and rows with the
/// same stamp used once, both with a warning. Throws Error: input_missing, or bad_data with
/// file:line for text that is not such a row.
Trajectory read_tum_trajectory(const std::filesystem::path& file);

/// The usable poses of a trajectory as TUM text; numbers carry 15 digits, times 9 decimals.
std::string to_tum_text(const Trajectory& trajectory);

/// Writes to_tum_text. Throws Error: cannot_create, disk_fault.
void write_tum_trajectory(const std::filesystem::path& file, const Trajectory& trajectory);

/// One pose of a .log file, which counts frames instead of giving times.
struct LoggedPose {
    int index = 0;  // place of the frame in the recording, from 0
    CheckedPose world_from_camera;
};

/// Reads a Redwood .log: a line of three numbers, the first of them the index, then four rows of
/// the camera-to-world matrix. Throws Error as read_tum_trajectory.
std::vector<LoggedPose> read_log_trajectory(const std::filesystem::path& file);

struct InterpolationSettings {
    double max_gap = 0.1;    // s between the two poses, more is not bridged
    double max_hold = 1e-3;  // s before the first or after the last pose; files round their stamps
};

/// The pose at a time (ns): that of the row with exactly this stamp, else between its two
/// neighbours, translation linearly and rotation along the shortest arc; faulty where one of them
/// is. Empty where the trajectory does not reach or has too wide a gap.
std::optional<CheckedPose> interpolate_at(const Trajectory& trajectory, std::int64_t time_ns,
                                          const InterpolationSettings& settings = {});

}  // namespace inlay
