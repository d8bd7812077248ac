#include "composite/accuracy/frame_budget.h"

#include "composite/accuracy/displacement.h"
#include "composite/blend/differential.h"
#include "recordings/base/check.h"
#include "render/filter/filter_layers.h"
#include "render/trace/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace inlay {
namespace {

/// Seeds of samples that stand for the judged ones, and for no others.
constexpr std::uint32_t allowance_seed = 0xb0d6, first_still_seed = 0xb0d7,
                        second_still_seed = 0xb0d8;
/// Light from one half of the sky changes by its own value per radian of a surface's tilt towards
/// it: the integral of sin^2 |cos phi| over that of sin cos over the hemisphere, pi / 2 each.
constexpr double change_per_tilt = 1;
/// What the causes of a wrong irradiance share, as `slack` for the picture.
constexpr double irradiance_slack = 1.1;

/// Two pictures of one view from independent samples.
struct Halves {
    Image<Rgb> a, b;
};

Halves pictures_of(const TrackedFrame& frame, const ConvergedLight& light,
                   const BlendSettings& blend) {
    return {composite(*frame.photo, light.a, blend).linear,
            composite(*frame.photo, light.b, blend).linear};
}

/// RMSE of what two halves estimate against the truth, without the noise of either.
double rmse_of(const Halves& halves, const Reference& truth) {
    const double square =
        mean_square_beyond_noise(truth.linear, halves.a, halves.b, truth.influenced);
    return std::sqrt(std::max(0.0, square - influenced_variance(truth)));
}

/// RMS over the influenced pixels of what independent noise changes from frame to frame where
/// nothing moves, without a filter.
double unfiltered_flicker(const Work& work, const TrackedFrame& frame, const Settings& settings,
                          const Mask& influenced) {
    Settings plain = settings;
    plain.filter.enabled = false;
    plain.trace.estimator = Estimator::two_mode;  // whose noise the budget speaks of
    const auto picture = [&](std::uint32_t seed) {
        return composite(*frame.photo, light_of(work, frame, plain, seed), settings.blend).linear;
    };
    return radiance_error(picture(first_still_seed), picture(second_still_seed), influenced).rmse;
}

/// The frame reconstructed without sensor noise or tracking.
TrackedFrame seen_room(const Work& work, int frame, const Settings& settings) {
    Settings posed = settings;
    posed.use_recorded_poses = true;
    return track_frames(work, {frame}, posed, SensorDepth::exact).at(0);
}

}  // namespace

ConvergedLight converged_light(const Work& work, const TrackedFrame& frame,
                               const Settings& settings, int samples) {
    const int half = std::max(1, samples / 2);
    return {converged_half(work, frame, settings, half, 0),
            converged_half(work, frame, settings, half, 1)};
}

Layers light_of(const Work& work, const TrackedFrame& frame, const Settings& settings,
                std::uint32_t seed_offset) {
    SamplingSettings sampling = settings.trace;
    sampling.seed += seed_offset;
    const SampledFrame sampled = sample_frame(work, frame, sampling, std::uint32_t(frame.frame));
    return filter_layers(sampled.result.layers, nullptr, work.environment_bandwidth,
                         settings.filter);
}

TrackedFrame true_frame(const Work& work, const TrackedFrame& frame) {
    const auto photograph = true_photograph(work, frame.frame);
    require(photograph.has_value(), fmt::format("{}: frame {} has no truth; record it with --truth",
                                                work.name, frame.frame));
    TrackedFrame exact = with_true_room(work, frame, true_pose(work, frame.frame));
    exact.photo = std::make_shared<const Photo>(Photo{encode(*photograph), *photograph});
    return exact;
}

