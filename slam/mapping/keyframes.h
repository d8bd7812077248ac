// Earlier views, small enough to compare with all of them, for finding the way back.
#pragma once

#include "recordings/base/image.h"
#include "recordings/base/pose.h"

#include <vector>

namespace inlay {

struct Keyframe {
    Pose world_from_camera;
    Image<float> thumbnail;  // inverse depth (1/m) of a few blocks, 0 = not measured
};

/// The view, as small as it is kept.
Image<float> make_thumbnail(const Image<float>& depth);

/// Adds the view if it is 0.25 m or 15 degrees away from every view kept so far.
void remember_view(std::vector<Keyframe>& keyframes, const Pose& world_from_camera,
                   const Image<float>& depth);

/// The poses of the `count` kept views that look most like `depth`, best first.
std::vector<Pose> similar_views(const std::vector<Keyframe>& keyframes, const Image<float>& depth,
                                int count);

}  // namespace inlay
