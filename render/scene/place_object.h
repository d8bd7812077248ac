// Puts objects on real surfaces.
#pragma once

#include "recordings/base/surface_map.h"
#include "render/scene/scene_file.h"

#include <glm/glm.hpp>

#include <functional>
#include <string>

namespace inlay {

/// world_from_base of an object that stands on the real surface seen at the placement's pixel: the
/// ray through the pixel meets a plane fitted to the measured surface around it (robust against
/// noise and against neighbours that are not part of the plane). A hole takes the nearest measured
/// pixel within 5 px. +y is `up_world`, or with `align_normal` the plane's normal towards the
/// camera; +z the horizontal direction towards the camera (towards the bottom of the image, where
/// the camera looks straight along up), turned by `turn_deg` about +y, counter-clockwise seen from
/// above. Throws Error (bad_data), with `name` in the message, where the pixel lies outside the
/// image or no surface is near.
glm::dmat4 place_on_surface(const Placement& placement, const SurfaceMap& surface,
                            const glm::dvec3& up_world, const std::string& name);

/// The scene with every placement resolved; `surface_of_frame` is asked once for each frame that a
/// placement names. Throws as `place_on_surface`.
VirtualScene resolve_placements(const SceneFile& scene,
                                const std::function<SurfaceMap(int frame)>& surface_of_frame,
                                const glm::dvec3& up_world);

}  // namespace inlay
