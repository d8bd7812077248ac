#include "render/trace/model_light.h"

#include "recordings/base/parallel.h"
#include "render/trace/bounce.h"
#include "render/trace/pixel_tile.h"
#include "render/trace/real_light.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace inlay {
namespace {

/// A point of the mesh: where a pixel's receiver lies on it.
struct ModelPoint {
    static constexpr std::uint32_t none = 0xffffffffU;
    std::uint32_t triangle = none;
    glm::vec2 barycentric{0.0f};  // weights of the second and third vertex
    LightNeed need = LightNeed::hardly;
};

/// Vertices are gathered in packets, always the same ones, so that no number depends on what was
/// asked for.
std::size_t packet_of(std::uint32_t vertex) { return vertex / packet_width; }

Landings landings_of(const ModelLight& light, std::size_t packet) {
    const TriangleMesh& mesh = light.triangles();
    Landings landings;
    for (std::size_t lane = 0; lane < packet_width; ++lane) {
        const std::size_t vertex = packet * packet_width + lane;
        if (vertex >= mesh.positions.size()) break;
        Landing& landing = landings[lane];
        landing.kind = LandingKind::real;
        landing.position = mesh.positions[vertex];
        landing.normal = landing.geometric_normal = mesh.normals[vertex];
    }
    return landings;
}

struct PacketOfNeed {
    std::size_t need, packet;
};

/// What gathering adds to the frame's counts.
struct GatheringCost {
    RayCounts rays;
    std::uint64_t dropped = 0;  // non-finite samples, left out
};

GatheringCost gather(ModelLight& light, const PacketOfNeed& which) {
    static const EmbreeScene nothing;
    GatheringCost cost;
    GatheredLight& gathered = light.gathered[which.need];
    const TwoModeScene scene{{}, {}, light.geometry, nothing, light.environment};
    const Landings landings = landings_of(light, which.packet);
    const std::size_t first = which.packet * packet_width;
    std::array<PixelSums, packet_width> sums;
    SampleKeys keys;
    LightRuns runs;
    LaneCounts counts;
    counts.fill(gathered.samples);
    for (std::size_t lane = 0; lane < packet_width; ++lane)
        keys[lane] = {light.settings.seed, 0, std::uint32_t(first + lane), 0,
                      std::uint32_t(first + lane)};
    for (int s = 0; s < gathered.samples; ++s) {
        for (SampleKey& key : keys)
            key.sample = std::uint32_t(s);
        SamplePass pass{scene, light.settings, landings, keys, sums, cost.rays, light.nets, runs};
        add_real_light(pass, counts);
    }
    for (std::size_t lane = 0; lane < packet_width; ++lane) {
        if (first + lane >= gathered.vertices.size()) break;
        const PixelSums& sum = sums[lane];
        gathered.vertices[first + lane] = {sum.direct.e_r.mean(), sum.indirect.e_r.mean(),
                                           sum.real.occluder_direct, sum.real.occluder_indirect};
        cost.dropped += std::uint64_t(dropped(sum));
    }
    return cost;
}

/// Gathers what the vertices around the points lack.
GatheringCost gather_missing(ModelLight& light, const Image<ModelPoint>& points) {
    std::vector<PacketOfNeed> missing;
    const TriangleMesh& mesh = light.triangles();
    for (const ModelPoint& point : points.pixels) {
        if (point.triangle == ModelPoint::none) continue;
        const auto need = std::size_t(point.need);
        for (int corner = 0; corner < 3; ++corner) {
            const std::size_t packet = packet_of(mesh.triangles[point.triangle][corner]);
            if (std::exchange(light.gathered[need].known[packet], std::uint8_t(1)) == 0)
                missing.push_back({need, packet});
        }
    }
    std::vector<GatheringCost> costs(missing.size());
    parallel_for(int(missing.size()),
                 [&](int i) { costs[std::size_t(i)] = gather(light, missing[std::size_t(i)]); });
    GatheringCost sum;
    for (const GatheringCost& cost : costs) {
        sum.rays += cost.rays;
        sum.dropped += cost.dropped;
    }
    return sum;
}

/// The mesh is the surface that a pixel sees where it is no further from it than the offset of its
/// rays, and its vertices' normals turn away by less than this.
constexpr float least_cosine = 0.8f;

bool is_seen(const ModelLight& light, const SurfaceHit& hit, const glm::vec3& at,
             const glm::vec3& position, const glm::vec3& normal) {
    if (!(std::abs(glm::dot(at - position, normal)) <= light.geometry.offset)) return false;
    const TriangleMesh& mesh = light.triangles();
    const glm::uvec3 corners = mesh.triangles[hit.triangle];
    for (int corner = 0; corner < 3; ++corner)
        if (!(glm::dot(mesh.normals[corners[corner]], normal) > least_cosine)) return false;
    return true;
}

/// The points of a tile's receivers, along the camera's rays to them.
void find_points(const ModelLight& light, const NoisyLayers& layers, const Image<LightNeed>& needs,
                 const PixelTile& tile, std::uint32_t lanes, RayCounts& rays,
                 Image<ModelPoint>& points) {
    const glm::vec3 camera(layers.world_from_camera.translation);
    RayPacket to_receivers;
    to_receivers.coherent = true;
    for (int lane = 0; lane < packet_width; ++lane) {
        if (!((lanes >> lane) & 1U)) continue;
        const glm::ivec2 p = tile.pixels[std::size_t(lane)];
        const glm::vec3 way = layers.real.position(p.x, p.y) - camera;
        if (layers.real.object(p.x, p.y) != 0 && glm::dot(way, way) > 0)
            to_receivers.set(lane, camera, glm::normalize(way));
    }
    const HitPacket hits = light.mesh->intersect(to_receivers);
    rays.primary += count(to_receivers);
    for (int lane = 0; lane < packet_width; ++lane) {
        const auto i = std::size_t(lane);
        if (!hits[i].hit()) continue;
        const glm::vec3 at = camera + hits[i].distance * to_receivers.direction[i];
        const std::size_t pixel = layers.m.index(tile.pixels[i].x, tile.pixels[i].y);
        if (!is_seen(light, hits[i], at, layers.real.position.pixels[pixel],
                     layers.real.normal.pixels[pixel]))
            continue;
        points.pixels[pixel] = {hits[i].triangle, hits[i].barycentric, needs.pixels[pixel]};
    }
}

/// Between the vertices, weighted; the rates are the largest.
VertexLight light_at(const ModelLight& light, const ModelPoint& point) {
    const glm::uvec3 corners = light.triangles().triangles[point.triangle];
    const glm::vec2& b = point.barycentric;
    const glm::vec3 weights = glm::max(glm::vec3(1 - b.x - b.y, b.x, b.y), 0.0f);
    VertexLight result;
    for (int corner = 0; corner < 3; ++corner) {
        const VertexLight& vertex =
            light.gathered[std::size_t(point.need)].vertices[corners[corner]];
        result.direct += weights[corner] * vertex.direct;
        result.indirect += weights[corner] * vertex.indirect;
        result.occluder_direct = std::max(result.occluder_direct, vertex.occluder_direct);
        result.occluder_indirect = std::max(result.occluder_indirect, vertex.occluder_indirect);
    }
    return result;
}

/// Sets E_R of a pixel, with rates within the pixel's own floor of distances.
void set_light(const VertexLight& light, std::size_t pixel, float occluder_floor,
               NoisyLayers& layers) {
    const auto set = [pixel](const Rgb& e_r, Irradiance& to) {
        to.e_r.pixels[pixel] = e_r;
        to.e_rv_real.pixels[pixel] += e_r;
    };
    set(light.direct, layers.direct);
    set(light.indirect, layers.indirect);
    const float floor =
        occluder_floor * glm::distance(layers.real.position.pixels[pixel],
                                       glm::vec3(layers.world_from_camera.translation));
    const float most = floor > 0 ? 1 / floor : std::numeric_limits<float>::infinity();
    layers.real.occluder_direct.pixels[pixel] = std::min(light.occluder_direct, most);
    layers.real.occluder_indirect.pixels[pixel] = std::min(light.occluder_indirect, most);
}

}  // namespace

