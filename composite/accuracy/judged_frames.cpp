#include "composite/accuracy/judged_frames.h"

#include "composite/plan/scene_facts.h"
#include "recordings/base/check.h"

#include <algorithm>
#include <iterator>
#include <set>

namespace inlay {
namespace {

constexpr int photo_samples = 256;  // of the picture that stands for a scene's photograph

bool objects_moved(const Work& work, const TrackedFrame& now, const TrackedFrame& before) {
    return virtual_objects_moved(work.scene, now.time, before.time);
}

std::optional<int> frame_before(const Work& work, int frame) {
    const std::vector<int>& all = work.recording->info.frames;
    const auto found = std::find(all.begin(), all.end(), frame);
    if (found == all.end() || found == all.begin()) return std::nullopt;
    return *(found - 1);
}

const TrackedFrame& tracked(const std::vector<TrackedFrame>& all, int frame) {
    return *std::find_if(all.begin(), all.end(),
                         [&](const TrackedFrame& t) { return t.frame == frame; });
}

/// A still camera: the frame before shows the same view.
JudgedFrame judged_view(const Work& work, const Settings& settings) {
    JudgedFrame view;
    view.now = photograph_view(work, settings.trace.seed, photo_samples);
    view.previous = view.now;
    return view;
}

std::vector<JudgedFrame> tracked_frames(const Work& work, const std::vector<int>& frames,
                                        const Sampling& sampling) {
    std::set<int> needed(frames.begin(), frames.end());
    for (const int frame : frames)
        if (const auto before = frame_before(work, frame)) needed.insert(*before);
    const auto all =
        track_frames(work, {needed.begin(), needed.end()}, sampling.settings, sampling.depth);
    std::vector<JudgedFrame> result;
    for (const int frame : frames) {
        JudgedFrame judged;
        judged.now = tracked(all, frame);
        require(judged.now.tracking.status != TrackingStatus::lost,
                work.name + ": tracking is lost in frame " + std::to_string(frame) +
                    ", so nothing can be measured there; choose other --frames");
        if (const auto before = frame_before(work, frame)) {
            const TrackedFrame& previous = tracked(all, *before);
            const bool lost = previous.tracking.status == TrackingStatus::lost;
            if (!lost && !objects_moved(work, judged.now, previous)) judged.previous = previous;
        }
        judged.truth = truth_of_frame(work, frame, judged.now.lens);
        result.push_back(std::move(judged));
    }
    return result;
}

}  // namespace

std::vector<int> measured_frames(const Work& work, const std::function<bool(int)>& wanted) {
    if (!work.recording) return {0};
    const std::vector<int>& all =
        work.truth_frames.empty() ? work.recording->info.frames : work.truth_frames;
    std::vector<int> frames;
    if (wanted) {
        std::copy_if(all.begin(), all.end(), std::back_inserter(frames), wanted);
        require(!frames.empty(), work.name + ": none of the wanted frames has truth",
                ExitCode::usage);
        return frames;
    }
    std::copy_if(all.begin(), all.end(), std::back_inserter(frames),
                 [&](int frame) { return frame_before(work, frame).has_value(); });
    if (frames.empty()) frames = all;
    if (frames.size() > 2) frames.erase(frames.begin() + 1, frames.end() - 1);
    return frames;
}

std::vector<JudgedFrame> judge_frames(const Work& work, const std::vector<int>& frames,
                                      const Sampling& sampling, int converged_samples) {
    std::vector<JudgedFrame> result;
    if (work.recording)
        result = tracked_frames(work, frames, sampling);
    else
        result.push_back(judged_view(work, sampling.settings));
    for (JudgedFrame& frame : result)
        if (converged_samples > 0)
            frame.converged =
                converge(work, frame.now, sampling.settings, std::max(1, converged_samples / 2));
    return result;
}

}  // namespace inlay
