// TrackedFrame: a frame up to where sampling starts: pose, real surfaces, photograph.
#pragma once

#include "composite/accuracy/work.h"
#include "composite/blend/photo.h"
#include "composite/session/real_scene.h"
#include "render/trace/model_light.h"

#include <map>
#include <memory>
#include <vector>

namespace inlay {

/// What frames of one model keep of its light, by seed.
struct KeptLight {
    std::map<std::uint32_t, std::unique_ptr<ModelLight>> by_seed;
};

/// Everything that does not depend on the samples. Movable and cheap to copy.
struct TrackedFrame {
    int frame = 0;    // the recording's number
    double time = 0;  // s
    TrackResult tracking;
    Lens lens;
    Pose world_from_camera;
    std::shared_ptr<const Photo> photo;
    std::shared_ptr<const RealScene> room;          // of a recording
    std::shared_ptr<const EmbreeScene> exact_room;  // of a scene, or where truth stands in
    RealGeometry geometry;                          // refers to one of the two
    std::shared_ptr<KeptLight> kept;                // of a finished model; null: nothing is kept
    float depth_tolerance = 0;                      // share of depth, as SamplingSettings
    double slam_ms = 0;                             // wall time of its tracking and fusion
};

/// What the sensor measured, or exactly what it should have.
enum class SensorDepth { recorded, exact };

/// Tracks the recording from its first frame and keeps the named frames (ascending), which must be
/// the recording's. SensorDepth::exact takes depth from the work's own room (Error without one).
std::vector<TrackedFrame> track_frames(const Work& work, const std::vector<int>& frames,
                                       const Settings& settings,
                                       SensorDepth depth = SensorDepth::recorded);

/// The same frame with the truth in place of what was reconstructed: true pose, exact surfaces that
/// radiate as the scene says. Throws Error where the work does not know its room.
TrackedFrame with_true_room(const Work& work, const TrackedFrame& frame,
                            const Pose& world_from_camera);

/// The view of a scene, photographed with `photo_samples` paths per pixel.
TrackedFrame photograph_view(const Work& work, std::uint32_t seed, int photo_samples);

}  // namespace inlay
