#include "render/trace/two_mode_sampler.h"

#include "recordings/base/check.h"
#include "recordings/base/parallel.h"
#include "render/scatter/bsdf.h"
#include "render/trace/pixel_sums.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace inlay {
namespace {

constexpr float pi = std::numbers::pi_v<float>;
constexpr int tile_size = 4;  // a packet is the same sample of 4 x 4 pixels
static_assert(tile_size * tile_size == packet_width);

/// Dimensions of the random numbers. The path tracer behind exact real geometry starts at 64.
enum Dimension : std::uint32_t {
    position_in_pixel,
    light,
    diffuse_lobe,
    glossy_lobe,
    light_at_hit
};

enum class Kind { nothing, real, on_virtual };

/// Where one primary sample landed.
struct Landing {
    Kind kind = Kind::nothing;
    float distance = 0;                              // m, from the camera
    glm::vec3 position{0.0f};                        // m, world
    glm::vec3 geometric_normal{0.0f}, normal{0.0f};  // unit, world, towards the camera
    Bsdf bsdf;                                       // of virtual surfaces
    ScatterFrame frame;
    std::uint32_t object = 0;
};

using Landings = std::array<Landing, packet_width>;

struct Tile {
    int x0 = 0, y0 = 0;
    std::array<glm::ivec2, packet_width> pixels{};
    std::uint32_t inside = 0;  // lanes within the image
    std::array<PixelSums, packet_width> sums;
    RayCounts rays;
};

/// One packet of samples, with everything that its estimators share.
struct Pass {
    const TwoModeScene& scene;
    const SamplingSettings& settings;
    Tile& tile;
    SampleKeys keys;
    Landings landings;
};

int count(std::uint32_t mask) { return __builtin_popcount(mask); }

Tile make_tile(const Lens& lens, int index) {
    const int columns = (lens.width + tile_size - 1) / tile_size;
    Tile tile;
    tile.x0 = index % columns * tile_size;
    tile.y0 = index / columns * tile_size;
    for (int lane = 0; lane < packet_width; ++lane) {
        const glm::ivec2 p{tile.x0 + lane % tile_size, tile.y0 + lane / tile_size};
        tile.pixels[std::size_t(lane)] = p;
        if (p.x < lens.width && p.y < lens.height) tile.inside |= 1U << lane;
    }
    return tile;
}

SampleKeys keys_of(const Tile& tile, const Lens& lens, std::uint32_t seed, std::uint32_t frame,
                   int sample) {
    SampleKeys keys;
    for (std::size_t i = 0; i < packet_width; ++i) {
        const glm::ivec2 p = tile.pixels[i];
        keys[i] = {seed, frame, std::uint32_t(p.y * lens.width + p.x), std::uint32_t(sample)};
    }
    return keys;
}

RayPacket camera_rays(const TwoModeScene& scene, const Tile& tile, const SampleKeys& keys) {
    RayPacket rays;
    rays.coherent = true;
    const glm::vec3 origin(scene.world_from_camera.translation);
    for (int lane = 0; lane < packet_width; ++lane) {
        if (!((tile.inside >> lane) & 1U)) continue;
        const auto i = std::size_t(lane);
        const glm::dvec2 u(stratified_pair(keys[i], position_in_pixel));
        const glm::dvec3 in_camera = unproject(scene.lens, glm::dvec2(tile.pixels[i]) + u - 0.5);
        rays.set(lane, origin,
                 glm::vec3(glm::normalize(scene.world_from_camera.rotation * in_camera)));
    }
    return rays;
}

Landing land_on_virtual(const EmbreeScene& objects, const SurfaceHit& hit, const glm::vec3& origin,
                        const glm::vec3& direction) {
    const PlacedPart& part = objects.parts()[hit.part];
    const SurfacePoint point = objects.surface_point(hit, origin, direction);
    Landing landing;
    landing.kind = Kind::on_virtual;
    landing.distance = hit.distance;
    landing.position = point.position;
    const bool behind = glm::dot(point.geometric_normal, direction) > 0;
    landing.geometric_normal = behind ? -point.geometric_normal : point.geometric_normal;
    landing.bsdf = bsdf_at(part.material, point.uv);
    landing.frame = scatter_frame(point.shading_normal, -direction);
    landing.normal = landing.frame.world_from_local[2];
    landing.object = part.object + 1;
    return landing;
}

/// Nearest of real and virtual for each camera ray; a real surface hides a virtual one only if it
/// is nearer by more than the tolerance.
Landings land(const TwoModeScene& scene, const SamplingSettings& settings, const RayPacket& rays,
              Tile& tile) {
    const HitPacket on_virtual = scene.virtual_objects.intersect(rays);
    const auto on_real = scene.real.primary(rays, tile.pixels);
    tile.rays.primary += std::uint64_t(count(rays.active));
    Landings landings;
    for (int lane = 0; lane < packet_width; ++lane) {
        if (!rays.has(lane)) continue;
        const auto i = std::size_t(lane);
        const float tolerated = on_real[i].distance * (1 + settings.depth_tolerance);
        if (on_virtual[i].hit() && !(tolerated < on_virtual[i].distance)) {
            landings[i] = land_on_virtual(scene.virtual_objects, on_virtual[i], rays.origin[i],
                                          rays.direction[i]);
        } else if (on_real[i].distance != no_hit) {
            Landing& landing = landings[i];
            landing.kind = Kind::real;
            landing.distance = on_real[i].distance;
            landing.position = on_real[i].position;
            landing.normal = landing.geometric_normal = on_real[i].normal;
            landing.object = 1;
        }
    }
    return landings;
}

void count_landings(const Landings& landings, Tile& tile) {
    for (int lane = 0; lane < packet_width; ++lane) {
        if (!((tile.inside >> lane) & 1U)) continue;
        const Landing& landing = landings[std::size_t(lane)];
        PixelSums& sums = tile.sums[std::size_t(lane)];
        ++sums.primary;
        if (landing.kind == Kind::nothing) continue;
        ReceiverSums& receiver = landing.kind == Kind::real ? sums.real : sums.virtual_;
        if (receiver.hits++ == 0) receiver.object = landing.object;
        receiver.position += glm::dvec3(landing.position);
        receiver.normal += glm::dvec3(landing.normal);
        if (landing.kind != Kind::on_virtual) continue;
        sums.albedo.add(landing.bsdf.diffuse);
        sums.glossy_bandwidth = std::max(sums.glossy_bandwidth, glossy_bandwidth(landing.bsdf));
    }
}

/// Rays from the landings against one kind of geometry: each kind has its own distance to start at.
struct RayPair {
    RayPacket against_virtual, against_real;

