// The slow exact filter that the separable one stands for.
#pragma once

#include "render/filter/axis_aligned_filter.h"

namespace inlay {

/// As filter_axis_aligned, by a direct sum over the (2 radius + 1)^2 pixels around each one, in
/// double precision: weight exp(-d^2 P / 2), where d is the world distance (m) and P the mean
/// precision of both pixels along the line between them, (P_x i^2 + P_y j^2) / (i^2 + j^2) for a
/// neighbor i columns and j rows away.
/// Where one width holds and pixels form a rectangular grid of equal steps on a plane, both filters
/// are the same up to rounding: exp(-(a^2 + b^2)) = exp(-a^2) exp(-b^2), and every row has the same
/// sum of weights. They differ where the width changes within the kernel, where the image's axes
/// are not perpendicular on the surface, and around stops, which the separable filter may pass in
/// its second step.
std::vector<Image<float>> filter_reference(const FilterPlanes& now, const FilterPlanes* previous,
                                           const KernelSettings& kernel);

}  // namespace inlay
