#include "composite/session/real_scene.h"

#include "recordings/base/parallel.h"
#include "render/trace/map_primary.h"
#include "render/trace/screen_real_geometry.h"
#include "slam/depth/smooth_normals.h"
#include "slam/mapping/color_camera.h"
#include "slam/mapping/see_model.h"
#include "slam/mesh/extract_mesh.h"

#include <algorithm>
#include <bit>
#include <utility>

namespace inlay {
namespace {

/// The photograph as a lens without distortion would have taken it; nearest pixels, black outside.
Image<Rgb> undistorted(const Image<Rgb>& photo, const Lens& lens) {
    Image<Rgb> result(photo.width, photo.height, Rgb(0));
    const Lens ideal = pinhole(lens);
    parallel_rows(photo.height, [&](int y) {
        for (int x = 0; x < photo.width; ++x) {
            const auto pixel = nearest_pixel(lens, project(lens, unproject(ideal, {x, y})));
            if (pixel) result(x, y) = photo(pixel->x, pixel->y);
        }
    });
    return result;
}

/// Rays are straight in the image of a pinhole only: a distorted lens takes a second map.
void march_in_image(RealScene& real, const VoxelVolume& volume, const Settings& settings) {
    real.traced_surface = real.surface;
    real.traced_photo = real.photo;
    const Lens& lens = real.surface->lens;
    if (distorted(lens)) {
        real.traced_surface = std::make_shared<const SurfaceMap>(raycast_volume(
            volume, pinhole(lens), real.surface->world_from_camera, settings.slam.raycast));
        real.traced_photo = std::make_shared<const Image<Rgb>>(undistorted(*real.photo, lens));
    }
    const ScreenTracerSettings screen = screen_settings(settings.geometry);
    auto pyramid =
        std::make_shared<const DepthPyramid>(make_depth_pyramid(*real.traced_surface, screen));
    real.geometry = screen_real_geometry({*real.traced_surface, *real.traced_photo},
                                         std::move(pyramid), screen);
    real.geometry.primary = [&map = *real.surface, tilt = screen.largest_tilt](
                                const RayPacket& rays, const auto& pixels) {
        return map_primary(map, rays, pixels, tilt);
    };
}

/// A lost frame, which teaches the model nothing; its pose is the last one known.
SlamStep without_pose(const SlamState& slam) {
    SlamStep step;
    if (slam.model) step.tracking.world_from_camera = slam.model->world_from_camera;
    return step;
}

/// With what the model leaves open: edges, and the normals of surfaces that were hardly seen.
SurfaceMap finished(SurfaceMap surface, const RgbdFrame& frame, const SlamStep& step,
                    const SlamSettings& settings) {
    if (step.tracking.status == TrackingStatus::lost) return surface;
    follow_photograph(surface, frame.color, settings.edges);
    surface.normal = smooth_normals(surface);
    return surface;
}

}  // namespace

SlamStep track_frame_of(SlamState& slam, const RgbdFrame& frame, const Settings& settings) {
    std::optional<Pose> known;
    if (settings.use_recorded_poses) {
        if (!frame.recorded_world_from_camera) return without_pose(slam);
        known = frame.recorded_world_from_camera;
    }
    SlamStep step = advance_slam(slam, frame, settings.slam, known);
    step.surface = finished(std::move(step.surface), frame, step, settings.slam);
    return step;
}

SlamStep known_view_of(const Reconstruction& known, const RgbdFrame& frame) {
    const int position = position_of(known, frame.index);
    SlamStep view;
    view.surface.lens = frame.lens;
    if (position < 0) return view;
    view.tracking = known.frames[std::size_t(position)].tracking;
    view.gain = known.frames[std::size_t(position)].gain;
    const ColorCamera camera = color_camera_of(known, position, frame.lens);
    Pose& pose = view.tracking.world_from_camera;
    if (color_is_apart(known)) pose = pose * inverse(camera.color_from_depth);
    view.surface.lens = camera.lens;
    view.surface.world_from_camera = pose;
    return view;
}

SurfaceMap known_surface_of(const Reconstruction& known, const RgbdFrame& frame,
                            const SlamStep& view, const Settings& settings) {
    if (!color_is_apart(known))
        return finished(see_model(known.volume, frame, view.tracking, settings.slam), frame, view,
                        settings.slam);
    SurfaceMap surface = raycast_volume(known.volume, view.surface.lens,
                                        view.tracking.world_from_camera, settings.slam.raycast);
    if (view.tracking.status == TrackingStatus::lost) forget(surface);
    return finished(std::move(surface), frame, view, settings.slam);
}

SlamStep known_frame_of(const Reconstruction& known, const RgbdFrame& frame,
                        const Settings& settings) {
    SlamStep step = known_view_of(known, frame);
    step.surface = known_surface_of(known, frame, step, settings);
    return step;
}

double farthest_seen(const Settings& settings) {
    const float tilt =
        std::max(settings.geometry.screen.largest_tilt, ScreenTracerSettings{}.largest_tilt);
    // Edges follow a plane twice; camera rays meet it tilted.
    const double followed = 1 + double(steepest_plane);
    return followed * followed * (1 + double(tilt)) *
           double(std::max(settings.slam.raycast.farthest, settings.slam.depth.farthest));
}

int model_due(int frames_seen, int interval) {
    if (frames_seen >= interval) return frames_seen - frames_seen % interval;
    return frames_seen == 0 ? 0 : int(std::bit_floor(unsigned(frames_seen)));
}

bool model_is_due(const TracedModel& model, int frames_seen, const GeometrySettings& settings) {
    if (settings.kind != RealGeometryKind::model) return false;
    return model.frame != model_due(frames_seen, settings.model_interval) ||
           model.mesh->parts().empty();
}

void update_model(TracedModel& model, const VoxelVolume& volume, int frames_seen,
                  const GeometrySettings& settings) {
    if (!model_is_due(model, frames_seen, settings)) return;
    auto mesh = std::make_shared<const TriangleMesh>(extract_mesh(volume));
    model.mesh = std::make_shared<const EmbreeScene>(model.cache.place(std::move(mesh)));
    model.frame = model_due(frames_seen, settings.model_interval);
}

RealScene describe_real_scene(SurfaceMap surface, Image<Rgb> photo, const VoxelVolume& volume,
                              const TracedModel& model, const Settings& settings) {
    RealScene real;
    real.surface = std::make_shared<const SurfaceMap>(std::move(surface));
    real.photo = std::make_shared<const Image<Rgb>>(std::move(photo));
    const PhotographedSurface seen{*real.surface, *real.photo};
    const GeometrySettings& geometry = settings.geometry;
    if (geometry.kind == RealGeometryKind::screen) {
        march_in_image(real, volume, settings);
        return real;
    }
    if (geometry.kind == RealGeometryKind::model) {
        real.mesh = model.mesh;
    } else {
        auto mesh = std::make_shared<const TriangleMesh>(triangulate(seen, geometry.max_step));
        real.mesh = std::make_shared<const EmbreeScene>(EmbreeSceneCache().place(std::move(mesh)));
    }
    real.geometry =
        mesh_real_geometry(seen, *real.mesh, geometry.offset, geometry.visibility_tolerance);
    return real;
}

}  // namespace inlay
