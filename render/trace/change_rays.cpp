#include "render/trace/change_rays.h"

#include "render/trace/bounce.h"

#include <span>

namespace inlay {
namespace {

using Tries = std::span<const ChangeTry>;

RayPair rays_of(Tries tries, const SamplePass& pass) {
    RayPair rays;
    for (std::size_t k = 0; k < tries.size(); ++k)
        rays.set(int(k), *tries[k].from, tries[k].direction, pass.scene.real.offset);
    return rays;
}

/// Expected tries of both kinds there, per steradian: samples weighted by them are those of the
/// balance heuristic.
float all_tries(const ChangeRays& rays, const ChangeTry& t) {
    return float(rays.light_tries) * t.light.pdf + t.cone_density;
}

/// Irradiance that the environment sends from there.
Rgb light_of(const ChangeRays& rays, const ChangeTry& t) {
    return t.light.radiance * (glm::dot(t.from->normal, t.direction) / all_tries(rays, t));
}

void narrow(const ChangeTry& t, const SamplePass& pass) {
    const float rate = occluder_rate(*t.from, t.direction, t.on_virtual.distance, pass.settings);
    widen(t.sums->rate_indirect, rate);
    if (counts_as_occluded(pass, t.light.radiance)) widen(t.sums->rate_direct, rate);
}

/// Light that virtual surfaces keep away, unless real ones do already.
void take_shadows(const ChangeRays& rays, Tries met, SamplePass& pass) {
    const RayPacket to_light = rays_of(met, pass).against_real;
    const std::uint32_t behind_real = pass.scene.real.occluded(to_light);
    pass.rays.real_shadow += count(to_light);
    for (std::size_t k = 0; k < met.size(); ++k) {
        const ChangeTry& t = met[k];
        narrow(t, pass);
        if (!((behind_real >> k) & 1U)) t.sums->add(&ChangeSums::direct, -light_of(rays, t));
    }
}

/// The same, and the radiance of virtual surfaces in the place of real ones, of which half of the
/// tries over the cones are samples.
void exchange_surfaces(const ChangeRays& rays, Tries met, SamplePass& pass) {
    const RayPair ways = rays_of(met, pass);
    SampleKeys keys{};
    std::uint32_t nearest = 0;
    HitPacket hits;
    for (std::size_t k = 0; k < met.size(); ++k) {
        keys[k] = met[k].key;
        hits[k] = met[k].on_virtual;
    }
    const RealHits behind = pass.scene.real.radiances(ways.against_real, keys);
    pass.rays.real_indirect += count(ways.against_real);
    for (std::size_t k = 0; k < met.size(); ++k)
        if (hits[k].distance <= behind.distance[k]) nearest |= 1U << k;
    LightRuns runs;  // the lanes are those of no tile
    SamplePass mixed{pass.scene, pass.settings, pass.landings, keys,
                     pass.sums,  pass.rays,     pass.nets,     runs};
    const RadiancePacket sent = shade_virtual_hits(mixed, ways.against_virtual, hits, nearest);
    for (std::size_t k = 0; k < met.size(); ++k) {
        const ChangeTry& t = met[k];
        if (!((nearest >> k) & 1U)) continue;
        const bool open = behind.distance[k] == no_hit;
        const float weight = glm::dot(t.from->normal, t.direction) / (0.5f * t.cone_density);
        narrow(t, pass);
        t.sums->hidden += double(weight);
        if (open) t.sums->add(&ChangeSums::direct, -light_of(rays, t));
        t.sums->add(&ChangeSums::indirect,
                    weight * (open ? sent[k] : sent[k] - behind.radiance[k]));
    }
}

void ask_real(ChangeRays& rays, SamplePass& pass) {
    const Tries met(rays.met.data(), std::size_t(rays.met_count));
    if (rays.kind == ChangeKind::shadows)
        take_shadows(rays, met, pass);
    else
        exchange_surfaces(rays, met, pass);
    rays.met_count = 0;
}

void ask_virtual(ChangeRays& rays, SamplePass& pass) {
    const Tries waiting(rays.waiting.data(), std::size_t(rays.waiting_count));
    const RayPacket ways = rays_of(waiting, pass).against_virtual;
    const HitPacket hits = pass.scene.virtual_objects.intersect(ways);
    (rays.kind == ChangeKind::shadows ? pass.rays.virtual_shadow : pass.rays.virtual_indirect) +=
        count(ways);
    rays.waiting_count = 0;
    for (std::size_t k = 0; k < waiting.size(); ++k) {
        if (!hits[k].hit()) continue;
        ChangeTry& t = rays.met[std::size_t(rays.met_count++)];
        t = waiting[k];
        t.on_virtual = hits[k];
        if (!t.knows_light) t.light = sample_along(pass.scene.environment, t.direction);
        if (rays.met_count == packet_width) ask_real(rays, pass);
    }
}

}  // namespace

void follow(ChangeRays& rays, const ChangeTry& t, SamplePass& pass) {
    if (!(glm::dot(t.from->normal, t.direction) > 0)) return;
    rays.waiting[std::size_t(rays.waiting_count++)] = t;
    if (rays.waiting_count == packet_width) ask_virtual(rays, pass);
}

void follow_rest(ChangeRays& rays, SamplePass& pass) {
    if (rays.waiting_count > 0) ask_virtual(rays, pass);
    if (rays.met_count > 0) ask_real(rays, pass);
}

}  // namespace inlay
