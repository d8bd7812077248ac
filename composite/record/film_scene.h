// From a scene file with a view and a path to what `record` films.
#pragma once

#include "composite/record/record_scene.h"
#include "render/scene/scene_file.h"

#include <optional>
#include <string>

namespace inlay {

struct FilmSettings {
    std::optional<glm::ivec2> size;  // px; none: the view's
    bool hand_held = true;           // the camera shakes
};

/// Objects stand by their transforms; the camera goes along the scene's path, or stays at its view.
/// Throws Error (bad_data) naming `place` for a scene without a view or with a `place`, which needs
/// a recording.
FilmedScene film_scene(const SceneFile& scene, const std::string& place,
                       const FilmSettings& settings);

}  // namespace inlay
