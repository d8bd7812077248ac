// The settings of reconstruction and tracking by name: every field of SlamSettings.
#include "composite/session/setting_rows.h"

namespace inlay {

std::vector<SettingRow> slam_rows() {
    return {
        choice<bool>("slam.poses", {{"tracked", false}, {"recorded", true}},
                     INLAY_MEMBER(use_recorded_poses)),
        row("slam.half_resolution", "on or off", INLAY_MEMBER(slam.half_resolution)),
        row("slam.look_ahead", "on or off", INLAY_MEMBER(slam.look_ahead)),
        row("slam.register_color", "on or off", INLAY_MEMBER(slam.register_color)),
        row("slam.check_scale", "on or off", INLAY_MEMBER(slam.check_scale)),
        row("slam.follow_exposure", "on or off", INLAY_MEMBER(slam.follow_exposure)),
        row("slam.depth.nearest", "m", INLAY_MEMBER(slam.depth.nearest)),
        row("slam.depth.farthest", "m", INLAY_MEMBER(slam.depth.farthest)),
        row("slam.depth.step", "standard deviations", INLAY_MEMBER(slam.depth.step)),
        row("slam.depth.sensor_noise", "factor", INLAY_MEMBER(slam.depth.sensor_noise)),
        row("slam.depth.steepest", "share of depth per pixel", INLAY_MEMBER(slam.depth.steepest)),
        row("slam.depth.smoothing_radius", "px", INLAY_MEMBER(slam.depth.smoothing_radius)),
        row("slam.depth.smoothing_sigma", "px", INLAY_MEMBER(slam.depth.smoothing_sigma)),
        row("slam.fusion.voxel_size", "m", INLAY_MEMBER(slam.fusion.voxel_size)),
        row("slam.fusion.truncation", "m", INLAY_MEMBER(slam.fusion.truncation)),
        row("slam.fusion.max_weight", "observations", INLAY_MEMBER(slam.fusion.max_weight)),
        row("slam.fusion.full_weight_z", "m", INLAY_MEMBER(slam.fusion.full_weight_z)),
        row("slam.fusion.least_cosine", "1", INLAY_MEMBER(slam.fusion.least_cosine)),
        row("slam.fusion.memory", "MB", INLAY_MEMBER(slam.fusion.memory)),
        row("slam.raycast.nearest", "m", INLAY_MEMBER(slam.raycast.nearest)),
        row("slam.raycast.farthest", "m", INLAY_MEMBER(slam.raycast.farthest)),
        row("slam.raycast.least_weight", "observations", INLAY_MEMBER(slam.raycast.least_weight)),
        row("slam.raycast.full_confidence", "observations",
            INLAY_MEMBER(slam.raycast.full_confidence)),
        row("slam.edges.reach", "m", INLAY_MEMBER(slam.edges.reach)),
        row("slam.edges.step", "share of depth", INLAY_MEMBER(slam.edges.step)),
        row("slam.edges.contrast", "0..1, encoded", INLAY_MEMBER(slam.edges.contrast)),
        row("slam.track.levels", "of the pyramid", INLAY_MEMBER(slam.track.levels)),
        row("slam.track.iterations", "per level", INLAY_MEMBER(slam.track.iterations)),
        row("slam.track.coarse_distance", "m", INLAY_MEMBER(slam.track.coarse_distance)),
        row("slam.track.fine_distance", "m", INLAY_MEMBER(slam.track.fine_distance)),
        row("slam.track.coarse_angle", "rad", INLAY_MEMBER(slam.track.coarse_angle)),
        row("slam.track.fine_angle", "rad", INLAY_MEMBER(slam.track.fine_angle)),
        row("slam.track.noisy_angle", "rad", INLAY_MEMBER(slam.track.noisy_angle)),
        row("slam.track.least_information", "0..1", INLAY_MEMBER(slam.track.least_information)),
        row("slam.track.tracked_share", "0..1", INLAY_MEMBER(slam.track.tracked_share)),
        row("slam.track.weak_share", "0..1", INLAY_MEMBER(slam.track.weak_share)),
        row("slam.track.least_overlap", "0..1", INLAY_MEMBER(slam.track.least_overlap)),
        row("slam.track.largest_move", "m", INLAY_MEMBER(slam.track.largest_move)),
        row("slam.track.largest_turn", "rad", INLAY_MEMBER(slam.track.largest_turn)),
        row("slam.track.largest_residual", "m", INLAY_MEMBER(slam.track.largest_residual)),
    };
}

}  // namespace inlay
