#include "apps/inlay/info_figures.h"

#include "recordings/base/check.h"
#include "recordings/base/parallel.h"

#include <algorithm>

namespace inlay {
namespace {

constexpr std::size_t frames_to_sample = 12;
constexpr int pixel_step = 2;  // every other row and column tells the distribution

struct DepthSample {
    std::vector<float> measured;  // m
    std::size_t pixels = 0;       // looked at
    std::string failure;
};

DepthSample sample_depth(const Recording& recording, int frame) {
    DepthSample sample;
    try {
        const Image<float> depth = recording.load(frame).depth;
        for (int y = 0; y < depth.height; y += pixel_step) {
            for (int x = 0; x < depth.width; x += pixel_step) {
                ++sample.pixels;
                if (depth(x, y) > 0) sample.measured.push_back(depth(x, y));
            }
        }
    } catch (const Error& error) {
        sample.failure = error.what();
    }
    return sample;
}

std::vector<int> spread_over(const std::vector<int>& frames, std::size_t count) {
    if (frames.size() <= count) return frames;
    std::vector<int> chosen;
    for (std::size_t k = 0; k < count; ++k)
        chosen.push_back(frames[k * (frames.size() - 1) / (count - 1)]);
    return chosen;
}

double quantile(const std::vector<float>& sorted, double share) {
    return sorted[std::size_t(share * double(sorted.size() - 1))];
}

DepthFigures depth_figures(const std::vector<DepthSample>& samples) {
    DepthFigures figures;
    std::vector<float> all;
    std::size_t pixels = 0;
    for (const DepthSample& sample : samples) {
        if (!sample.failure.empty()) continue;
        ++figures.frames;
        pixels += sample.pixels;
        all.insert(all.end(), sample.measured.begin(), sample.measured.end());
    }
    if (all.empty()) return figures;
    std::ranges::sort(all);
    figures.coverage = double(all.size()) / double(pixels);
    figures.near = quantile(all, 0.01);
    figures.median = quantile(all, 0.5);
    figures.far = quantile(all, 0.99);
    return figures;
}

TimeFigures time_figures(const RecordingInfo& info) {
    TimeFigures figures;
    if (info.times.size() < 2) return figures;
    figures.duration = info.times.back() - info.times.front();
    std::vector<TimeGap> steps;
    for (std::size_t i = 0; i + 1 < info.times.size(); ++i)
        steps.push_back({info.frames[i], info.times[i + 1] - info.times[i]});
    std::ranges::stable_sort(steps, std::ranges::greater(), &TimeGap::seconds);
    figures.median_step = steps[steps.size() / 2].seconds;
    for (const TimeGap& step : steps)
        if (step.seconds > 1.5 * figures.median_step) figures.gaps.push_back(step);
    return figures;
}

}  // namespace

InfoFigures measure_recording(const Recording& recording, const std::vector<int>& frames) {
    const std::vector<int> chosen = spread_over(frames, frames_to_sample);
    std::vector<DepthSample> samples(chosen.size());
    parallel_for(int(chosen.size()), [&](int i) {
        const auto k = std::size_t(i);
        samples[k] = sample_depth(recording, chosen[k]);
    });
    InfoFigures figures;
    figures.depth = depth_figures(samples);
    figures.time = time_figures(recording.info);
    figures.geometry = check_geometry(recording);
    for (std::size_t k = 0; k < samples.size(); ++k)
        if (!samples[k].failure.empty())
            figures.warnings.push_back("frame " + std::to_string(chosen[k]) +
                                       " cannot be decoded: " + samples[k].failure);
    return figures;
}

int poses_in(const RecordingInfo& info) {
    return int(std::ranges::count_if(info.world_from_camera,
                                     [](const auto& pose) { return pose.has_value(); }));
}

}  // namespace inlay