    void set(int lane, const Landing& from, const glm::vec3& direction, float real_offset) {
        const float offset = from.kind == Kind::real ? real_offset : surface_offset;
        against_virtual.set(
            lane, ray_origin(from.position, from.geometric_normal, direction, surface_offset),
            direction);
        against_real.set(lane, ray_origin(from.position, from.geometric_normal, direction, offset),
                         direction);
    }
};

/// cos/r (1/m) of an occluder, with distances below the floor counted as the floor.
float occluder_rate(const Landing& from, const glm::vec3& direction, float distance,
                    const SamplingSettings& settings) {
    const float cosine = std::max(0.0f, glm::dot(from.normal, direction));
    return cosine / std::max(distance, settings.occluder_floor * from.distance);
}

void widen(float& rate, float candidate) { rate = std::max(rate, candidate); }

/// Environment light through shadow rays: E_dir of both modes, and the glossy lobe's share of it.
void add_direct(Pass& pass) {
    std::array<LightSample, packet_width> lights;
    RayPair rays;
    for (int lane = 0; lane < packet_width; ++lane) {
        const auto i = std::size_t(lane);
        const Landing& from = pass.landings[i];
        if (from.kind == Kind::nothing) continue;
        lights[i] =
            sample_environment(pass.scene.environment, stratified_pair(pass.keys[i], light));
        if (lights[i].pdf > 0 && glm::dot(from.normal, lights[i].direction) > 0)
            rays.set(lane, from, lights[i].direction, pass.scene.real.offset);
    }
    const HitPacket on_virtual = pass.scene.virtual_objects.intersect(rays.against_virtual);
    const DistancePacket on_real = pass.scene.real.distances(rays.against_real);
    pass.tile.rays.virtual_shadow += std::uint64_t(count(rays.against_virtual.active));
    pass.tile.rays.real_shadow += std::uint64_t(count(rays.against_real.active));

    const float ignored = pass.settings.ignored_luminance * pass.scene.environment.mean_luminance;
    for (int lane = 0; lane < packet_width; ++lane) {
        const auto i = std::size_t(lane);
        const Landing& from = pass.landings[i];
        if (from.kind == Kind::nothing) continue;
        PixelSums& sums = pass.tile.sums[i];
        const bool traced = rays.against_virtual.has(lane);
        const float distance = traced ? std::min(on_virtual[i].distance, on_real[i]) : no_hit;
        ReceiverSums& receiver = from.kind == Kind::real ? sums.real : sums.virtual_;
        if (distance != no_hit && luminance(lights[i].radiance) >= ignored)
            widen(receiver.occluder_direct,
                  occluder_rate(from, lights[i].direction, distance, pass.settings));

        const float cosine = traced ? glm::dot(from.normal, lights[i].direction) : 0.0f;
        const Rgb unblocked = traced ? lights[i].radiance * (cosine / lights[i].pdf) : Rgb(0);
        const Rgb real_only = traced && on_real[i] == no_hit ? unblocked : Rgb(0);
        const Rgb with_virtual = traced && !on_virtual[i].hit() ? real_only : Rgb(0);
        if (from.kind == Kind::real) {
            sums.direct.add(real_only, with_virtual);
            continue;
        }
        sums.direct_virtual.add(with_virtual);
        if (!from.bsdf.glossy) continue;
        const float combined =
            lights[i].pdf +
            (traced ? pdf_glossy(from.bsdf, from.frame, lights[i].direction) : 0.0f);
        const bool lit = traced && distance == no_hit;
        sums.glossy_direct.add(lit ? eval_glossy(from.bsdf, from.frame, lights[i].direction) *
                                         lights[i].radiance / combined
                                   : Rgb(0));
    }
}

/// Radiance that virtual surfaces send back along indirect rays: shaded with one environment sample
/// each, shadowed by real and virtual geometry.
RadiancePacket shade_virtual_hits(Pass& pass, const RayPacket& rays, const HitPacket& hits,
                                  std::uint32_t lanes) {
    RadiancePacket radiance{};
    RayPacket shadow;
    for (int lane = 0; lane < packet_width; ++lane) {
        if (!((lanes >> lane) & 1U)) continue;
        const auto i = std::size_t(lane);
        const Landing at =
            land_on_virtual(pass.scene.virtual_objects, hits[i], rays.origin[i], rays.direction[i]);
        const LightSample sample =
            sample_environment(pass.scene.environment, stratified_pair(pass.keys[i], light_at_hit));
        const float cosine = glm::dot(at.normal, sample.direction);
        if (!(sample.pdf > 0 && cosine > 0)) continue;
        radiance[i] =
            (at.bsdf.diffuse * (cosine / pi) + eval_glossy(at.bsdf, at.frame, sample.direction)) *
            sample.radiance / sample.pdf;
        shadow.set(lane,
                   ray_origin(at.position, at.geometric_normal, sample.direction, surface_offset),
                   sample.direction);
    }
    if (shadow.active == 0) return radiance;
    const std::uint32_t by_virtual = pass.scene.virtual_objects.occluded(shadow);
    const DistancePacket by_real = pass.scene.real.distances(shadow);
    pass.tile.rays.virtual_shadow += std::uint64_t(count(shadow.active));
    pass.tile.rays.real_shadow += std::uint64_t(count(shadow.active));
    for (int lane = 0; lane < packet_width; ++lane) {
        const auto i = std::size_t(lane);
        if (((by_virtual >> lane) & 1U) || by_real[i] != no_hit) radiance[i] = Rgb(0);
    }
    return radiance;
}

/// What a packet of indirect rays brings back, in both modes; 0 where it meets no surface.
struct Bounce {
    RadiancePacket real_only{}, with_virtual{};
    DistancePacket distance;  // of the nearest surface, real or virtual
};

Bounce bounce(Pass& pass, const RayPair& rays) {
    const HitPacket on_virtual = pass.scene.virtual_objects.intersect(rays.against_virtual);
    const RealHits on_real = pass.scene.real.radiances(rays.against_real, pass.keys);
    pass.tile.rays.virtual_indirect += std::uint64_t(count(rays.against_virtual.active));
    pass.tile.rays.real_indirect += std::uint64_t(count(rays.against_real.active));
    std::uint32_t virtual_nearest = 0;
    Bounce result;
    for (int lane = 0; lane < packet_width; ++lane) {
        const auto i = std::size_t(lane);
        result.distance[i] = std::min(on_virtual[i].distance, on_real.distance[i]);
        if (on_real.distance[i] != no_hit) result.real_only[i] = on_real.radiance[i];
        if (on_virtual[i].hit() && on_virtual[i].distance <= on_real.distance[i])
            virtual_nearest |= 1U << lane;
    }
    result.with_virtual =
        shade_virtual_hits(pass, rays.against_virtual, on_virtual, virtual_nearest);
    for (int lane = 0; lane < packet_width; ++lane) {
        if (!((virtual_nearest >> lane) & 1U))
            result.with_virtual[std::size_t(lane)] = result.real_only[std::size_t(lane)];
    }
    return result;
}

/// One bounce along the cosine lobe: E_ind of both modes. cos / pdf = pi, which Algorithm 1 leaves
/// out.
void add_indirect(Pass& pass) {
    RayPair rays;
    for (int lane = 0; lane < packet_width; ++lane) {
        const Landing& from = pass.landings[std::size_t(lane)];
        if (from.kind == Kind::nothing) continue;
        const glm::vec2 u = stratified_pair(pass.keys[std::size_t(lane)], diffuse_lobe);
        rays.set(lane, from, basis_about(from.normal) * sample_cosine_hemisphere(u).direction,
                 pass.scene.real.offset);
    }
    const Bounce light_back = bounce(pass, rays);
    for (std::size_t i = 0; i < packet_width; ++i) {
        const Landing& from = pass.landings[i];
        if (from.kind == Kind::nothing) continue;
        PixelSums& sums = pass.tile.sums[i];
        ReceiverSums& receiver = from.kind == Kind::real ? sums.real : sums.virtual_;
        if (light_back.distance[i] != no_hit)
            widen(receiver.occluder_indirect, occluder_rate(from, rays.against_virtual.direction[i],
                                                            light_back.distance[i], pass.settings));
        if (from.kind == Kind::real) {
            sums.indirect.add(pi * light_back.real_only[i], pi * light_back.with_virtual[i]);
        } else {
            sums.indirect_virtual.add(pi * light_back.with_virtual[i]);
        }
    }
}

/// Light along the glossy lobe of virtual surfaces: what it meets, and its share of the
/// environment.
void add_glossy(Pass& pass) {
    std::array<DirectionSample, packet_width> lobe;
    RayPair rays;
    for (int lane = 0; lane < packet_width; ++lane) {
        const auto i = std::size_t(lane);
        const Landing& from = pass.landings[i];
        if (from.kind != Kind::on_virtual || !from.bsdf.glossy) continue;
        lobe[i] = sample_glossy(from.bsdf, from.frame, stratified_pair(pass.keys[i], glossy_lobe));
        if (lobe[i].pdf > 0) rays.set(lane, from, lobe[i].direction, pass.scene.real.offset);
    }
    if (rays.against_virtual.active == 0) return;
    const Bounce light_back = bounce(pass, rays);
    for (int lane = 0; lane < packet_width; ++lane) {
        const auto i = std::size_t(lane);
        const Landing& from = pass.landings[i];
        if (from.kind != Kind::on_virtual || !from.bsdf.glossy) continue;
        Rgb value(0);
        if (rays.against_virtual.has(lane)) {
            const Rgb scattered = eval_glossy(from.bsdf, from.frame, lobe[i].direction);
            const EnvironmentSampler& environment = pass.scene.environment;
            value = light_back.distance[i] == no_hit
                        ? scattered * radiance_from(environment.map, lobe[i].direction) /
                              (lobe[i].pdf + pdf_environment(environment, lobe[i].direction))
                        : scattered * light_back.with_virtual[i] / lobe[i].pdf;
        }
        pass.tile.sums[i].glossy_indirect.add(value);
    }
}

void sample_tile(const TwoModeScene& scene, const SamplingSettings& settings, std::uint32_t frame,
                 Tile& tile) {
    for (int p = 0; p < settings.primary; ++p) {
        const SampleKeys primary_keys = keys_of(tile, scene.lens, settings.seed, frame, p);
        const RayPacket rays = camera_rays(scene, tile, primary_keys);
        const Landings landings = land(scene, settings, rays, tile);
        count_landings(landings, tile);
        for (int s = 0; s < settings.secondary; ++s) {
            const int sample = p * settings.secondary + s;
            Pass pass{scene, settings, tile,
                      keys_of(tile, scene.lens, settings.seed, frame, sample), landings};
            add_direct(pass);
            add_indirect(pass);
            add_glossy(pass);
        }
    }
}

void add(RayCounts& sum, const RayCounts& more) {
    sum.primary += more.primary;
    sum.virtual_shadow += more.virtual_shadow;
    sum.virtual_indirect += more.virtual_indirect;
    sum.real_shadow += more.real_shadow;
    sum.real_indirect += more.real_indirect;
}

}  // namespace

