#include "composite/session/render_view.h"

#include "composite/session/stop_watch.h"
#include "render/filter/environment_bandwidth.h"
#include "render/filter/filter_layers.h"
#include "render/trace/picture.h"
#include "render/trace/sample_pass.h"

#include <utility>

namespace inlay {
SceneFacts facts_of_view(const SceneView& view) {
    SceneFacts facts =
        gather_facts(view.scene, view.environment.mean_luminance > 0, view.time, view.time);
    facts.first_frame = true;
    return facts;
}

OutputFrame render_view(const SceneView& view, const Settings& settings, int photo_samples) {
    validate(settings);
    OutputFrame out;
    StopWatch watch;
    EmbreeSceneCache structures;
    const EmbreeScene real_objects = structures.place(view.scene, view.time, /*real=*/true);
    const EmbreeScene virtual_objects = structures.place(view.scene, view.time, /*real=*/false);
    out.plan = plan_effects(facts_of_view(view), settings.filter);
    out.ms.plan = watch.lap();

    const PictureView camera{view.lens, view.world_from_camera, settings.trace.seed, 0};
    out.camera = trace_picture(real_objects, view.environment, camera, photo_samples).radiance;
    const RealGeometry real =
        exact_real_geometry(real_objects, view.environment, first_path_dimension);
    SamplingSettings sampling = settings.trace;
    sampling.depth_tolerance = 0;  // this depth is exact
    TwoModeResult sampled = sample_two_modes(
        {view.lens, view.world_from_camera, real, virtual_objects, view.environment}, sampling, 0);
    out.rays = sampled.rays;
    out.noisy = std::make_shared<const NoisyLayers>(std::move(sampled.layers));
    out.ms.trace = watch.lap();

    out.layers = filter_layers(
        *out.noisy, nullptr, environment_bandwidth(view.environment.map.radiance), settings.filter);
    out.ms.filter = watch.lap();
    out.composite = composite({encode(out.camera), out.camera}, out.layers, settings.blend);
    out.ms.composite = watch.lap();
    return out;
}

}  // namespace inlay
