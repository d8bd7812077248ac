// DepthPyramid: a surface map as slabs of known thickness, one per pixel, and the range of inverse
// depth that each square block of 2, 4, 8, ... pixels holds.
#pragma once

#include "recordings/base/surface_map.h"

#include <vector>

namespace inlay {

/// What the screen tracer takes a pixel's surface to be, and how its rays start.
struct ScreenTracerSettings {
    float thickness = 0.02f;            // m, of every surface, along its normal
    float thickness_per_depth = 0.01f;  // 1, more of it per metre of depth: the sensor's noise
    float largest_tilt = 0.05f;         // share of depth that a facet may rise or fall in its pixel
    float offset = 0.01f;               // m, how far off a real surface rays start
};

/// Throws Error unless thicknesses and offset are >= 0 and the tilt within 0..0.5.
void validate(const ScreenTracerSettings& settings);

/// The surface of one pixel: a piece of its tangent plane, whose 1/z is linear in the image.
struct PixelFacet {
    float inverse_depth = 0;     // 1/m, at the pixel's centre; 0: a hole
    float per_x = 0, per_y = 0;  // 1/(m px), its gradient
    float back = 1;              // 1/z of the slab's back as a share of its front's, 0..1
};

/// Holds every 1/z between `farthest` and `nearest` that a block's slabs reach; an empty range
/// (farthest > nearest) for a block of holes.
struct InverseDepthRange {
    float nearest;   // 1/m
    float farthest;  // 1/m
};

struct DepthPyramid {
    Lens lens;  // a pinhole
    Pose world_from_camera, camera_from_world;
    Image<PixelFacet> facets;
    std::vector<Image<InverseDepthRange>> levels;  // [k]: blocks of 2^(k+1) px; the last is 1 x 1
    InverseDepthRange everything;                  // of the whole map
};

/// Per pixel, the slab between the tangent plane and the plane `thickness` behind it: both are
/// linear in 1/z, and the back is the front times one factor. Holes and values that are not finite
/// become holes. Throws Error if the map's lens is distorted (raycast the map with pinhole(lens))
/// or an image's size is not the lens's.
DepthPyramid make_depth_pyramid(const SurfaceMap& map, const ScreenTracerSettings& settings);

}  // namespace inlay
