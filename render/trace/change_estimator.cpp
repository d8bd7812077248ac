// Rays that look for a change wait until 16 of them, of any pixels of the tile, make a packet.
#include "render/trace/change_estimator.h"

#include "render/trace/bounce.h"

#include <algorithm>
#include <bit>

namespace inlay {
namespace {

bool is_real(const Landing& landing) { return landing.kind == LandingKind::real; }

/// A direction from one of the tile's landings.
struct Try {
    std::size_t lane = 0;
    std::uint32_t number = 0;  // among those of the pixel
    glm::vec3 direction{0.0f};
    Rgb light{0};         // irradiance (cos / p weighted) that the environment sends from there
    float weight = 0;     // cos / p of radiance that surfaces send from there; 0: not asked
    bool bright = false;  // enough light to narrow the filter
    SurfaceHit on_virtual;
};

/// A packet that fills up.
struct Tries {
    std::array<Try, packet_width> tries;
    int count = 0;

    void add(const Try& t) { tries[std::size_t(count++)] = t; }
    bool full() const { return count == packet_width; }
};

/// What the tries of one camera ray of each pixel share.
struct Search {
    explicit Search(const ChangePass& c) : change(c), pass(c.pass) {}

    const ChangePass& change;
    SamplePass& pass;
    std::array<ChangeCones, packet_width> cones;
    std::array<LightRun, packet_width> runs{};   // of light tries
    std::array<float, packet_width> by_cones{};  // tries over the cones, on average
    Tries waiting;                               // for a packet against virtual geometry
    Tries met;  // virtual geometry; waiting for one against real geometry
};

RayPair rays_of(const Search& search, const Tries& tries) {
    RayPair rays;
    for (int k = 0; k < tries.count; ++k) {
        const Try& t = tries.tries[std::size_t(k)];
        rays.set(k, search.pass.landings[t.lane], t.direction, search.pass.scene.real.offset);
    }
    return rays;
}

void narrow(const Search& search, const Try& t) {
    const float rate = occluder_rate(search.pass.landings[t.lane], t.direction,
                                     t.on_virtual.distance, search.pass.settings);
    ChangeSums& sums = search.pass.sums[t.lane].change;
    widen(sums.rate_indirect, rate);
    if (t.bright) widen(sums.rate_direct, rate);
}

/// Light that virtual surfaces keep away, unless real ones do already.
void take_shadows(Search& search) {
    const RayPacket rays = rays_of(search, search.met).against_real;
    const std::uint32_t behind_real = search.pass.scene.real.occluded(rays);
    search.pass.rays.real_shadow += count(rays);
    for (int k = 0; k < search.met.count; ++k) {
        const Try& t = search.met.tries[std::size_t(k)];
        narrow(search, t);
        if (!((behind_real >> k) & 1U))
            search.pass.sums[t.lane].change.add(&ChangeSums::direct, -t.light);
    }
    search.met.count = 0;
}

/// The same, and the radiance of virtual surfaces in the place of real ones.
void exchange_surfaces(Search& search) {
    const RayPair rays = rays_of(search, search.met);
    SampleKeys keys = search.pass.keys;
    std::uint32_t nearest = 0;
    HitPacket hits;
    for (int k = 0; k < search.met.count; ++k) {
        const Try& t = search.met.tries[std::size_t(k)];
        keys[std::size_t(k)] = search.pass.keys[t.lane];
        keys[std::size_t(k)].sample = t.number;
        hits[std::size_t(k)] = t.on_virtual;
    }
    const RealHits behind = search.pass.scene.real.radiances(rays.against_real, keys);
    search.pass.rays.real_indirect += count(rays.against_real);
    for (int k = 0; k < search.met.count; ++k)
        if (hits[std::size_t(k)].distance <= behind.distance[std::size_t(k)]) nearest |= 1U << k;
    SamplePass mixed{search.pass.scene, search.pass.settings, search.pass.landings, keys,
                     search.pass.sums,  search.pass.rays,     search.pass.nets};
    const RadiancePacket sent = shade_virtual_hits(mixed, rays.against_virtual, hits, nearest);
    for (int k = 0; k < search.met.count; ++k) {
        const Try& t = search.met.tries[std::size_t(k)];
        if (!((nearest >> k) & 1U)) continue;
        const auto i = std::size_t(k);
        const bool open = behind.distance[i] == no_hit;
        narrow(search, t);
        ChangeSums& sums = search.pass.sums[t.lane].change;
        sums.hidden += double(t.weight);
        if (open) sums.add(&ChangeSums::direct, -t.light);
        sums.add(&ChangeSums::indirect, t.weight * (open ? sent[i] : sent[i] - behind.radiance[i]));
    }
    search.met.count = 0;
}

/// What becomes of tries that meet virtual geometry, and the class of rays that looks for it.
struct Follow {
    void (*step)(Search&);
    std::uint64_t RayCounts::*virtual_rays;
};
constexpr Follow shadows{take_shadows, &RayCounts::virtual_shadow};
constexpr Follow surfaces{exchange_surfaces, &RayCounts::virtual_indirect};

/// Half of the tries over the cones, with random numbers of its own.
struct Half {
    SampleDimension dimension;
    const Follow& follow;
};

void look_for_virtual(Search& search, const Follow& follow) {
    const RayPacket rays = rays_of(search, search.waiting).against_virtual;
    const HitPacket hits = search.pass.scene.virtual_objects.intersect(rays);
    search.pass.rays.*follow.virtual_rays += count(rays);
    for (int k = 0; k < search.waiting.count; ++k) {
        if (!hits[std::size_t(k)].hit()) continue;
        Try t = search.waiting.tries[std::size_t(k)];
        t.on_virtual = hits[std::size_t(k)];
        search.met.add(t);
        if (search.met.full()) follow.step(search);
    }
    search.waiting.count = 0;
}

/// Follows a try that has a direction above the surface, once a packet is full.
void follow_try(Search& search, const Try& t, const Follow& follow) {
    if (!(glm::dot(search.pass.landings[t.lane].normal, t.direction) > 0)) return;
    search.waiting.add(t);
    if (search.waiting.full()) look_for_virtual(search, follow);
}

/// The packets that are not full.
void follow_rest(Search& search, const Follow& follow) {
    if (search.waiting.count > 0) look_for_virtual(search, follow);
    if (search.met.count > 0) follow.step(search);
}

/// Irradiance from a direction, weighted with the density of all tries that may draw it.
Rgb weighted(const Search& search, std::size_t lane, const LightSample& light, float by_cones) {
    const float cosine = glm::dot(search.pass.landings[lane].normal, light.direction);
    return light.radiance * (cosine / (float(search.change.counts.light) * light.pdf +
                                       search.by_cones[lane] * by_cones));
}

/// A sample of the pixel's light, if virtual geometry may be seen there.
void try_light(Search& search, std::size_t lane, const LightSample& light) {
    const ChangeCones& cones = search.cones[lane];
    if (!(may_hold(cones, light.direction) && light.pdf > 0)) return;
    const float by_cones = pdf_cones(cones, light.direction);
    if (by_cones == 0) return;
    follow_try(search,
               {lane,
                0,
                light.direction,
                weighted(search, lane, light, by_cones),
                0,
                counts_as_occluded(search.pass, light.radiance),
                {}},
               shadows);
}

/// Eight samples of the pixel's light that stand together; most lie in no cone.
void try_eight_lights(Search& search, std::size_t lane, std::size_t first) {
    const LightNets& nets = search.pass.nets;
    const auto plane = [&](std::size_t axis) {
        return Floats(&nets.direction[axis][first], stdx::element_aligned);
    };
    const Lanes held = may_hold(search.cones[lane], Vectors{plane(0), plane(1), plane(2)});
    if (stdx::none_of(held)) return;
    for (std::size_t k = 0; k < lane_count; ++k)
        if (held[k]) try_light(search, lane, nets.samples[first + k]);
}

void try_lights(Search& search) {
    const LightNets& nets = search.pass.nets;
    const int tries = search.change.counts.light;
    for (std::size_t lane = 0; lane < packet_width; ++lane) {
        if (search.cones[lane].empty()) continue;
        const LightRun& run = search.runs[lane];
        const int begin = search.change.ray * tries;
        if (tries % lane_count == 0 && nets.samples.size() >= lane_count) {
            for (int n = begin; n < begin + tries; n += lane_count)
                try_eight_lights(search, lane, nets.first_of_eight(run, n));
        } else {
            for (int n = begin; n < begin + tries; ++n)
                try_light(search, lane, nets.at(run, n));
        }
    }
    follow_rest(search, shadows);
}

Try try_cone(const Search& search, std::size_t lane, const StratifiedSet& points, int number) {
    const DirectionSample drawn =
        sample_cones(search.cones[lane], points.at(std::uint32_t(number)));
    if (!(drawn.pdf > 0)) return {};
    const LightSample light = sample_along(search.pass.scene.environment, drawn.direction);
    const float cosine = glm::dot(search.pass.landings[lane].normal, drawn.direction);
    return {lane,
            std::uint32_t(number),
            drawn.direction,
            weighted(search, lane, light, drawn.pdf),
            cosine / (0.5f * search.by_cones[lane] * drawn.pdf),
            counts_as_occluded(search.pass, light.radiance),
            {}};
}

/// One half of the tries over the cones: whole numbers of them, whose sum over a pixel's rays is
/// rounded up or down at random to the right mean.
void try_cones(Search& search, const Half& half) {
    const int most = (search.pass.settings.primary * search.change.counts.cones + 1) / 2;
    for (std::size_t lane = 0; lane < packet_width; ++lane) {
        if (search.cones[lane].empty()) continue;
        SampleKey key = search.pass.keys[lane];
        key.sample = 0;  // one rounding for all rays of the pixel
        const float rounding = uniform(key, half.dimension);
        const float before = search.pass.sums[lane].change.cone_tries;
        const int end = int(before + 0.5f * search.by_cones[lane] + rounding);
        const StratifiedSet points = shared_set(key, half.dimension, most);
        for (int number = int(before + rounding); number < end; ++number)
            follow_try(search, try_cone(search, lane, points, number), half.follow);
    }
    follow_rest(search, half.follow);
}

/// Cones that would send this share of an even sky's irradiance, or more, get all tries: a change
/// of a tenth of the light is plainly seen.
constexpr float full_fill = 0.1f;
/// Of all tries, at least: one for a pixel of 4 x 4 samples.
constexpr float least_share = 1.0f / 16;

}  // namespace

ChangeCounts change_counts(const TwoModeScene& scene, const SamplingSettings& settings) {
    const bool lit = scene.environment.mean_luminance > 0;
    return {lit ? settings.light_tries * settings.secondary : 0, settings.secondary};
}

void add_change(const ChangePass& change) {
    const SamplePass& pass = change.pass;
    Search search(change);
    const int run =
        int(std::bit_ceil(unsigned(std::max(1, pass.settings.primary * change.counts.light))));
    for (std::size_t i = 0; i < packet_width; ++i) {
        search.cones[i].count = 0;
        search.cones[i].hemisphere = 0;
        const Landing& landing = pass.landings[i];
        if (!is_real(landing)) continue;
        ++change.pass.sums[i].change.camera_rays;
        search.runs[i] = pass.nets.run(pass.keys[i], change_by_light, run);
        const glm::vec3 start =
            ray_origin(landing.position, landing.geometric_normal, landing.normal, surface_offset);
        find_cones(pass.scene.virtual_objects.bounds(), start, landing.normal, search.cones[i]);
        search.by_cones[i] = float(change.counts.cones) *
                             std::clamp(search.cones[i].fill / full_fill, least_share, 1.0f);
    }
    try_lights(search);
    try_cones(search, {change_by_cones, surfaces});
    if (change.counts.light > 0) try_cones(search, {change_by_cones_again, shadows});
    for (std::size_t i = 0; i < packet_width; ++i)
        if (!search.cones[i].empty()) pass.sums[i].change.cone_tries += 0.5f * search.by_cones[i];
}

}  // namespace inlay
