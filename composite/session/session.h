// The frame loop: Session holds what survives from frame to frame, advance() is one frame.
#pragma once

#include "composite/blend/differential.h"
#include "composite/plan/effect_plan.h"
#include "composite/session/real_scene.h"
#include "composite/session/settings.h"
#include "composite/write/frame_report.h"
#include "recordings/base/rgbd_frame.h"
#include "render/sample/environment_sampler.h"
#include "render/scene/virtual_scene.h"
#include "render/trace/model_light.h"

#include <memory>

namespace inlay {

struct Session {
    Settings settings;
    VirtualScene scene;                // objects where they stand, in the recording's world
    std::vector<ObjectBounds> bounds;  // of the scene's objects, in their order
    EnvironmentSampler environment;
    LightRange light;                  // of the environment
    EnvironmentSampler no_light;       // in its place where the plan has no direct light
    double environment_bandwidth = 0;  // B_e, 1/rad; 0 without the filter

    std::shared_ptr<const Reconstruction> known;  // of the recording; null: tracked as frames come
    SlamState slam;                               // without it
    TracedModel model;
    std::unique_ptr<ModelLight> model_light;  // E_R of the model, as far as frames asked for it
    EmbreeSceneCache virtual_structures;
    std::shared_ptr<const NoisyLayers> previous;  // of the frame before, if it was sampled
    double time_before = 0;                       // s, of `previous`
    int frames_seen = 0;
};

/// With `known`, frames are composited on the finished model; without it, on the model that the
/// frames before have made. Throws Error for settings out of range or an environment that cannot be
/// sampled.
Session start_session(const Settings& settings, VirtualScene scene, EnvironmentMap environment,
                      std::shared_ptr<const Reconstruction> known = nullptr);

/// The model that frames are composited on.
const VoxelVolume& volume_of(const Session& session);

/// Whether E_R is kept on the model; one that still grows is made anew too often.
bool keeps_light(const Session& session);

/// What a plan looks at: the scene at `time` (s), with `time_before` that of the frame before, from
/// where `view` has its lens and its pose, and with its gain. References must outlive the result.
SceneInFrame in_frame(const Session& session, const SlamStep& view, double time,
                      double time_before);

/// How many frames the model of the next one has seen; a finished model does not grow.
inline int model_age(const Session& session) { return session.known ? 0 : session.frames_seen; }

/// How far to take a frame: a frame that is not shown may still be needed for the model, or for the
/// temporal filter of the next one.
enum class FrameWork { track, sample, compose };

/// What one frame became. Only `tracking` is filled by FrameWork::track.
struct OutputFrame {
    TrackResult tracking;
    Composite composite;
    EffectPlan plan;
    std::shared_ptr<const RealScene> real;     // null where nothing was simulated
    std::shared_ptr<const NoisyLayers> noisy;  // null where `real` is
    Layers layers;
    Image<Rgb> camera;  // the photograph, linear, at the reference exposure
    Rgb exposure{1};    // of the photograph, relative to that
    RayCounts rays;
    RayCounts gathering;  // of them, for light on the model that later frames find there
    std::uint64_t dropped_samples = 0;  // non-finite ones, left out of every mean
    StageTimes ms;
};

/// Samples `frame` against its real scene as `plan` says, E_R where `demand` does.
TwoModeResult sample(Session& session, const RealScene& real, const RgbdFrame& frame,
                     const EffectPlan& plan, const SamplingSettings& settings,
                     const LightDemand& demand = {});

/// One frame, from sensor to screen. Without a known recording frames must come in order, from the
/// first.
OutputFrame advance(Session& session, const RgbdFrame& frame, FrameWork work);

}  // namespace inlay
