#include "apps/inlay/info_trajectory.h"

#include "recordings/base/check.h"
#include "recordings/readers/trajectory.h"
#include "slam/mapping/trajectory_error.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iostream>
#include <numbers>
#include <optional>
#include <vector>

namespace inlay {
namespace {

constexpr std::int64_t farthest_ns = 20'000'000;

struct Pairs {
    std::vector<Pose> estimated, reference;
    std::vector<std::int64_t> times;  // ns, of the estimated ones
    std::size_t unpaired = 0;
};

/// The usable pose of `trajectory` next to `time_ns`, no further than farthest_ns; null: none.
const TimedPose* nearest(const Trajectory& trajectory, std::int64_t time_ns) {
    const TimedPose* best = nullptr;
    const auto& poses = trajectory.poses;
    const auto after =
        std::lower_bound(poses.begin(), poses.end(), time_ns - farthest_ns,
                         [](const TimedPose& p, std::int64_t t) { return p.time_ns < t; });
    for (auto p = after; p != poses.end() && p->time_ns <= time_ns + farthest_ns; ++p) {
        if (!p->world_from_camera.usable()) continue;
        if (!best || std::abs(p->time_ns - time_ns) < std::abs(best->time_ns - time_ns)) best = &*p;
    }
    return best;
}

Pairs pair_up(const Trajectory& estimated, const Trajectory& reference) {
    Pairs pairs;
    for (const TimedPose& pose : estimated.poses) {
        const TimedPose* other =
            pose.world_from_camera.usable() ? nearest(reference, pose.time_ns) : nullptr;
        if (!other) {
            ++pairs.unpaired;
            continue;
        }
        pairs.estimated.push_back(pose.world_from_camera.pose);
        pairs.reference.push_back(other->world_from_camera.pose);
        pairs.times.push_back(pose.time_ns);
    }
    return pairs;
}

/// Frames in a second, by the median step; none where the trajectory is shorter.
std::optional<int> frames_per_second(const std::vector<std::int64_t>& times) {
    std::vector<std::int64_t> steps;
    for (std::size_t i = 1; i < times.size(); ++i)
        steps.push_back(times[i] - times[i - 1]);
    std::nth_element(steps.begin(), steps.begin() + std::ptrdiff_t(steps.size() / 2), steps.end());
    const double step = double(steps[steps.size() / 2]) * 1e-9;
    const double frames = std::max(1.0, std::round(1 / std::max(step, 1e-9)));
    if (frames >= double(times.size())) return std::nullopt;
    return int(frames);
}

double degrees(double radians) { return radians * 180 / std::numbers::pi; }

nlohmann::ordered_json json_of(const TrajectoryError& e) {
    return {{"rms_m", e.rms},
            {"mean_m", e.mean},
            {"largest_m", e.largest},
            {"rms_deg", degrees(e.rms_angle)}};
}

void print_line(const std::string& name, const TrajectoryError& e) {
    std::cout << fmt::format(
        "  {:<22} rms {:.2f} mm, mean {:.2f} mm, largest {:.2f} mm; {:.3f} deg\n", name,
        1000 * e.rms, 1000 * e.mean, 1000 * e.largest, degrees(e.rms_angle));
}

}  // namespace

void print_trajectory_errors(const std::filesystem::path& estimated,
                             const std::filesystem::path& reference, bool as_json) {
    const Pairs pairs = pair_up(read_tum_trajectory(estimated), read_tum_trajectory(reference));
    require(pairs.times.size() >= 2,
            estimated.string() + " and " + reference.string() + ": found " +
                std::to_string(pairs.times.size()) +
                " poses less than 20 ms apart, expected 2 or more; are both in seconds of the "
                "same clock?",
            ExitCode::bad_data);
    const TrajectoryError absolute = absolute_error(pairs.estimated, pairs.reference);
    const TrajectoryError step = relative_error(pairs.estimated, pairs.reference, 1);
    const std::optional<int> second = frames_per_second(pairs.times);
    std::optional<TrajectoryError> per_second;
    if (second) per_second = relative_error(pairs.estimated, pairs.reference, *second);
    if (as_json) {
        const nlohmann::ordered_json json{
            {"paired", pairs.times.size()},
            {"unpaired", pairs.unpaired},
            {"absolute", json_of(absolute)},
            {"relative_per_frame", json_of(step)},
            {"relative_per_second", per_second ? json_of(*per_second) : nlohmann::ordered_json()}};
        std::cout << json.dump(2) << "\n";
        return;
    }
    std::cout << fmt::format("{} against {}: {} poses paired, {} without a partner\n",
                             estimated.string(), reference.string(), pairs.times.size(),
                             pairs.unpaired);
    print_line("absolute (ATE)", absolute);
    print_line("relative, per frame", step);
    if (per_second) print_line("relative, per second", *per_second);
}

}  // namespace inlay
