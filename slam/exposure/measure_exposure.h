// Photograph + model -> how much brighter the photograph is than the model's colors.
#pragma once

#include "recordings/base/color.h"
#include "recordings/base/surface_map.h"
#include "slam/volume/fuse_depth.h"
#include "slam/volume/voxel_volume.h"

namespace inlay {

/// Linear photograph = gain * what the exposure that the model's colors are kept at would have
/// recorded.
struct Exposure {
    Rgb gain{1};         // to work with: exactly 1 where the measured one is not significantly else
    Rgb measured{1};     // as it came out
    Rgb uncertainty{0};  // standard error of the logarithm of `measured`
    int pixels = 0;      // that agree with it; 0: too few to tell, and the gain is not known
};

/// Compares a photograph with the model's fused colors at every n-th point of `seen`, the model or
/// the frame's own surface at its pose. The gain of each channel is where the logarithms of the
/// ratios crowd (Tukey's biweight around their mode). Patches that are clipped, dark, seen at a
/// grazing angle or crossed by an edge do not count; grey ones count most, since in saturated ones
/// a camera's black level and color matrix pass for a change of exposure. `photo.gain`, if any, is
/// not used. Same bytes for any number of threads.
///
/// `gain` holds as much of it as is significant, of the mean of the channels and of what each
/// deviates from it: nothing within 3 standard errors or a dead band, all of it beyond twice that,
/// and rising steadily between, so that a slow change has no step.
Exposure measure_exposure(const VoxelVolume& volume, const SurfaceMap& seen,
                          const SeenColor& photo);

/// The exposure of the frame after the one of `exposure`: `measured`, if that could be told.
inline void update_exposure(Exposure& exposure, const Exposure& measured) {
    if (measured.pixels > 0) exposure = measured;
}

}  // namespace inlay
