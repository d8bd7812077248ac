#include "slam/mapping/observe_frame.h"

#include "recordings/base/check.h"
#include "slam/depth/depth_pyramid.h"
#include "slam/depth/surface_from_depth.h"

#include <string>
#include <utility>

namespace inlay {
namespace {

constexpr int least_width = 320;  // px; smaller images are neither halved nor smoothed less

void require_sizes(const RgbdFrame& frame) {
    const auto fits = [&](int width, int height) {
        return width == frame.lens.width && height == frame.lens.height;
    };
    const bool color_fits = frame.color.empty() || fits(frame.color.width, frame.color.height);
    require(frame.lens.width > 0 && frame.lens.height > 0 && color_fits &&
                fits(frame.depth.width, frame.depth.height),
            "frame " + std::to_string(frame.index) +
                ": color, depth and lens must be of one size; depth has " +
                std::to_string(frame.depth.width) + " x " + std::to_string(frame.depth.height) +
                " px, the lens " + std::to_string(frame.lens.width) + " x " +
                std::to_string(frame.lens.height));
}

}  // namespace

ObservedFrame observe_frame(const RgbdFrame& frame, const SlamSettings& settings) {
    require_sizes(frame);
    ObservedFrame observed;
    DepthSettings depth = settings.depth;
    DepthLevel finest{clean_depth(frame.depth, depth), frame.lens};
    if (frame.lens.width >= least_width) {
        if (settings.half_resolution) finest = halve(finest, depth);
        depth.smoothing_radius /= 2;  // tracking wants the noise of normals to show
    }
    observed.clean = std::move(finest.depth);
    for (const DepthLevel& level : depth_pyramid(smooth_depth(observed.clean, depth), finest.lens,
                                                 settings.track.levels, depth)) {
        observed.pyramid.push_back(surface_from_depth(level.depth, level.lens, Pose{}, depth));
    }
    return observed;
}

SurfaceMap own_surface(const RgbdFrame& frame, const Pose& world_from_camera,
                       const DepthSettings& settings) {
    return surface_from_depth(filter_depth(frame.depth, settings), frame.lens, world_from_camera,
                              settings);
}

}  // namespace inlay
