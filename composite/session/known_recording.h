// A recording that was reconstructed before its frames are composited.
#pragma once

#include "composite/session/settings.h"
#include "recordings/readers/recording.h"
#include "slam/mapping/reconstruct_recording.h"

#include <memory>
#include <string>

namespace inlay {

/// Frame after frame of a recording, for reconstruct_recording().
FrameSource frames_of(const Recording& recording);

/// The whole recording, reconstructed as the settings say; null where these do not look ahead.
/// Poses are kept in cache_folder() by the recording, the settings and this program, so that a
/// recording is tracked once; the model is then fused from them, to the same bytes. A cache that
/// cannot be read or written costs time alone. Throws Error as reconstruct_recording().
std::shared_ptr<const Reconstruction> know_recording(
    const Recording& recording, const Settings& settings,
    const GoOn& go_on = [](int) { return true; });

/// The same without the cache.
std::shared_ptr<const Reconstruction> reconstruct_afresh(
    const Recording& recording, const Settings& settings,
    const GoOn& go_on = [](int) { return true; });

/// What to say of a model that had no room for all that was seen; empty where it had.
std::string full_model_text(const VoxelVolume& volume);

/// The position of the frame with the recording's `number`; -1 where it has none.
int position_of(const Reconstruction& known, int number);

}  // namespace inlay
