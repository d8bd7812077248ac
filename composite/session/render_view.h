// One view of a scene without a recording: exact objects stand in for the real surfaces, and their
// own picture for the photograph.
#pragma once

#include "composite/session/session.h"

#include <functional>

namespace inlay {

struct SceneView {
    const VirtualScene& scene;  // objects flagged `real` are the real ones
    const EnvironmentSampler& environment;
    Lens lens;
    Pose world_from_camera;
    double time = 0;  // s
};

/// What the plan of a view looks at.
SceneFacts facts_of_view(const SceneView& view);

/// Runs both modes with exact real geometry, filters and composites (Mehta 2015, ch. 6). The
/// photograph is the path-traced picture of the real objects alone with `photo_samples` paths per
/// pixel; without real objects it is the environment as the camera sees it. settings.slam and
/// settings.geometry have no meaning here. Throws Error (interrupted) between two passes once
/// `asked_to_stop`, which may be empty, says so.
OutputFrame render_view(const SceneView& view, const Settings& settings, int photo_samples,
                        const std::function<bool()>& asked_to_stop = {});

}  // namespace inlay
