#include "composite/accuracy/blame.h"

#include "composite/blend/differential.h"
#include "recordings/base/check.h"
#include "render/filter/filter_layers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace inlay {
namespace {

/// A composite can only be as wrong as this share of it for a stage before it to be blamed.
constexpr double share_to_blame = 0.25;

/// The frame as tracked, and with recorded poses.
struct Reconstructions {
    TrackedFrame tracked, posed;
};

struct Judge {
    const Work& work;
    const Settings& settings;
    int converged_samples;
    Reconstructions frames;
    Reference truth;
    Image<Rgb> photograph;  // true
    Pose pose;              // true
};

/// The picture with the truth in place of the stages in `swapped`.
Image<Rgb> picture(const Judge& judge, const std::set<Stage>& swapped) {
    TrackedFrame frame = swapped.contains(Stage::poses) ? judge.frames.posed : judge.frames.tracked;
    if (swapped.contains(Stage::geometry))
        frame =
            with_true_room(judge.work, frame,
                           swapped.contains(Stage::poses) ? judge.pose : frame.world_from_camera);
    const bool converged = swapped.contains(Stage::sampling) || swapped.contains(Stage::filter);
    SamplingSettings sampling = judge.settings.trace;
    if (converged) sampling = many_samples(sampling, judge.converged_samples);
    // the filter that is judged is the one that the settings' estimator gets
    if (!swapped.contains(Stage::filter)) sampling.estimator = judge.settings.trace.estimator;
    SampledFrame sampled = sample_frame(judge.work, frame, sampling, std::uint32_t(frame.frame));
    NoisyLayers& layers = sampled.result.layers;
    layers.samples = judge.settings.trace.primary * judge.settings.trace.secondary;
    layers.virtual_samples = layers.samples * judge.settings.trace.virtual_repeats;
    FilterSettings filter = judge.settings.filter;
    if (swapped.contains(Stage::filter)) filter.enabled = false;
    const Photo photo = swapped.contains(Stage::composite)
                            ? Photo{encode(judge.photograph), judge.photograph}
                            : *frame.photo;
    return composite(photo,
                     filter_layers(layers, nullptr, judge.work.environment_bandwidth, filter),
                     judge.settings.blend)
        .linear;
}

double mean_square(const Judge& judge, const Image<Rgb>& image) {
    return error_against(judge.truth, image, encode(image)).mean_square_influenced;
}

Judge prepare(const Work& work, int frame, const Settings& settings, int converged_samples) {
    require(work.recording.has_value() && work.knows_room,
            work.source.string() + ": blame needs a recording whose scene holds the real objects");
    Settings posed = settings;
    posed.use_recorded_poses = true;
    Judge judge{
        work,
        settings,
        converged_samples,
        {track_frames(work, {frame}, settings).at(0), track_frames(work, {frame}, posed).at(0)},
        {},
        {},
        true_pose(work, frame)};
    for (const TrackedFrame* found : {&judge.frames.tracked, &judge.frames.posed})
        require(found->tracking.status != TrackingStatus::lost,
                work.name + ": tracking is lost in frame " + std::to_string(frame) +
                    ", so no stage after it can be blamed");
    auto truth = truth_of_frame(work, frame, judge.frames.tracked.lens);
    auto photograph = true_photograph(work, frame);
    require(
        truth.has_value() && photograph.has_value(),
        work.name + ": frame " + std::to_string(frame) + " has no truth; record it with --truth");
    judge.truth = std::move(*truth);
    judge.photograph = std::move(*photograph);
    return judge;
}

}  // namespace

const char* name_of(Stage stage) {
    switch (stage) {
        case Stage::poses:
            return "poses";
        case Stage::geometry:
            return "geometry";
        case Stage::sampling:
            return "sampling";
        case Stage::filter:
            return "filter";
        case Stage::composite:
            break;
    }
    return "composite";
}

FrameBlame blame_frame(const Work& work, int frame, const Settings& settings,
                       int converged_samples) {
    const Judge judge = prepare(work, frame, settings, converged_samples);
    FrameBlame blame;
    blame.frame = frame;
    const double as_it_is = mean_square(judge, picture(judge, {}));
    blame.rmse = std::sqrt(as_it_is);
    blame.photograph_rmse = std::sqrt(mean_square(judge, judge.frames.tracked.photo->linear));
    const std::set<Stage> every(std::begin(all_stages), std::end(all_stages));
    const double best = mean_square(judge, picture(judge, every));
    blame.best_rmse = std::sqrt(best);
    double largest = share_to_blame;
    for (const Stage stage : all_stages) {
        const double swapped = mean_square(judge, picture(judge, {stage}));
        const double share = as_it_is > 0 ? 1 - swapped / as_it_is : 0;
        blame.stages.push_back({stage, std::sqrt(swapped), share});
        if (share <= largest) continue;
        largest = share;
        blame.culprit = stage;
    }
    return blame;
}

std::string blame_line(const FrameBlame& blame) {
    std::string line = fmt::format(
        "frame {}: RMSE {:.4f} (photograph alone {:.4f}, all stages true "
        "{:.4f}), blame {}:",
        blame.frame, blame.rmse, blame.photograph_rmse, blame.best_rmse, name_of(blame.culprit));
    for (const StageBlame& stage : blame.stages)
        line += fmt::format(" {} {:.0f} %", name_of(stage.stage), 100 * stage.share);
    return line;
}

}  // namespace inlay
