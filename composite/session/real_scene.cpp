#include "composite/session/real_scene.h"

#include "slam/mesh/extract_mesh.h"

#include <utility>

namespace inlay {

void update_model(TracedModel& model, const SlamState& slam, int frames_seen,
                  const GeometrySettings& settings) {
    if (settings.kind != RealGeometryKind::model) return;
    const int due = frames_seen - frames_seen % settings.model_interval;
    if (model.frame == due) return;
    auto mesh = std::make_shared<const TriangleMesh>(extract_mesh(slam.volume));
    model.mesh = std::make_shared<const EmbreeScene>(model.cache.place(std::move(mesh)));
    model.frame = due;
}

RealScene describe_real_scene(SurfaceMap surface, Image<Rgb> photo, const SlamState&,
                              const TracedModel& model, const Settings& settings) {
    RealScene real;
    real.surface = std::make_shared<const SurfaceMap>(std::move(surface));
    real.photo = std::make_shared<const Image<Rgb>>(std::move(photo));
    const PhotographedSurface seen{*real.surface, *real.photo};
    const GeometrySettings& geometry = settings.geometry;
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
