#include "composite/accuracy/unit.h"

#include "composite/blend/differential.h"
#include "composite/measure/flicker.h"
#include "render/filter/filter_layers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <utility>

namespace inlay {
namespace {

constexpr std::uint32_t reference_seed_offset = 0xacc0;
/// Frame numbers, far from any recording's, under which a still frame is sampled again.
constexpr std::uint32_t still_index = 0x40000000;

/// The samplings of one frame that methods need.
struct Samplings {
    SampledFrame now;
    std::optional<SampledFrame> previous;
    std::vector<SampledFrame> still;  // two more of the same view, or none
};

const NoisyLayers* layers_of(const std::optional<SampledFrame>& frame) {
    return frame ? &frame->result.layers : nullptr;
}

/// Those of one estimator; none where no cell takes them.
std::optional<Samplings> take_samples(const Work& work, const JudgedFrame& frame,
                                      const UnitPlan& plan, Estimator estimator) {
    SamplingSettings sampling = plan.settings.trace;
    sampling.estimator = estimator;
    bool asked = false;
    for (const MethodCell& cell : plan.cells) {
        if (cell.method->estimator != estimator) continue;
        asked = true;
        sampling.unshadowed = sampling.unshadowed || cell.method->needs_unshadowed;
    }
    if (!asked) return std::nullopt;
    const auto index = std::uint32_t(frame.now.frame);
    Samplings taken;
    if (frame.previous) taken.previous = sample_frame(work, *frame.previous, sampling, index - 1);
    taken.now = sample_frame(work, frame.now, sampling, index);
    for (std::uint32_t i = 0; plan.with_flicker && i < 2; ++i)
        taken.still.push_back(sample_frame(work, frame.now, sampling, still_index + i));
    return taken;
}

struct Made {
    Composite picture;
    Cost filter, composite;
};

Made make(const Work& work, const TrackedFrame& frame, const NoisyLayers& now,
          const NoisyLayers* previous, const UnitPlan& plan, const MethodCell& cell) {
    Made made;
    CostWatch watch;
    const Layers layers =
        cell.method->apply({now, cell.temporal ? previous : nullptr, work.environment_bandwidth,
                            plan.settings.filter, work.open_sky, cell.width});
    made.filter = watch.lap();
    made.picture = composite(*frame.photo, layers, plan.settings.blend);
    made.composite = watch.lap();
    return made;
}

/// RMS difference of two pictures of a still camera, over the pixels that objects influence.
double still_flicker(const Work& work, const JudgedFrame& frame, const Samplings& taken,
                     const UnitPlan& plan, const MethodCell& cell) {
    const std::array<const NoisyLayers*, 3> s{
        &taken.now.result.layers, &taken.still[0].result.layers, &taken.still[1].result.layers};
    const Made a = make(work, frame.now, *s[1], s[0], plan, cell);
    const Made b = make(work, frame.now, *s[2], s[1], plan, cell);
    const Mask& mask = (frame.converged ? frame.converged : frame.truth)->influenced;
    const Image<Rgb> still;  // the truth of a still camera does not change
    FlickerSums sums;
    add_flicker(sums, {a.picture.linear, still}, {b.picture.linear, still}, mask);
    return flicker_of(sums).rms;
}

void judge(const Work& work, const JudgedFrame& frame, const Samplings& taken, const UnitPlan& plan,
           const MethodCell& cell, const Composite& picture, MethodRun& run) {
    if (frame.converged)
        run.converged = error_against(*frame.converged, picture.linear, picture.display);
    if (frame.truth) run.truth = error_against(*frame.truth, picture.linear, picture.display);
    const bool influenced = (run.converged && run.converged->influenced) ||
                            (!run.converged && run.truth && run.truth->influenced);
    if (!taken.still.empty() && influenced)
        run.flicker = still_flicker(work, frame, taken, plan, cell);
}

MethodRun run_method(const Work& work, const JudgedFrame& frame, const Samplings& taken,
                     const UnitPlan& plan, const MethodCell& cell) {
    MethodRun run;
    run.method = cell.method->name;
    run.temporal = cell.temporal;
    run.width = cell.width;
    run.frame = frame.now.frame;
    try {
        const Made made =
            make(work, frame.now, taken.now.result.layers, layers_of(taken.previous), plan, cell);
        run.filter = made.filter;
        run.composite = made.composite;
        if (plan.judge) judge(work, frame, taken, plan, cell, made.picture, run);
    } catch (const std::exception& error) {
        run.failed = error.what();
    }
    return run;
}

Work with_lights(const Work& work, int light_list, std::uint32_t seed) {
    Work result = work;
    if (light_list > 0)
        result.environment = make_light_list(work.environment.map, light_list, seed);
    return result;
}

}  // namespace

SampledFrame sample_frame(const Work& work, const TrackedFrame& frame,
                          const SamplingSettings& sampling, std::uint32_t index) {
    const EmbreeScene objects = EmbreeSceneCache().place(work.scene, frame.time, /*real=*/false);
    SamplingSettings settings = sampling;
    settings.depth_tolerance = frame.depth_tolerance;
    TwoModeScene scene{frame.lens, frame.world_from_camera, frame.geometry, objects,
                       work.environment};
    if (frame.kept)
        scene.model_light = keep_model_light(frame.kept->by_seed[settings.seed], frame.room->mesh,
                                             work.environment, settings, frame.geometry.offset);
    const auto sample = [&] {
        CostWatch watch;
        SampledFrame sampled;
        sampled.result = sample_two_modes(scene, settings, index);
        sampled.cost = watch.lap();
        return sampled;
    };
    SampledFrame sampled = sample();
    // The cost is that of a frame whose E_R the frames before have gathered: the same again.
    if (sampled.result.gathering.real_indirect > 0) sampled = sample();
    return sampled;
}

SamplingSettings many_samples(SamplingSettings sampling, int samples) {
    constexpr int most_secondary = 16;
    sampling.estimator = Estimator::two_mode;
    sampling.secondary = std::min(most_secondary, samples);
    sampling.primary = std::max(1, samples / sampling.secondary);
    sampling.virtual_repeats = 1;
    return sampling;
}

Layers converged_half(const Work& work, const TrackedFrame& frame, const Settings& settings,
                      int samples, std::uint32_t half) {
    SamplingSettings sampling = many_samples(settings.trace, samples);
    sampling.seed += reference_seed_offset + half;
    const SampledFrame sampled = sample_frame(work, frame, sampling, std::uint32_t(frame.frame));
    FilterSettings off = settings.filter;
    off.enabled = false;
    return filter_layers(sampled.result.layers, nullptr, 0, off);
}

Reference converge(const Work& work, const TrackedFrame& frame, const Settings& settings,
                   int samples_per_half) {
    const auto picture = [&](std::uint32_t half) {
        return composite(*frame.photo,
                         converged_half(work, frame, settings, samples_per_half, half),
                         settings.blend)
            .linear;
    };
    return mean_of_halves(picture(0), picture(1), frame.photo->linear);
}

std::vector<const JudgedFrame*> compared_frames(const std::vector<JudgedFrame>& frames) {
    const bool any_previous = std::any_of(
        frames.begin(), frames.end(), [](const JudgedFrame& f) { return f.previous.has_value(); });
    std::vector<const JudgedFrame*> compared;
    for (const JudgedFrame& frame : frames)
        if (frame.previous || !any_previous) compared.push_back(&frame);
    return compared;
}

UnitRun measure_unit(const Work& given, const std::vector<JudgedFrame>& frames,
                     const UnitPlan& plan) {
    const Work work = with_lights(given, plan.light_list, plan.settings.trace.seed);
    UnitRun unit;
    unit.work = work.name;
    unit.knob = plan.knob;
    unit.value = plan.value;
    unit.primary = plan.settings.trace.primary;
    unit.secondary = plan.settings.trace.secondary;
    for (const JudgedFrame* compared : compared_frames(frames)) {
        const JudgedFrame& frame = *compared;
        const auto shared = take_samples(work, frame, plan, Estimator::two_mode);
        const auto own = take_samples(work, frame, plan, Estimator::difference);
        FrameRun costs{frame.now.frame, frame.now.slam_ms, {}, {}};
        if (shared) costs.trace = shared->now.cost, costs.rays = shared->now.result.rays;
        unit.frames.push_back(costs);
        for (const MethodCell& cell : plan.cells) {
            if (cell.temporal && !frame.previous) continue;
            const bool takes_own = cell.method->estimator == Estimator::difference;
            const Samplings& taken = takes_own ? *own : *shared;
            unit.runs.push_back(run_method(work, frame, taken, plan, cell));
            if (!takes_own) continue;
            unit.runs.back().trace = taken.now.cost;
            unit.runs.back().rays = taken.now.result.rays;
        }
    }
    unit.peak_mb = peak_memory_mb();
    return unit;
}

}  // namespace inlay
