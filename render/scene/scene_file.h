// SceneFile: the description of a virtual scene as its JSON file gives it, meshes and textures
// loaded.
#pragma once

#include "recordings/base/environment_map.h"
#include "recordings/base/lens.h"
#include "recordings/base/pose.h"
#include "recordings/environment/environment_tools.h"
#include "recordings/synthetic/camera_path.h"
#include "render/scene/asset_folders.h"
#include "render/scene/scene_requests.h"
#include "render/scene/virtual_scene.h"

#include <glm/glm.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace inlay {

/// Light that is the same from everywhere, plus lobes in the map's frame.
struct DescribedLight {
    Rgb ambient{0};
    std::vector<GaussianLobe> lobes;
};

struct EnvironmentSpec {
    std::variant<std::filesystem::path, DescribedLight>
        source;             // a latitude-longitude file or lobes
    double rotate_deg = 0;  // about up, counter-clockwise seen from above
    float scale = 1;        // factor on radiance, >= 0
    std::optional<glm::dmat3> world_from_environment;  // replaces the alignment
};

/// A real surface on which an object's base is to stand.
struct Placement {
    int frame = 0;              // the recording's number
    glm::ivec2 pixel{0};        // (0, 0) is the centre of the top-left pixel
    double turn_deg = 0;        // about up, counter-clockwise seen from above
    bool align_normal = false;  // stands along the surface's normal instead of the world's up
};

/// An object whose frame is that of its file, y-up and in m. Its base frame has the base as origin:
/// the lowest point under the middle of the bounding box.
struct SceneEntry {
    SceneObject object;  // `motion` is world_from_object, or with a placement base_from_object,
                         // which holds one key at time 0 where the object does not move
    std::optional<Placement> placement;
    glm::dmat4 base_from_object{1.0};
};

struct View {
    Lens lens;
    Pose world_from_camera;
    glm::dvec3 up{0, 1, 0};  // unit, world
};

struct SceneFile {
    EnvironmentSpec environment;
    std::vector<SceneEntry> entries;
    std::optional<View> view;
    std::vector<PathKey> path;  // times increase strictly; may be empty
    SceneRequests requests;
    std::vector<std::string> warnings;
    std::vector<AssetFile> files;  // all that were opened, the scene file itself excepted
};

/// What a description is read for: what cannot be simulated is refused, or only listed.
enum class SceneUse { simulate, explain };

/// Reads a scene description (version 1) with the files it names, which lie beside it or in
/// `asset_folders`. `motion` is a list of keyframes {time, transform}; with `place` it is
/// {"relative_to": "place", "keyframes": [...]}, whose transforms act within the base frame: x and
/// z along the surface, y up, +z towards the camera of the placing frame before `turn_deg`. Throws
/// Error: input_missing; bad_data with the place in the document for unknown keys, wrong types,
/// values out of range, and, unless the scene is only to be explained, whatever it asks for that
/// the program cannot do yet.
SceneFile load_scene_file(const std::filesystem::path& file,
                          const std::vector<std::filesystem::path>& asset_folders = {},
                          SceneUse use = SceneUse::simulate);

struct LoadedEnvironment {
    EnvironmentMap map;
    int replaced_texels = 0;  // see LatlongFile
};

/// The map of a description, scaled and aligned: see `align_environment`. Throws as `load_latlong`.
LoadedEnvironment load_environment(const EnvironmentSpec& spec, const glm::dvec3& up_world,
                                   const glm::dvec3& forward_world);

}  // namespace inlay
