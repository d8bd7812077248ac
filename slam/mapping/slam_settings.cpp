#include "slam/mapping/slam_settings.h"

#include <algorithm>

namespace inlay {

SlamSettings accurate_slam() { return {}; }

SlamSettings fast_slam() {
    SlamSettings settings;
    settings.look_ahead = false;
    settings.half_resolution = true;
    settings.depth.smoothing_radius = 2;
    settings.fusion.voxel_size = 0.012f;
    settings.fusion.truncation = 0.048f;
    settings.track.iterations = 6;
    return settings;
}

SlamSettings first_pass_of(const SlamSettings& settings) {
    const SlamSettings fast = fast_slam();
    SlamSettings first = settings;
    first.look_ahead = false;
    first.half_resolution = true;
    first.follow_exposure = false;  // its colors are thrown away
    const float larger = std::min(1.5f, 1 / settings.fusion.voxel_size);  // 1 m at most
    first.fusion.voxel_size *= larger;
    first.fusion.truncation *= larger;
    first.track.iterations = std::min(settings.track.iterations, fast.track.iterations);
    return first;
}

void validate(const SlamSettings& settings) {
    validate(settings.depth);
    validate(settings.fusion);
    validate(settings.raycast);
    validate(settings.track);
    validate(settings.edges);
}

}  // namespace inlay
