#include "slam/mapping/depth_scale.h"

#include "recordings/base/check.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace inlay {
namespace {

constexpr int frames_read = 5;            // spread over the recording
constexpr std::size_t stride = 37;        // px, between those that are read
constexpr double low_share = 0.02;        // of the pixels that may be nearer than the least
constexpr float least_nearest = 0.25f;    // m
constexpr float least_median = 0.4f;      // m
constexpr float most_median = 3.75f;      // m
constexpr std::size_t least_pixels = 50;  // measured, or in common of two views, to tell anything
constexpr float least_factor = 1.5f;      // either way; less may be a motion
constexpr float same_factor = 1.15f;      // from the median one, either way
constexpr float most_of_them = 0.8f;      // share of the pixels

float quantile_of(std::vector<float>& values, double share) {
    const auto place = values.begin() + std::ptrdiff_t(share * double(values.size()));
    std::nth_element(values.begin(), place, values.end());
    return *place;
}

std::string millimetres(float metres) { return std::to_string(std::lround(1000 * metres)) + " mm"; }

void add_depths(const FrameSource& source, int position, std::vector<float>& depths) {
    try {
        const RgbdFrame frame = source.load(position);
        for (std::size_t i = 0; i < frame.depth.pixels.size(); i += stride)
            if (frame.depth.pixels[i] > 0) depths.push_back(frame.depth.pixels[i]);
    } catch (const Error&) {  // told where it is tracked
    }
}

}  // namespace

void check_depth_scale(const FrameSource& source) {
    std::vector<float> depths;
    const int count = std::min(frames_read, source.count());
    for (int i = 0; i < count; ++i)
        add_depths(source, int(std::int64_t(i) * source.count() / count), depths);
    if (depths.size() < least_pixels) return;
    const float nearest = quantile_of(depths, low_share), median = quantile_of(depths, 0.5);
    const bool plausible =
        nearest >= least_nearest && median >= least_median && median <= most_median;
    require(plausible,
            "depth: what the camera measured begins at " + millimetres(nearest) +
                " and has a median of " + millimetres(median) + ", expected " +
                millimetres(least_nearest) + " or more, and " + millimetres(least_median) + " to " +
                millimetres(most_median) +
                ": the scale of the depth images is most likely wrong; see `inlay info`, and give "
                "the right one by --depth-scale (units per m); if it is right as it is, add --set "
                "slam.check_scale=off");
}

std::optional<float> other_scale(const SurfaceMap& observed, const SurfaceMap& model) {
    if (!same_size(observed.position, model.position)) return std::nullopt;
    std::vector<float> factors;
    for (std::size_t i = 0; i < observed.position.pixels.size(); i += stride) {
        const float z = observed.position.pixels[i].z, expected = model.position.pixels[i].z;
        if (z > 0 && expected > 0) factors.push_back(z / expected);
    }
    if (factors.size() < least_pixels) return std::nullopt;
    const float median = quantile_of(factors, 0.5);
    if (median < least_factor && median > 1 / least_factor) return std::nullopt;
    const auto same = std::count_if(factors.begin(), factors.end(), [&](float factor) {
        return factor < median * same_factor && factor > median / same_factor;
    });
    if (float(same) < most_of_them * float(factors.size())) return std::nullopt;
    return median;
}

}  // namespace inlay
