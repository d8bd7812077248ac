#include "composite/record/film_scene.h"

#include "composite/session/prepare_scene.h"
#include "recordings/base/check.h"
#include "render/scene/place_object.h"

#include <utility>
#include <vector>

namespace inlay {

FilmedScene film_scene(const SceneFile& scene, const std::string& place,
                       const FilmSettings& settings) {
    require(scene.view.has_value(), place + ": `record` needs a 'view'");
    const auto no_surface = [&](int) -> SurfaceMap {
        throw Error(ExitCode::bad_data,
                    place + ": 'place' needs a recording; give the object a 'transform'");
    };
    FilmedScene film;
    film.scene = resolve_placements(scene, no_surface, scene.view->up);
    LoadedEnvironment environment = load_environment(scene.environment, scene.view->up, {0, 0, 1});
    if (environment.replaced_texels > 0) film.warnings.push_back(replaced_texels_text(environment));
    film.environment = std::move(environment.map);
    film.lens = scene.view->lens;
    if (settings.size) film.lens = scaled(film.lens, settings.size->x, settings.size->y);
    film.up = scene.view->up;
    std::vector<PathKey> path = scene.path;
    if (path.empty()) path.push_back({0, scene.view->world_from_camera});
    film.camera = keyframe_path(std::move(path));
    if (settings.hand_held) film.camera = hand_held(film.camera, {});
    return film;
}

}  // namespace inlay