bool takes_model_light(const SamplingSettings& settings) {
    return settings.estimator == Estimator::difference && !settings.unshadowed &&
           settings.gathered >= most_real_light_samples(settings);
}

std::unique_ptr<ModelLight> make_model_light(std::shared_ptr<const EmbreeScene> mesh,
                                             const EnvironmentSampler& environment,
                                             const SamplingSettings& settings, float offset) {
    if (!mesh || mesh->parts().size() != 1 || !mesh->parts()[0].mesh ||
        mesh->parts()[0].mesh->normals.empty())
        return nullptr;
    auto light = std::make_unique<ModelLight>();
    light->mesh = std::move(mesh);
    light->environment = environment;
    light->settings = settings;
    light->settings.unshadowed = false;
    light->settings.occluder_floor = 0;  // a share of the depth, which is the camera's
    light->geometry = mesh_alone(*light->mesh, offset);
    light->nets = make_light_nets(environment, settings.gathered, {settings.seed, 0, 0, 0});
    const std::size_t vertices = light->triangles().positions.size();
    for (std::size_t need = 0; need < light_need_count; ++need) {
        GatheredLight& gathered = light->gathered[need];
        gathered.samples = samples_for(LightNeed(need), settings.gathered);
        gathered.vertices.resize(vertices);
        gathered.known.resize((vertices + packet_width - 1) / packet_width, 0);
    }
    return light;
}

