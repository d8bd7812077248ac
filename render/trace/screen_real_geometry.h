// Real geometry as one frame's surface map, traced in the image.
#pragma once

#include "render/trace/depth_pyramid.h"
#include "render/trace/real_geometry.h"

#include <atomic>
#include <cstdint>
#include <memory>

namespace inlay {

/// What became of the rays; sums, so that threads may add in any order.
struct ScreenRayCounts {
    std::atomic<std::uint64_t> hit{0}, missed{0}, off_screen{0};
};

/// Primary hits from the surface map, other rays by marching through it (Mehta 2015, sec. 6.5); the
/// radiance of a hit is the photograph's pixel. Rays that leave the image count as free. `map` must
/// be the pyramid of `seen.surface`, made with the same `settings`; `counts` (optional) is added
/// to. The references in `seen` must outlive the result.
RealGeometry screen_real_geometry(const PhotographedSurface& seen,
                                  std::shared_ptr<const DepthPyramid> map,
                                  const ScreenTracerSettings& settings,
                                  std::shared_ptr<ScreenRayCounts> counts = nullptr);

}  // namespace inlay
