// ChangeRays: rays that look for virtual surfaces wait until 16 of them, of any pixels of a tile,
// make a packet; those that meet one wait for another packet, against real geometry.
#pragma once

#include "render/trace/sample_pass.h"

#include <array>

namespace inlay {

/// A direction from one of the tile's landings.
struct ChangeTry {
    const Landing* from = nullptr;  // on a real surface; must outlive the rays, as the sums must
    ChangeSums* sums = nullptr;     // of its pixel
    SampleKey key;                  // its own random numbers
    glm::vec3 direction{0.0f};      // unit
    float cone_density = 0;         // expected tries over the cones there, per steradian
    LightSample light;              // what the environment sends from there,
    bool knows_light = false;       // if it is known before
    SurfaceHit on_virtual;
};

/// What becomes of tries that meet virtual geometry.
enum class ChangeKind {
    shadows,  // light that virtual surfaces keep away
    surfaces  // the same, and their radiance in the place of that of real ones
};

struct ChangeRays {
    ChangeKind kind;
    int light_tries = 0;  // tries that are drawn from the environment, per camera ray
    std::array<ChangeTry, packet_width> waiting{};  // for a packet against virtual geometry
    std::array<ChangeTry, packet_width> met{};      // virtual geometry, waiting for a real one
    int waiting_count = 0, met_count = 0;
};

/// Follows a try whose direction lies above the surface, once a packet is full. Of `pass` only what
/// the tile's pixels share is used.
void follow(ChangeRays& rays, const ChangeTry& t, SamplePass& pass);

/// The packets that are not full.
void follow_rest(ChangeRays& rays, SamplePass& pass);

}  // namespace inlay