void validate(const SamplingSettings& s) {
    require(s.primary > 0 && s.secondary > 0, "trace.primary and trace.secondary must be positive",
            ExitCode::usage);
    for (const float share : {s.depth_tolerance, s.occluder_floor, s.ignored_luminance})
        require(share >= 0 && share <= 1, "trace: shares must lie within 0..1", ExitCode::usage);
}

SamplingSettings with_samples(SamplingSettings settings, int samples) {
    require(samples > 0 && (samples < 4 || samples % 4 == 0),
            "--samples " + std::to_string(samples) + ": expected 1, 2, 3 or a multiple of 4",
            ExitCode::usage);
    settings.primary = std::min(samples, 4);
    settings.secondary = samples / settings.primary;
    return settings;
}

TwoModeResult sample_two_modes(const TwoModeScene& scene, const SamplingSettings& settings,
                               std::uint32_t frame) {
    const Lens& lens = scene.lens;
    TwoModeResult result{
        make_noisy_layers(lens, scene.world_from_camera, settings.primary * settings.secondary),
        {}};
    const int columns = (lens.width + tile_size - 1) / tile_size;
    const int rows = (lens.height + tile_size - 1) / tile_size;
    std::vector<RayCounts> row_rays{std::size_t(rows)};
    std::vector<std::uint64_t> row_dropped(std::size_t(rows), 0);
    parallel_for(rows, [&](int row) {
        for (int column = 0; column < columns; ++column) {
            Tile tile = make_tile(lens, row * columns + column);
            sample_tile(scene, settings, frame, tile);
            add(row_rays[std::size_t(row)], tile.rays);
            for (int lane = 0; lane < packet_width; ++lane) {
                if (!((tile.inside >> lane) & 1U)) continue;
                const auto i = std::size_t(lane);
                store(tile.sums[i], tile.pixels[i].x, tile.pixels[i].y, result.layers);
                row_dropped[std::size_t(row)] += std::uint64_t(dropped(tile.sums[i]));
            }
        }
    });
    for (std::size_t row = 0; row < row_rays.size(); ++row) {
        add(result.rays, row_rays[row]);
        result.layers.dropped_samples += row_dropped[row];
    }
    return result;
}

}  // namespace inlay
