// RealScene: the real surfaces of one frame, ready to be traced.
#pragma once

#include "composite/session/known_recording.h"
#include "composite/session/settings.h"
#include "recordings/base/surface_map.h"
#include "render/trace/embree_scene.h"
#include "render/trace/real_geometry.h"

#include <memory>

namespace inlay {

/// Tracks one frame, fuses it and raycasts the model, without a look ahead. With recorded poses
/// nothing is tracked, and a frame that has none is lost: it has no surface and leaves the model as
/// it is.
SlamStep track_frame_of(SlamState& slam, const RgbdFrame& frame, const Settings& settings);

/// Where the camera that took a frame's photograph was, and its exposure; of the surface, nothing
/// but lens and pose yet. Its depth is read by nobody.
SlamStep known_view_of(const Reconstruction& known, const RgbdFrame& frame);

/// What the finished model shows to the camera of known_view_of().
SurfaceMap known_surface_of(const Reconstruction& known, const RgbdFrame& frame,
                            const SlamStep& view, const Settings& settings);

/// Both.
SlamStep known_frame_of(const Reconstruction& known, const RgbdFrame& frame,
                        const Settings& settings);

/// No surface of these that a camera ray meets lies farther (m, along z).
double farthest_seen(const Settings& settings);

/// Keeps what its RealGeometry refers to; movable, since all of it lies behind pointers.
struct RealScene {
    std::shared_ptr<const SurfaceMap> surface;
    std::shared_ptr<const Image<Rgb>> photo;           // linear
    std::shared_ptr<const EmbreeScene> mesh;           // the map's or the model's triangles
    std::shared_ptr<const SurfaceMap> traced_surface;  // for RealGeometryKind::screen
    std::shared_ptr<const Image<Rgb>> traced_photo;
    RealGeometry geometry;
};

/// The fused model as the tracer needs it, made anew every few frames.
struct TracedModel {
    EmbreeSceneCache cache;
    std::shared_ptr<const EmbreeScene> mesh;
    int frame = -1;  // how many frames the model had seen when it was made
};

/// The frame whose model stands after `frames_seen` frames: every `interval`-th one, and before the
/// first of these 1, 2, 4, ..., since a young model grows with every view.
int model_due(int frames_seen, int interval);

/// Whether update_model would extract the model.
bool model_is_due(const TracedModel& model, int frames_seen, const GeometrySettings& settings);

/// Extracts and prepares the model if the settings ask for it and it is due. `frames_seen` counts
/// the frames since the recording's first, whether or not they were composited.
void update_model(TracedModel& model, const VoxelVolume& volume, int frames_seen,
                  const GeometrySettings& settings);

/// `photo` has the surface map's size. `volume` gives the surface that an undistorted lens would
/// see, which the screen tracer needs; `model` the mesh for RealGeometryKind::model.
RealScene describe_real_scene(SurfaceMap surface, Image<Rgb> photo, const VoxelVolume& volume,
                              const TracedModel& model, const Settings& settings);

}  // namespace inlay
