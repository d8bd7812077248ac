#include "slam/mapping/see_model.h"

#include "slam/mapping/observe_frame.h"

#include <algorithm>
#include <utility>

namespace inlay {

void forget(SurfaceMap& surface) {
    std::fill(surface.confidence.pixels.begin(), surface.confidence.pixels.end(), 0.0f);
}

SurfaceMap completed(SurfaceMap model, const SurfaceMap& own, const RaycastSettings& settings) {
    for (std::size_t i = 0; i < model.position.pixels.size(); ++i) {
        if (model.position.pixels[i].z > 0 || own.position.pixels[i].z <= 0) continue;
        model.position.pixels[i] = own.position.pixels[i];
        model.normal.pixels[i] = own.normal.pixels[i];
        model.confidence.pixels[i] = std::min(1.0f, 1.0f / settings.full_confidence);
    }
    return model;
}

SurfaceMap see_model(const VoxelVolume& volume, const RgbdFrame& frame, const TrackResult& tracking,
                     const SlamSettings& settings) {
    const Pose& pose = tracking.world_from_camera;
    SurfaceMap model = raycast_volume(volume, frame.lens, pose, settings.raycast);
    if (tracking.status == TrackingStatus::lost) {
        forget(model);
        return model;
    }
    return completed(std::move(model), own_surface(frame, pose, settings.depth), settings.raycast);
}

}  // namespace inlay
