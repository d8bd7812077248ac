// SceneRequests: what a scene description asks for beyond surfaces in the light of an environment.
#pragma once

namespace inlay {

/// Nothing of this can be simulated by this version; a description may carry it.
struct SceneRequests {
    int polygon_lights = 0, mesh_lights = 0;
    bool medium = false;         // one that scatters or absorbs
    double aperture_radius = 0;  // m; 0: a pinhole, all in focus
    double focus_distance = 0;   // m; of no meaning with a pinhole
    double shutter = 0;          // s; 0: no motion blur
};

}  // namespace inlay