namespace {

/// What the reconstruction may change an irradiance by: what it does change, up to what tilted
/// normals and a displaced image account for.
double geometry_share(double measured, const ConvergedLight& wanted, const SensorBounds& bounds,
                      Image<Rgb> Irradiance::*kind) {
    const double displaced = displaced_irradiance(wanted.pair(), kind, bounds.displaced_px);
    return std::min(measured, std::hypot(change_per_tilt * bounds.tilt, displaced));
}

/// The picture's parts but `sampling`, which needs no room.
void add_room(const Work& work, const TrackedFrame& frame, const Settings& settings, int samples,
              FrameBudget& budget) {
    const Reference truth = *truth_of_frame(work, frame.frame, frame.lens);
    TrackedFrame seen = seen_room(work, frame.frame, settings);
    seen.photo = true_frame(work, frame).photo;
    const double measured = rmse_of(
        pictures_of(seen, converged_light(work, seen, settings, samples), settings.blend), truth);
    const double grain = displaced_mean_square(truth, budget.bounds.model_px);
    budget.seen = std::min(measured, std::sqrt(budget.equation * budget.equation + grain));
    budget.displaced_px = std::min(displacement_px(work, frame, true_pose(work, frame.frame)),
                                   budget.bounds.displaced_px);
    budget.displacement = std::sqrt(displaced_mean_square(truth, budget.displaced_px));
}

/// Irradiances: samples and filter in the true room, and what the reconstruction adds.
void add_irradiance(const LightPair& sampled, const ConvergedLight& reconstructed,
                    const ConvergedLight& wanted, FrameBudget& budget) {
    const IrradianceError sampling = irradiance_error(sampled, wanted.pair());
    const IrradianceError geometry = irradiance_error(reconstructed.pair(), wanted.pair());
    const double e_r = geometry_share(geometry.e_r, wanted, budget.bounds, &Irradiance::e_r);
    const double e_rv =
        geometry_share(geometry.e_rv, wanted, budget.bounds, &Irradiance::e_rv_real);
    budget.e_r = irradiance_slack * std::hypot(sampling.e_r, e_r);
    budget.e_rv = irradiance_slack * std::hypot(sampling.e_rv, e_rv);
}

}  // namespace

FrameBudget frame_budget(const Work& work, const TrackedFrame& frame, const Settings& settings,
                         const ConvergedLight& wanted, int converged_samples, double slack) {
    const TrackedFrame exact = true_frame(work, frame);
    const auto truth = truth_of_frame(work, frame.frame, frame.lens);
    require(truth.has_value(), fmt::format("{}: frame {} has no truth; record it with --truth",
                                           work.name, frame.frame));
    FrameBudget budget;
    const EmbreeScene room = EmbreeSceneCache().place(work.scene, frame.time, /*real=*/true);
    budget.bounds =
        sensor_bounds(trace_depth(room, exact.lens, exact.world_from_camera), exact.lens,
                      double(settings.slam.fusion.voxel_size), work.sensor_noise);
    const Halves reference = pictures_of(exact, wanted, settings.blend);
    budget.equation = rmse_of(reference, *truth);
    const Layers found = light_of(work, exact, settings, allowance_seed);
    budget.sampling = std::sqrt(std::max(
        0.0, mean_square_beyond_noise(composite(*exact.photo, found, settings.blend).linear,
                                      reference.a, reference.b, truth->influenced)));
    add_room(work, frame, settings, converged_samples, budget);
    const double reference_mode = std::max(budget.equation, budget.seen);
    budget.total =
        slack * std::sqrt(reference_mode * reference_mode + budget.sampling * budget.sampling +
                          budget.displacement * budget.displacement);
    add_irradiance({found, found}, converged_light(work, frame, settings, converged_samples),
                   wanted, budget);
    budget.flicker = unfiltered_flicker(work, exact, settings, truth->influenced);
    return budget;
}

std::string budget_line(const FrameBudget& b) {
    return fmt::format(
        "allowed {:.4f}: equation {:.4f}, room as seen {:.4f}, samples and filter {:.4f}, "
        "{:.2f} px (of at most {:.2f}) of pose and depth {:.4f}; E_R {:.3f}, E_RV {:.3f}; flicker "
        "{:.4f}",
        b.total, b.equation, b.seen, b.sampling, b.displaced_px, b.bounds.displaced_px,
        b.displacement, b.e_r, b.e_rv, b.flicker);
}

}  // namespace inlay
