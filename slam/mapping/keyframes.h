// Earlier views, small enough to compare with all of them, for finding the way back.
#pragma once

#include "recordings/base/image.h"
#include "recordings/base/pose.h"
#include "slam/landmarks/landmarks.h"

#include <vector>

namespace inlay {

struct Keyframe {
    Pose world_from_camera;
    Image<float> thumbnail;  // inverse depth (1/m) of a few blocks, 0 = not measured
    Landmarks landmarks{};   // none where it had no photograph, or a small one
};

/// The view, as small as it is kept.
Image<float> make_thumbnail(const Image<float>& depth);

/// Adds the view if it is 0.25 m or 15 degrees away from every view kept so far; says whether it
/// was.
bool remember_view(std::vector<Keyframe>& keyframes, const Pose& world_from_camera,
                   const Image<float>& depth);

/// The poses of the `count` kept views that look most like `depth`, best first.
std::vector<Pose> similar_views(const std::vector<Keyframe>& keyframes, const Image<float>& depth,
                                int count);

/// Where the camera that saw `landmarks` is, by what it shares with the kept views that look most
/// like it: up to `count` poses, of the views with most in common first.
std::vector<Pose> poses_by_landmarks(const std::vector<Keyframe>& keyframes,
                                     const Landmarks& landmarks, int count);

}  // namespace inlay