ModelLight* keep_model_light(std::unique_ptr<ModelLight>& kept,
                             std::shared_ptr<const EmbreeScene> mesh,
                             const EnvironmentSampler& environment,
                             const SamplingSettings& settings, float offset) {
    if (!takes_model_light(settings)) return nullptr;
    // All that gathering reads; what more it comes to read belongs here too.
    const bool same =
        kept && kept->mesh == mesh && kept->environment.fingerprint == environment.fingerprint &&
        kept->geometry.offset == offset && kept->settings.gathered == settings.gathered &&
        kept->settings.seed == settings.seed &&
        kept->settings.ignored_luminance == settings.ignored_luminance;
    if (!same) kept = make_model_light(std::move(mesh), environment, settings, offset);
    return kept.get();
}

Image<std::uint8_t> light_from_model(ModelLight& light, const Image<std::uint8_t>& chosen,
                                     const Image<LightNeed>& needs, float occluder_floor,
                                     TwoModeResult& result) {
    NoisyLayers& layers = result.layers;
    const Lens& lens = layers.lens;
    Image<ModelPoint> points(lens.width, lens.height);
    std::vector<RayCounts> row_rays{std::size_t(tile_rows(lens))};
    parallel_for(tile_rows(lens), [&](int row) {
        for (int column = 0; column < tile_columns(lens); ++column) {
            const PixelTile tile = tile_at(lens, column, row);
            find_points(light, layers, needs, tile, lanes_of(tile, chosen),
                        row_rays[std::size_t(row)], points);
        }
    });
    for (const RayCounts& row : row_rays)
        result.rays += row;
    const GatheringCost cost = gather_missing(light, points);
    result.gathering += cost.rays;
    layers.dropped_samples += cost.dropped;
    Image<std::uint8_t> left(lens.width, lens.height, 0);
    parallel_rows(lens.height, [&](int y) {
        for (int x = 0; x < lens.width; ++x) {
            const ModelPoint& point = points(x, y);
            if (point.triangle == ModelPoint::none)
                left(x, y) = chosen.empty() || chosen(x, y) != 0;
            else
                set_light(light_at(light, point), layers.m.index(x, y), occluder_floor, layers);
        }
    });
    return left;
}

}  // namespace inlay
