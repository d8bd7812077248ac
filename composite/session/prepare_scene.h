// From a scene file and a recording to objects and light in the recording's world.
#pragma once

#include "composite/session/settings.h"
#include "recordings/readers/recording.h"
#include "render/scene/scene_file.h"
#include "slam/mapping/reconstruct_recording.h"

#include <string>
#include <vector>

namespace inlay {

struct PreparedScene {
    VirtualScene scene;
    EnvironmentMap environment;
    glm::dvec3 up{0, 1, 0};             // unit, world
    std::vector<std::string> warnings;  // what had to be assumed
};

/// Places the objects on the surfaces of the frames that the scene names (as `known` has them, or
/// tracked from the first frame for it), and aligns the environment: up as the recording gives it,
/// else as measured from a plane of the first frame, else minus y of the first camera; its +z along
/// the first view, or along the world's +z for a scene that has a view of its own. Throws Error as
/// place_on_surface and load_environment, and bad_data for a frame that the recording does not
/// have.
PreparedScene prepare_scene(const SceneFile& file, const Recording& recording,
                            const Settings& settings, const Reconstruction* known = nullptr);

/// The warning for a map with texels that had to be replaced.
std::string replaced_texels_text(const LoadedEnvironment& environment);

}  // namespace inlay
