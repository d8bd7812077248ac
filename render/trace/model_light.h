// ModelLight: E_R gathered on the vertices of the real mesh, once for all frames that see them. It
// belongs to the diffuse real surface and does not change with the camera.
#pragma once

#include "render/sample/environment_sampler.h"
#include "render/sample/light_nets.h"
#include "render/trace/embree_scene.h"
#include "render/trace/layers.h"
#include "render/trace/light_need.h"
#include "render/trace/real_geometry.h"
#include "render/trace/two_mode_sampler.h"

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace inlay {

/// What a vertex receives from real geometry alone.
struct VertexLight {
    Rgb direct{0}, indirect{0};                        // irradiances
    float occluder_direct = 0, occluder_indirect = 0;  // as in Receiver, without a floor
};

/// The light of all vertices, each from the same number of samples, as far as it was asked for.
struct GatheredLight {
    int samples = 0;  // per vertex
    std::vector<VertexLight> vertices;
    std::vector<std::uint8_t> known;  // 0 for packets of vertices that nothing has asked for
};

/// The light on a mesh that stands still in an environment that stays as it is: for another mesh or
/// another environment there is another ModelLight. What a vertex receives depends on these and on
/// the settings alone, not on the frame that first asks for it, nor on what other frames ask.
struct ModelLight {
    std::shared_ptr<const EmbreeScene> mesh;  // one part in world coordinates, with normals
    EnvironmentSampler environment;
    SamplingSettings settings;  // of the light at vertices
    RealGeometry geometry;  // the mesh, whose surfaces radiate their fused colors, where a frame's
                            // own geometry takes the photograph's: the same, but for noise
    LightNets nets;
    std::array<GatheredLight, light_need_count> gathered;  // for each LightNeed

    const TriangleMesh& triangles() const { return *mesh->parts().front().mesh; }
};

/// Nothing gathered yet: settings.gathered (> 0) samples for vertices whose light is plainly seen.
/// Rays start `offset` (m) off the surface. Null for a mesh without vertices or without normals.
std::unique_ptr<ModelLight> make_model_light(std::shared_ptr<const EmbreeScene> mesh,
                                             const EnvironmentSampler& environment,
                                             const SamplingSettings& settings, float offset);

/// Whether E_R is read from a model: it is sampled for itself, shadowed alone, and pixels take no
/// more samples than vertices.
bool takes_model_light(const SamplingSettings& settings);

/// `kept`, if it is the light of this mesh in this environment by these settings; else a new one
/// takes its place. Null, and all stays, where the settings take none.
ModelLight* keep_model_light(std::unique_ptr<ModelLight>& kept,
                             std::shared_ptr<const EmbreeScene> mesh,
                             const EnvironmentSampler& environment,
                             const SamplingSettings& settings, float offset);

/// Sets E_R of the pixels that are `chosen` (empty: all) and have a real receiver where the mesh
/// has the same surface, between its vertices; gathers what these lack. Rates are upper bounds: the
/// largest of the vertices', and no more than at the distance `occluder_floor` (share of depth).
/// One frame at a time. Returns the pixels that are left (not 0): the mesh has another surface
/// there than the pixel sees, or none.
Image<std::uint8_t> light_from_model(ModelLight& light, const Image<std::uint8_t>& chosen,
                                     const Image<LightNeed>& needs, float occluder_floor,
                                     TwoModeResult& result);

}  // namespace inlay
