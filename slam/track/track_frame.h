// Coarse-to-fine frame-to-model ICP: where the camera is.
#pragma once

#include "recordings/base/color.h"
#include "recordings/base/surface_map.h"

#include <span>
#include <string>
#include <vector>

namespace inlay {

enum class TrackingStatus { tracked, weak, lost };

struct TrackResult {
    Pose world_from_camera;
    TrackingStatus status = TrackingStatus::lost;
    float inlier_share = 0;  // 0..1 of the points that fall on the model
    float rms_residual = 0;  // m, over the inliers
    int iterations = 0;
    float overlap = 0;  // 0..1 of the frame's points that fall on the model
    std::string why{};  // it is not `tracked`; empty where it is
};

struct TrackSettings {
    int levels = 3;                   // of the pyramid, each half as large
    int iterations = 12;              // at most, per level
    float coarse_distance = 0.15f;    // m, largest distance of a pair at the coarsest level
    float fine_distance = 0.04f;      // m, at the finest level
    float coarse_angle = 0.6f;        // rad, largest one between the normals of a pair, likewise
    float fine_angle = 0.18f;         // rad; noise and bends of the depth turn normals by more
    float noisy_angle = 0.27f;        // rad; where the median is larger all is noise, and the
                                      // coarse angle is taken
    float least_information = 5e-4f;  // per pair, 0..1: directions with less are not moved; normals
                                      // with a noise of s rad feign s^2
    float tracked_share = 0.5f;       // inlier share for `tracked`
    float weak_share = 0.25f;         // inlier share for `weak`; below: lost
    float least_overlap = 0.1f;       // share of points on the model; below: lost
    float largest_move = 0.3f;        // m, from where it started; above: lost
    float largest_turn = 0.5f;        // rad, likewise
    float largest_residual = 0.02f;   // m, rms; above: lost
};

/// Photographs for views whose surfaces leave the camera free to move. They are looked at only
/// there; empty ones say nothing.
struct Photographs {
    const Image<EncodedRgb>& observed;  // by the camera that is looked for
    const Image<EncodedRgb>& model;     // from the pose of the model
};

/// Throws Error that names the setting which is out of range.
void validate(const TrackSettings& settings);

/// Finds the camera that saw `observed` (a pyramid, finest first; its poses are not used) in the
/// frame of `model`, from each of `starts` (world_from_camera): the coarsest level is solved from
/// each, and the start that explains most points is refined. Directions in which the views do not
/// constrain the motion are left to the photographs, if there are some (as large as the finest
/// level, or halves of theirs are); where those say nothing either, they stay as the start had them
/// (Zhang, Kaess and Singh 2016, Sec. IV).
TrackResult track_frame(std::span<const SurfaceMap> observed, const SurfaceMap& model,
                        std::span<const Pose> starts, const TrackSettings& settings,
                        const Photographs* photographs = nullptr);

}  // namespace inlay
