#include "slam/registration/register_color.h"

#include "recordings/base/check.h"
#include "recordings/base/parallel.h"
#include "recordings/base/random.h"
#include "slam/registration/search_mapping.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

namespace inlay {
namespace {

constexpr std::size_t least_points = 50;  // of a frame that is used
constexpr std::size_t least_frames = 3;
constexpr double significant = 3;          // standard deviations
constexpr double least_log_focal = 0.006;  // smaller changes of the focal length are not believed
constexpr double least_shift = 1;          // px; smaller ones are not worth a mapping
constexpr double least_gain = 1.02;        // of the score of frames that were held out
constexpr double verdict_sigma = 2;        // px, of that score

void check_size(int width, int height, const Lens& lens, const char* what) {
    require(width == lens.width && height == lens.height,
            std::string("register_color: a ") + what + " image is " + std::to_string(width) +
                " x " + std::to_string(height) + " px, its lens " + std::to_string(lens.width) +
                " x " + std::to_string(lens.height));
}

void check_input(std::span<const RegistrationFrame> frames, const Lens& depth_lens,
                 const Lens& color_lens, std::span<const TimedCamera> trajectory) {
    require(depth_lens.fx != 0 && depth_lens.fy != 0 && color_lens.fx != 0 && color_lens.fy != 0,
            "register_color: a lens has no focal length");
    for (const RegistrationFrame& frame : frames) {
        check_size(frame.depth.width, frame.depth.height, depth_lens, "depth");
        check_size(frame.color.width, frame.color.height, color_lens, "color");
    }
    for (std::size_t i = 1; i < trajectory.size(); ++i)
        require(trajectory[i - 1].time < trajectory[i].time,
                "register_color: the trajectory's times must ascend");
}

/// So many of the edges, in their order.
std::vector<DepthEdge> random_choice(std::span<const DepthEdge> edges, std::size_t most,
                                     const SampleKey& key) {
    std::vector<std::size_t> order(edges.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    const std::size_t chosen = std::min(most, edges.size());
    for (std::size_t i = 0; i < chosen; ++i) {
        const double share = double(uniform(key, std::uint32_t(i)));
        std::swap(order[i], order[i + std::size_t(share * double(order.size() - i))]);
    }
    std::sort(order.begin(), order.begin() + std::ptrdiff_t(chosen));
    std::vector<DepthEdge> result;
    for (std::size_t i = 0; i < chosen; ++i)
        result.push_back(edges[order[i]]);
    return result;
}

RimPoint rim_point(const DepthEdge& edge, const Lens& lens) {
    const glm::dvec2 pixel(edge.pixel), half = 0.5 * glm::dvec2(edge.normal);
    const double z = double(edge.depth);
    return {z * unproject(lens, pixel),
            z * (unproject(lens, pixel + half) - unproject(lens, pixel - half))};
}

/// Without points if the frame has too few rims.
RimView rim_view(const RegistrationFrame& frame, int number, const Lens& depth_lens,
                 const RegistrationSettings& settings) {
    RimView view;
    view.time = frame.time;
    const std::vector<DepthEdge> edges = depth_edges(frame.depth, depth_lens.fx, settings.edges);
    if (edges.size() < least_points) return view;
    const SampleKey key{settings.seed, std::uint32_t(number), 0, 0};
    for (const DepthEdge& edge : random_choice(edges, std::size_t(settings.points), key))
        view.points.push_back(rim_point(edge, depth_lens));
    view.edges = color_edges(frame.color);
    return view;
}

std::vector<RimView> rim_views(std::span<const RegistrationFrame> frames, const Lens& depth_lens,
                               const RegistrationSettings& settings) {
    std::vector<RimView> views(frames.size());
    parallel_for(int(frames.size()), [&](int i) {
        views[std::size_t(i)] = rim_view(frames[std::size_t(i)], i, depth_lens, settings);
    });
    std::erase_if(views, [](const RimView& view) { return view.points.empty(); });
    return views;
}

/// A mapping, and how it does without parts of the recording.
struct Estimate {
    ColorMapping mapping;
    std::vector<HeldOut> held_out;
    MappingUncertainty sd;
};

Estimate doubted(const RimViews& problem, const ColorMapping& mapping,
                 const MappingUnknowns& unknowns) {
    Estimate estimate{mapping, hold_out(problem, mapping, unknowns), {}};
    estimate.sd = uncertainty_of(problem, mapping, estimate.held_out);
    return estimate;
}

/// Keeps the lens's focal length unless a change of it is significant.
Estimate estimate_mapping(const RimViews& problem, MappingUnknowns unknowns) {
    std::vector<int> all(problem.views.size());
    std::iota(all.begin(), all.end(), 0);
    const ColorMapping coarse = search_mapping(problem, unknowns);
    const ColorMapping fine = refine_mapping(problem, all, coarse, unknowns, 0);
    Estimate estimate = doubted(problem, fine, unknowns);
    const double sd = estimate.sd.parameters[MappingParameter::log_focal];
    const double least = std::max(least_log_focal, significant * sd);
    if (!unknowns.log_focal || std::abs(estimate.mapping.log_focal) >= least) return estimate;
    unknowns.log_focal = false;
    ColorMapping held = estimate.mapping;
    held.log_focal = 0;
    return doubted(problem, refine_mapping(problem, all, held, unknowns, 1), unknowns);
}

/// Whether mappings explain what they were not estimated from, in all parts but one at most.
bool generalizes(const RimViews& problem, const Estimate& estimate) {
    std::size_t better = 0;
    for (const HeldOut& part : estimate.held_out) {
        ColorMapping registered;
        registered.rim = part.mapping.rim;  // where rims lie is no matter of registration
        const double with = mapping_score(problem, part.frames, part.mapping, verdict_sigma);
        const double without = mapping_score(problem, part.frames, registered, verdict_sigma);
        if (with > least_gain * without) ++better;
    }
    return better + 1 >= estimate.held_out.size();
}

void judge(ColorRegistration& result, const RimViews& problem, const Estimate& estimate) {
    ColorMapping later;
    later.delay = estimate.mapping.delay;
    result.shift_px = mapping_shift(problem, estimate.mapping, later);
    result.delay_px = mapping_shift(problem, later, {});
    const EdgeDistances before = edge_distances(problem, {});
    const EdgeDistances after = edge_distances(problem, estimate.mapping);
    result.distance_before = before.mean;
    result.distance_after = after.mean;
    result.near_before = before.near;
    result.near_after = after.near;
    const double least = std::max(least_shift, significant * result.sd_px);
    const bool better = generalizes(problem, estimate);
    result.needed = better && result.shift_px > least;
    result.delay_needed =
        better && result.delay_px > least && std::abs(result.delay) > significant * result.delay_sd;
}

}  // namespace

void validate(const RegistrationSettings& s) {
    require(s.frames >= 3 && s.points >= 1,
            "slam.registration.frames must be 3 or more and slam.registration.points 1 or more",
            ExitCode::usage);
    require(s.edges.nearest >= 0 && s.edges.nearest < s.edges.farthest,
            "slam.registration.edges.nearest must be 0 or more and below "
            "slam.registration.edges.farthest",
            ExitCode::usage);
    require(s.edges.step > 0 && s.edges.relative_step >= 0 && s.edges.hole >= 0 &&
                s.edges.shadow_baseline >= 0,
            "slam.registration.edges.step must be above 0; relative_step, hole and "
            "shadow_baseline 0 or more",
            ExitCode::usage);
}

std::vector<int> spread_frames(int count, int chosen) {
    const int used = std::clamp(chosen, 0, std::max(count, 0));
    std::vector<int> result(std::size_t(used), count / 2);
    for (int i = 0; i < used && used > 1; ++i)
        result[std::size_t(i)] = int(std::int64_t(i) * (count - 1) / (used - 1));
    return result;
}

ColorRegistration register_color(std::span<const RegistrationFrame> frames, const Lens& depth_lens,
                                 const Lens& color_lens, std::span<const TimedCamera> trajectory,
                                 const RegistrationSettings& settings) {
    validate(settings);
    check_input(frames, depth_lens, color_lens, trajectory);
    ColorRegistration result;
    result.color_lens = color_lens;
    const RimViews problem{rim_views(frames, depth_lens, settings),
                           color_lens,
                           {trajectory.begin(), trajectory.end()}};
    if (problem.views.size() < least_frames) return result;
    const Estimate estimate =
        estimate_mapping(problem, {trajectory.size() >= 2, !settings.lens_known});
    result.color_from_depth = estimate.mapping.color_from_depth;
    result.color_lens = refined(color_lens, estimate.mapping);
    result.delay = estimate.mapping.delay;
    const MappingStep& sd = estimate.sd.parameters;
    result.rotation_sd = {sd[0], sd[1], sd[2]};
    result.translation_sd = {sd[3], sd[4], sd[5]};
    result.delay_sd = sd[MappingParameter::delay];
    result.focal_sd = sd[MappingParameter::log_focal] * std::abs(result.color_lens.fx);
    result.sd_px = estimate.sd.px;
    for (const RimView& view : problem.views)
        result.points += int(view.points.size());
    judge(result, problem, estimate);
    return result;
}

}  // namespace inlay
