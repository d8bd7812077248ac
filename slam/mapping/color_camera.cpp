#include "slam/mapping/color_camera.h"

#include "slam/depth/filter_depth.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace inlay {
namespace {

constexpr int least_width = 320;  // px; in smaller images edges are too coarse to tell
constexpr int least_frames = 12;  // fewer leave the uncertainty vague

std::vector<int> good_frames(const Reconstruction& reconstruction) {
    std::vector<int> positions;
    for (int i = 0; i < int(reconstruction.frames.size()); ++i) {
        const TrackResult& tracking = reconstruction.frames[std::size_t(i)].tracking;
        if (tracking.status == TrackingStatus::tracked) positions.push_back(i);
    }
    return positions;
}

/// Where the depth camera was around a frame, or all the time, when the model was fused: what
/// happens between two images does not depend on what became of their poses later.
std::vector<TimedCamera> path_between(const Reconstruction& reconstruction, int first, int last) {
    std::vector<TimedCamera> path;
    for (int i = std::max(0, first); i <= std::min(last, int(reconstruction.frames.size()) - 1);
         ++i) {
        const ReconstructedFrame& frame = reconstruction.frames[std::size_t(i)];
        if (!frame.fused_at || (!path.empty() && frame.time <= path.back().time)) continue;
        path.push_back({frame.time, *frame.fused_at});
    }
    return path;
}

}  // namespace

ColorCamera color_camera_of(const Reconstruction& reconstruction, int position, const Lens& lens) {
    if (!color_is_apart(reconstruction)) return {lens, Pose{}};
    const ColorRegistration& found = *reconstruction.registration;
    ColorCamera camera{found.needed ? found.color_lens : lens, Pose{}};
    ColorMapping mapping;
    if (found.needed) mapping.color_from_depth = found.color_from_depth;
    if (found.delay_needed) mapping.delay = found.delay;
    const std::vector<TimedCamera> path = path_between(reconstruction, position - 2, position + 2);
    const double time = reconstruction.frames[std::size_t(position)].time;
    camera.color_from_depth = mapping_at(mapping, camera.lens, path, time).color_from_depth;
    return camera;
}

ColorRegistration register_recording(const Reconstruction& reconstruction,
                                     const FrameSource& source, const SlamSettings& settings) {
    const RegistrationSettings registration;
    const std::vector<int> good = good_frames(reconstruction);
    if (int(good.size()) < least_frames) return {};
    std::vector<RegistrationFrame> frames;
    Lens lens;
    for (const int place : spread_frames(int(good.size()), registration.frames)) {
        RgbdFrame frame = source.load(good[std::size_t(place)]);
        if (frame.color.empty() || frame.lens.width < least_width) return {};
        lens = frame.lens;
        frames.push_back(
            {clean_depth(frame.depth, settings.depth), std::move(frame.color), frame.time});
    }
    const auto path = path_between(reconstruction, 0, int(reconstruction.frames.size()));
    return register_color(frames, lens, lens, path, registration);
}

}  // namespace inlay
