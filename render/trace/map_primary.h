// Primary hits on a surface map, the same for everything that traces its real geometry.
#pragma once

#include "render/trace/depth_pyramid.h"
#include "render/trace/real_geometry.h"

#include <array>

namespace inlay {

/// Where camera rays meet the tangent planes of the pixels they go through, so that points of one
/// pixel lie on one plane, or on two where it sees a second surface; planes seen too flat are kept
/// within the share `largest_tilt` (0..0.5) of the pixel's depth, as the screen tracer keeps its
/// facets.
RealPrimaryHits map_primary(const SurfaceMap& map, const RayPacket& camera_rays,
                            const std::array<glm::ivec2, packet_width>& pixels,
                            float largest_tilt = ScreenTracerSettings{}.largest_tilt);

}  // namespace inlay
