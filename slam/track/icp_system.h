// Two surfaces -> one 6x6 point-to-plane system.
#pragma once

#include "recordings/base/surface_map.h"

#include <array>

namespace inlay {

/// Which pairs of points count, and how much.
struct PairingSettings {
    float distance = 0.1f;  // m, points farther apart are no pair
    float cosine = 0.8f;    // of the largest angle between the normals of a pair
    float scale = 1.0f;     // standard deviation of the residuals, in units of depth_sigma()
};

/// Normal equations A x = b of the twist x = (rotation, translation), in the frame of the model's
/// camera, that takes the observed points closer to the model's tangent planes.
struct IcpSystem {
    std::array<double, 21> a{};   // upper triangle of A, row by row, in 1/depth_sigma()^2
    std::array<double, 6> b{};    // likewise
    double squared_residual = 0;  // m^2, sum over the inliers
    double distance = 0;          // m, sum of the pairs' distances from the model's camera
    int observed = 0;             // points tried
    int seen = 0;                 // of these, the ones that fall on the model's surface
    int pairs = 0;                // of these, the ones close enough in position and normal
    int inliers = 0;              // of these, the ones within 3 scale of the plane
};

/// Pairs each observed point, taken into the model's camera by `model_from_observed`, with the
/// model's point at the pixel where it appears (projective association; Blais and Levine 1995), and
/// linearises the distances from the model's tangent planes (Chen and Medioni 1992). Pairs weigh as
/// the inverse square of the depth noise, times Tukey's biweight of the residual. Sums are added in
/// the order of the rows: same bytes for any number of threads.
IcpSystem icp_system(const SurfaceMap& observed, const SurfaceMap& model,
                     const Pose& model_from_observed, const PairingSettings& settings);

/// Robust scale of the residuals of the pairs: 1.4826 times the median of their magnitudes, in
/// units of depth_sigma(); from every fourth row. 0 if there is no pair.
float residual_scale(const SurfaceMap& observed, const SurfaceMap& model,
                     const Pose& model_from_observed, const PairingSettings& settings);

/// The median angle (rad) between the normals of the pairs; from every fourth row. 0 if there is no
/// pair.
float median_angle(const SurfaceMap& observed, const SurfaceMap& model,
                   const Pose& model_from_observed, const PairingSettings& settings);

}  // namespace inlay
