#include "recordings/readers/trajectory.h"

#include "recordings/base/check.h"
#include "recordings/readers/text_file.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace inlay {
namespace fs = std::filesystem;
namespace {

constexpr double rotation_tolerance = 1e-3;

std::string shown(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", value);
    return text;
}

bool all_finite(std::span<const double> values) {
    return std::ranges::all_of(values, [](double v) { return std::isfinite(v); });
}

double largest_deviation(const glm::dmat3& m) {
    const glm::dmat3 difference = glm::transpose(m) * m - glm::dmat3(1.0);
    double largest = 0;
    for (int c = 0; c < 3; ++c)
        for (int r = 0; r < 3; ++r)
            largest = std::max(largest, std::abs(difference[c][r]));
    return largest;
}

/// The orthogonal factor of the polar decomposition by Newton's iteration (Higham 1986, Sec. 2:
/// X <- (X + X^-T) / 2), which converges quadratically; from 1e-3 three steps reach rounding.
glm::dmat3 nearest_rotation(glm::dmat3 m) {
    for (int i = 0; i < 4; ++i)
        m = 0.5 * (m + glm::transpose(glm::inverse(m)));
    return m;
}

CheckedPose faulty(const std::string& fault) { return {{}, fault}; }

TimedPose parse_tum_row(const fs::path& file, const TextLine& line) {
    const std::string expected = "'t tx ty tz qx qy qz qw' with t in decimal seconds";
    const auto found = words(line.text);
    if (found.size() != 8) fail_at(file, line, expected);
    const auto time = parse_time_ns(found[0]);
    if (!time) fail_at(file, line, expected);
    std::array<double, 7> values{};
    for (std::size_t i = 0; i < 7; ++i) {
        const auto value = parse_number(found[i + 1]);
        if (!value) fail_at(file, line, expected);
        values[i] = *value;
    }
    return {*time, pose_from_quaternion(values)};
}

/// Sorts by time and keeps the first of equal stamps; says so in the warnings.
void put_in_order(Trajectory& trajectory, const fs::path& file) {
    auto& poses = trajectory.poses;
    const auto backwards = std::ranges::adjacent_find(
        poses, [](const TimedPose& a, const TimedPose& b) { return b.time_ns < a.time_ns; });
    if (backwards != poses.end()) {
        std::ranges::stable_sort(poses, {}, &TimedPose::time_ns);
        trajectory.warnings.push_back(file.string() + ": time goes backwards; rows were sorted");
    }
    const auto same = [](const auto& a, const auto& b) { return a.time_ns == b.time_ns; };
    const auto repeated = std::unique(poses.begin(), poses.end(), same);
    if (repeated != poses.end())
        trajectory.warnings.push_back(file.string() + ": " +
                                      std::to_string(poses.end() - repeated) +
                                      " rows repeat a stamp; the first of each was used");
    poses.erase(repeated, poses.end());
}

void append_row(std::string& text, const TimedPose& timed) {
    const Pose& pose = timed.world_from_camera.pose;
    const glm::dquat q = glm::normalize(glm::quat_cast(pose.rotation));
    const std::int64_t ns = timed.time_ns;
    char row[320];
    std::snprintf(row, sizeof row, "%s%lld.%09lld %.15g %.15g %.15g %.15g %.15g %.15g %.15g\n",
                  ns < 0 ? "-" : "", static_cast<long long>(std::abs(ns) / 1'000'000'000),
                  static_cast<long long>(std::abs(ns) % 1'000'000'000), pose.translation.x,
                  pose.translation.y, pose.translation.z, q.x, q.y, q.z, q.w);
    text += row;
}

}  // namespace

CheckedPose pose_from_rows(std::span<const double, 16> rows) {
    if (!all_finite(rows)) return faulty("it has numbers that are not finite");
    const double last_row[] = {0, 0, 0, 1};
    for (std::size_t i = 0; i < 4; ++i)
        if (std::abs(rows[12 + i] - last_row[i]) > 1e-6)
            return faulty("its last row is not 0 0 0 1");
    Pose pose;
    for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c)
            pose.rotation[c][r] = rows[std::size_t(4) * std::size_t(r) + std::size_t(c)];
    pose.translation = {rows[3], rows[7], rows[11]};
    const double determinant = glm::determinant(pose.rotation);
    if (std::abs(determinant - 1) > rotation_tolerance)
        return faulty("its rotation has determinant " + shown(determinant) + ", expected 1");
    const double deviation = largest_deviation(pose.rotation);
    if (deviation > rotation_tolerance)
        return faulty("its rotation is off orthonormal by " + shown(deviation));
    pose.rotation = nearest_rotation(pose.rotation);
    return {pose, {}};
}

CheckedPose pose_from_quaternion(std::span<const double, 7> v) {
    if (!all_finite(v)) return faulty("it has numbers that are not finite");
    const glm::dquat q{v[6], v[3], v[4], v[5]};  // GLM: w first
    const double length = glm::length(q);
    if (std::abs(length - 1) > rotation_tolerance)
        return faulty("its quaternion has length " + shown(length) + ", expected 1");
    return {{glm::mat3_cast(glm::normalize(q)), {v[0], v[1], v[2]}}, {}};
}

Trajectory read_tum_trajectory(const fs::path& file) {
    Trajectory trajectory;
    for (const TextLine& line : read_lines(file))
        trajectory.poses.push_back(parse_tum_row(file, line));
    put_in_order(trajectory, file);
    return trajectory;
}

std::string to_tum_text(const Trajectory& trajectory) {
    std::string text = "# timestamp tx ty tz qx qy qz qw\n";
    for (const TimedPose& timed : trajectory.poses)
        if (timed.world_from_camera.usable()) append_row(text, timed);
    return text;
}

void write_tum_trajectory(const fs::path& file, const Trajectory& trajectory) {
    write_text(file, to_tum_text(trajectory));
}

std::vector<LoggedPose> read_log_trajectory(const fs::path& file) {
    const std::vector<TextLine> lines = read_lines(file);
    std::vector<LoggedPose> poses;
    for (std::size_t at = 0; at < lines.size(); at += 5) {
        const double index = parse_numbers(file, lines[at], 3)[0];
        if (!(index >= 0 && index < 1e9)) fail_at(file, lines[at], "a frame index of 0 or more");
        if (at + 5 > lines.size()) fail_at(file, lines[at], "four rows of a matrix after it");
        std::array<double, 16> rows{};
        for (std::size_t r = 0; r < 4; ++r)
            std::ranges::copy(parse_numbers(file, lines[at + 1 + r], 4),
                              rows.begin() + std::ptrdiff_t(4 * r));
        poses.push_back({int(index), pose_from_rows(rows)});
    }
    return poses;
}

std::optional<CheckedPose> interpolate_at(const Trajectory& trajectory, std::int64_t time_ns,
                                          const InterpolationSettings& settings) {
    const auto& poses = trajectory.poses;
    if (poses.empty()) return std::nullopt;
    const auto after = std::ranges::lower_bound(poses, time_ns, {}, &TimedPose::time_ns);
    if (after != poses.end() && after->time_ns == time_ns) return after->world_from_camera;
    if (after == poses.begin() || after == poses.end()) {
        const TimedPose& end = after == poses.begin() ? poses.front() : poses.back();
        const double away = std::abs(double(time_ns - end.time_ns)) * 1e-9;
        if (away > settings.max_hold) return std::nullopt;
        return end.world_from_camera;
    }
    const TimedPose& before = *std::prev(after);
    const auto gap = double(after->time_ns - before.time_ns);
    if (gap * 1e-9 > settings.max_gap) return std::nullopt;
    if (!before.world_from_camera.usable()) return before.world_from_camera;
    if (!after->world_from_camera.usable()) return after->world_from_camera;
    const double t = double(time_ns - before.time_ns) / gap;
    return CheckedPose{interpolate(before.world_from_camera.pose, after->world_from_camera.pose, t),
                       {}};
}

}  // namespace inlay
