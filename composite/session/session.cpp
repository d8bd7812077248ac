#include "composite/session/session.h"

#include "composite/session/obey_plan.h"
#include "composite/session/stop_watch.h"
#include "render/filter/environment_bandwidth.h"
#include "render/filter/light_demand.h"

#include <utility>

namespace inlay {
namespace {

/// What the composite shows of E_R, if the settings ask for no more. `previous` must outlive it.
LightDemand demand_of(const Settings& settings, const NoisyLayers* previous) {
    const bool all_is_read = settings.trace.estimator == Estimator::two_mode &&
                             settings.filter.enabled && settings.filter.temporal;
    if (!settings.skip || all_is_read) return {};
    return [&filter = settings.filter, previous](const auto& touched, const NoisyLayers& now) {
        return light_demand(touched, now, previous, filter);
    };
}

/// The known model, where a frame calls for it.
void see_known(Session& session, const RgbdFrame& frame, SlamStep& slam) {
    slam.surface = known_surface_of(*session.known, frame, slam, session.settings);
    update_model(session.model, session.known->volume, 0, session.settings.geometry);
}

}  // namespace

const VoxelVolume& volume_of(const Session& session) {
    return session.known ? session.known->volume : session.slam.volume;
}

bool keeps_light(const Session& session) {
    const Settings& settings = session.settings;
    return session.known && settings.geometry.kind == RealGeometryKind::model &&
           takes_model_light(settings.trace);
}

SceneInFrame in_frame(const Session& session, const SlamStep& view, double time,
                      double time_before) {
    SceneInFrame in{
        session.scene, session.bounds, view.surface.lens, view.tracking.world_from_camera,
        time,          time_before};
    in.exposure = view.gain;
    in.lit = session.environment.mean_luminance > 0;
    in.light = session.light;
    in.farthest = farthest_seen(session.settings);
    in.offset = double(session.settings.geometry.offset);
    return in;
}

Session start_session(const Settings& settings, VirtualScene scene, EnvironmentMap environment,
                      std::shared_ptr<const Reconstruction> known) {
    validate(settings);
    Session session;
    session.settings = settings;
    session.scene = std::move(scene);
    session.bounds = bounds_of(session.scene);
    if (settings.filter.enabled)
        session.environment_bandwidth = environment_bandwidth(environment.radiance);
    session.light = light_range(environment);
    session.environment = make_environment_sampler(std::move(environment));
    session.no_light = no_light();
    session.slam = start_slam(settings.slam);
    session.known = std::move(known);
    return session;
}

namespace {

/// E_R as it is known of the model; null where it is not kept.
ModelLight* kept_light(Session& session, const RealScene& real, const EnvironmentSampler& light) {
    if (!keeps_light(session)) return nullptr;
    return keep_model_light(session.model_light, real.mesh, light, session.settings.trace,
                            session.settings.geometry.offset);
}

}  // namespace

TwoModeResult sample(Session& session, const RealScene& real, const RgbdFrame& frame,
                     const EffectPlan& plan, const SamplingSettings& settings,
                     const LightDemand& demand) {
    const EmbreeScene objects =
        session.virtual_structures.place(session.scene, frame.time, /*real=*/false);
    const bool lit = plan.has("environment_direct");
    const EnvironmentSampler& light = lit ? session.environment : session.no_light;
    const TwoModeScene scene{real.surface->lens,
                             real.surface->world_from_camera,
                             real.geometry,
                             objects,
                             light,
                             kept_light(session, real, light)};
    return sample_two_modes(scene, planned_sampling(plan, settings), std::uint32_t(frame.index),
                            demand);
}

OutputFrame advance(Session& session, const RgbdFrame& frame, FrameWork work) {
    const Settings& settings = session.settings;
    OutputFrame out;
    StopWatch watch;

    SlamStep slam = session.known ? known_view_of(*session.known, frame)
                                  : track_frame_of(session.slam, frame, settings);
    out.tracking = slam.tracking;
    if (slam.surface.lens.width == 0) slam.surface.lens = frame.lens;  // lost before any surface
    if (!session.known)
        update_model(session.model, session.slam.volume, session.frames_seen, settings.geometry);
    ++session.frames_seen;
    out.ms.slam = watch.lap();
    const std::shared_ptr<const NoisyLayers> previous = std::exchange(session.previous, nullptr);
    if (work == FrameWork::track) return out;

    SceneFacts facts = gather_facts(in_frame(session, slam, frame.time, session.time_before));
    session.time_before = frame.time;
    facts.tracked = slam.tracking.status != TrackingStatus::lost;
    facts.first_frame = !previous;
    facts.light_kept = keeps_light(session);
    out.plan = plan_effects(facts, settings.trace, settings.filter);
    out.exposure = slam.gain;
    Photo photo = linearise(frame.color, out.exposure);
    out.ms.plan = watch.lap();

    if (out.plan.has("environment_indirect")) {
        if (session.known) see_known(session, frame, slam);
        out.ms.slam += watch.lap();
        out.real = std::make_shared<const RealScene>(describe_real_scene(
            std::move(slam.surface), photo.linear, volume_of(session), session.model, settings));
        TwoModeResult sampled = sample(session, *out.real, frame, out.plan, settings.trace,
                                       demand_of(settings, previous.get()));
        out.rays = sampled.rays;
        out.gathering = sampled.gathering;
        out.rays += out.gathering;
        out.dropped_samples = sampled.layers.dropped_samples;
        session.previous = std::make_shared<const NoisyLayers>(std::move(sampled.layers));
        out.ms.trace = watch.lap();
    }
    if (work == FrameWork::sample) return out;

    out.noisy = session.previous;
    out.layers = planned_layers(out.plan, {out.noisy.get(), previous.get()}, photo.linear,
                                session.environment_bandwidth, settings.filter);
    out.ms.filter = watch.lap();

    out.composite = composite(photo, out.layers, settings.blend);
    out.camera = std::move(photo.linear);
    out.ms.composite = watch.lap();
    return out;
}

}  // namespace inlay
