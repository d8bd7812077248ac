// From the sampler's images to what the filter runs on: cleaned, matched between frames, planar.
#pragma once

#include "render/filter/axis_aligned_filter.h"
#include "render/filter/bandlimits.h"
#include "render/trace/layers.h"

#include <span>

namespace inlay {

/// The receiver without the pixels whose position or normal is not usable (not finite, beyond
/// 1e9 m, no length); rates within 0 .. largest_bandwidth; unit normals.
Receiver cleaned(const Receiver& receiver);

/// Whether a pixel has this kind of receiver.
bool any_object(const Receiver& receiver);

/// A receiver with what can be said about its surface before the light is known.
struct PreparedReceiver {
    Receiver receiver;  // cleaned
    Image<float> footprint;
    ScreenCurvature curvature;
    std::shared_ptr<const SurfacePlanes> surface;
    bool empty = true;  // no pixel has this kind of receiver
};

/// Of a cleaned receiver.
PreparedReceiver prepare(Receiver receiver, const Lens& lens, const Pose& world_from_camera);

/// For each pixel of `now`, the index of the previous frame's pixel that sees the same place of the
/// same object, or -1: the nearest to the projection of its position, unless its normal turns
/// beyond the stop or it lies further than rejection_distance pixels away on the surface.
Image<std::int32_t> matching_pixels(const PreparedReceiver& now, const Pose& world_from_camera,
                                    const NoisyLayers& previous, const Receiver& previous_receiver,
                                    const FilterSettings& settings);

/// The previous receiver as the pixels of this frame see it; curvature and footprint are `now`'s.
PreparedReceiver resampled(const PreparedReceiver& now, const Receiver& previous,
                           const Image<std::int32_t>& source);

/// `rates` (1/m) with those that are 0 replaced by the mean of the others on the same object within
/// `reach` pixels each way, if there are any. A few rays may all pass beside an occluder that the
/// neighbors' met, and a pixel without a rate is smoothed most. Mehta 2015, sec. 3.6 does so for
/// unoccluded pixels of area lights, over 5 pixels.
Image<float> filled_rates(const Image<float>& rates, const Image<std::uint32_t>& object, int reach);

/// What the light adds to the width.
struct LightLimits {
    LightKind light = LightKind::direct;
    double environment_bandwidth = 0;                // B_e, 1/rad
    const Image<float>* glossy_bandwidth = nullptr;  // B_rho per pixel; null: diffuse
    int samples = 16;                                // per pixel
    double narrowest = 0;                            // px, lower bound of sigma
    bool ignore_curvature = false;                   // the values do not change with the normal
};

/// The receiver's positions and normals, one plane per coordinate.
std::shared_ptr<const SurfacePlanes> surface_planes(const Receiver& receiver);

/// Planes of the given images, all smoothed with one width. With `source`, the images belong to
/// another frame and pixel i is taken from source(i). Pixels with a value that is not finite have
/// no object.
FilterPlanes planes_of(const PreparedReceiver& receiver, std::span<const Image<Rgb>* const> images,
                       const Image<std::int32_t>* source);

/// Sets both precisions (1 / sigma^2): sigma is that of bandlimits.h times the sample factor, and
/// limits.narrowest pixels at least. That bound is what the error stops at with many samples, where
/// light changes within a pixel or two; at 16 to 64 samples it lowers the error by up to a half.
void set_precision(FilterPlanes& planes, const PreparedReceiver& receiver,
                   const LightLimits& limits, const FilterSettings& settings);

}  // namespace inlay
