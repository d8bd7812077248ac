// Motions between views that meet again.
#pragma once

#include "recordings/base/surface_map.h"
#include "slam/landmarks/landmarks.h"
#include "slam/mapping/pose_graph.h"
#include "slam/track/track_frame.h"

#include <span>
#include <vector>

namespace inlay {

/// A view that later ones are compared with.
struct LoopView {
    std::vector<SurfaceMap> pyramid;  // in the camera's frame, small, finest first
    Pose world_from_camera;
    Landmarks landmarks{};
};

/// A view for loops from what a frame saw, at about 160 px across.
LoopView make_loop_view(const SurfaceMap& seen, const Pose& world_from_camera,
                        Landmarks landmarks = {});

/// The motions from each view to the next, found by ICP of the one with the other; as the poses
/// have them where that fails. They know nothing of a camera that was drawn back, at a loop's end,
/// to a part of the model from which it had drifted away.
std::vector<PoseEdge> chain_edges(std::span<const LoopView> views, const TrackSettings& settings);

/// Motions between views that are not neighbours but show the same surfaces from where they stand,
/// or, where none of these was found for a view, the same landmarks from wherever: found by ICP of
/// the one with the other.
std::vector<PoseEdge> find_loops(std::span<const LoopView> views, const TrackSettings& settings);

/// How far (m, rad) the poses' motion is from an edge's.
struct LoopError {
    double distance = 0, angle = 0;
};
LoopError loop_error(const PoseEdge& edge, std::span<const LoopView> views);

}  // namespace inlay
