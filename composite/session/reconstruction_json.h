// A reconstruction's frames as JSON: all of it but the model.
#pragma once

#include "slam/mapping/reconstruct_recording.h"

#include <nlohmann/json.hpp>

namespace inlay {

/// Frames with their tracking and the poses they were fused at, keyframes, loops. Numbers come back
/// as they were.
nlohmann::ordered_json to_json(const Reconstruction& reconstruction);

/// Its inverse, without a model. Throws nlohmann::json::exception or Error for anything else.
Reconstruction reconstruction_from(const nlohmann::ordered_json& json);

/// What `keyframes.json` says: each keyframe's frame and pose, and the loops between them with the
/// drift that they took out.
nlohmann::ordered_json keyframes_json(const Reconstruction& reconstruction);

/// What `registration.json` says: the motion from the depth camera to the color camera, the color
/// camera's lens, the delay, how sure they are, and the verdict.
nlohmann::ordered_json registration_json(const ColorRegistration& registration);

/// A line of `status.jsonl`: what became of a frame, and why.
nlohmann::ordered_json status_json(const ReconstructedFrame& frame);

}  // namespace inlay
