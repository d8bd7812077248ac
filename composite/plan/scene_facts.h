// SceneFacts: what a frame of a scene holds that decides what has to be simulated.
#pragma once

#include "composite/plan/light_reach.h"
#include "composite/plan/object_in_view.h"
#include "recordings/base/lens.h"
#include "recordings/base/pose.h"
#include "render/scene/scene_requests.h"
#include "render/scene/virtual_scene.h"

#include <limits>
#include <string>
#include <vector>

namespace inlay {

/// A virtual object of which less than 1/1000 of a pixel is in view is not seen: no 8-bit picture
/// shows it. It still throws its shadow.
inline constexpr double least_visible_px = 0.03;  // of width times height, as the side of a square

/// One virtual object that has a surface.
struct ObjectFacts {
    std::string name;
    bool in_view = false;  // possible, and large enough to be seen
    bool glossy = false, textured = false;
    ObjectInView cover;
    // By which share of its mean it changes the light on what is seen, at most.
    double light_change = std::numeric_limits<double>::infinity();
};

/// What the rules look at.
struct SceneFacts {
    std::vector<ObjectFacts> objects;  // virtual ones
    bool moving = false;               // one of them has moved since the frame before
    bool lit = false;                  // the environment sends light
    bool tracked = true;               // the camera's pose is known
    bool first_frame = false;          // there is no frame before to filter with
    bool light_kept = false;           // E_R is read from the model where frames before gathered it
    SceneRequests requests;            // what the scene asks for beyond surfaces and environment
};

/// A scene at a time as a camera sees it. References must outlive the call.
struct SceneInFrame {
    const VirtualScene& scene;
    const std::vector<ObjectBounds>& bounds;  // of the scene's objects, in their order
    const Lens& lens;
    const Pose& world_from_camera;
    double time = 0, time_before = 0;  // s, of this frame and of the one before it
    bool lit = false;                  // the environment sends light
    LightRange light{};                // of the environment
    Rgb exposure{1};                   // of the photograph, relative to the reference
    // No real surface that is seen lies farther (m, along z), and rays start so far off it (m).
    double farthest = std::numeric_limits<double>::infinity(), offset = 0;
};

/// Measures the virtual objects; `tracked`, `first_frame`, `light_kept` and `requests` are left to
/// the caller.
SceneFacts gather_facts(const SceneInFrame& frame);

/// Whether a virtual object stands elsewhere at `time` than at `time_before` (s).
bool virtual_objects_moved(const VirtualScene& scene, double time, double time_before);

/// Whether the material reflects anything beside its Lambertian part.
bool is_glossy(const Material& material);

/// Counts of virtual objects.
int objects_in_view(const SceneFacts& facts);
int glossy_objects(const SceneFacts& facts);
int glossy_objects_in_view(const SceneFacts& facts);

/// By which share of its mean all of them together change the light on what is seen, at most.
double light_change(const SceneFacts& facts);

/// Whether there are virtual objects, none of them in view, and what they change moves no byte.
bool out_of_reach(const SceneFacts& facts);

}  // namespace inlay
