#include "composite/session/render_view.h"

#include "composite/session/obey_plan.h"
#include "composite/session/stop_watch.h"
#include "recordings/base/check.h"
#include "render/filter/environment_bandwidth.h"
#include "render/trace/picture.h"
#include "render/trace/sample_pass.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace inlay {
namespace {

void stop_if_asked(const std::function<bool()>& asked_to_stop, const char* finished) {
    require(!asked_to_stop || !asked_to_stop(),
            std::string("render: interrupted after ") + finished + "; nothing was written",
            ExitCode::interrupted);
}

/// Both modes, with the view's exact real geometry.
void sample(const SceneView& view, const EmbreeScene& real_objects,
            const EmbreeScene& virtual_objects, const Settings& settings, OutputFrame& out) {
    const EnvironmentSampler darkness = no_light();
    const RealGeometry real =
        exact_real_geometry(real_objects, view.environment, first_path_dimension);
    SamplingSettings sampling = planned_sampling(out.plan, settings.trace);
    sampling.depth_tolerance = 0;  // this depth is exact
    const bool lit = out.plan.has("environment_direct");
    TwoModeResult sampled = sample_two_modes({view.lens, view.world_from_camera, real,
                                              virtual_objects, lit ? view.environment : darkness},
                                             sampling, 0);
    out.rays = sampled.rays;
    out.dropped_samples += sampled.layers.dropped_samples;
    out.noisy = std::make_shared<const NoisyLayers>(std::move(sampled.layers));
}

/// How far along z (m) the real objects reach.
double farthest_real(const SceneView& view, const std::vector<ObjectBounds>& bounds) {
    const glm::dmat4 camera_from_world = to_matrix(inverse(view.world_from_camera));
    double farthest = 0;
    for (std::size_t i = 0; i < bounds.size(); ++i) {
        const SceneObject& object = view.scene.objects[i];
        if (!object.real || bounds[i].empty()) continue;
        const Ball ball = ball_of(bounds[i], camera_from_world * transform_at(object, view.time));
        farthest = std::max(farthest, ball.centre.z + ball.radius);
    }
    return farthest;
}

}  // namespace

SceneFacts facts_of_view(const SceneView& view) {
    const std::vector<ObjectBounds> bounds = bounds_of(view.scene);
    SceneInFrame in{view.scene, bounds, view.lens, view.world_from_camera, view.time, view.time};
    in.lit = view.environment.mean_luminance > 0;
    in.light = light_range(view.environment.map);
    in.farthest = farthest_real(view, bounds);
    in.offset = double(surface_offset);
    SceneFacts facts = gather_facts(in);
    facts.first_frame = true;
    return facts;
}

OutputFrame render_view(const SceneView& view, const Settings& settings, int photo_samples,
                        const std::function<bool()>& asked_to_stop) {
    validate(settings);
    OutputFrame out;
    StopWatch watch;
    EmbreeSceneCache structures;
    const EmbreeScene real_objects = structures.place(view.scene, view.time, /*real=*/true);
    const EmbreeScene virtual_objects = structures.place(view.scene, view.time, /*real=*/false);
    out.plan = plan_effects(facts_of_view(view), settings.trace, settings.filter);
    out.ms.plan = watch.lap();

    const PictureView camera{view.lens, view.world_from_camera, settings.trace.seed, 0};
    Picture photo = trace_picture(real_objects, view.environment, camera, photo_samples);
    out.camera = std::move(photo.radiance);
    out.dropped_samples = photo.dropped_samples;
    stop_if_asked(asked_to_stop, "the photograph");
    if (out.plan.has("environment_indirect"))
        sample(view, real_objects, virtual_objects, settings, out);
    out.ms.trace = watch.lap();
    stop_if_asked(asked_to_stop, "tracing");

    const bool filtered = out.plan.has("axis_aligned_filter");
    out.layers = planned_layers(out.plan, {out.noisy.get(), nullptr}, out.camera,
                                filtered ? environment_bandwidth(view.environment.map.radiance) : 0,
                                settings.filter);
    out.ms.filter = watch.lap();
    stop_if_asked(asked_to_stop, "filtering");
    out.composite = composite({encode(out.camera), out.camera}, out.layers, settings.blend);
    out.ms.composite = watch.lap();
    return out;
}

}  // namespace inlay
