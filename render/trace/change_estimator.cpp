#include "render/trace/change_estimator.h"

#include "render/trace/change_cones.h"
#include "render/trace/change_rays.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

namespace inlay {
namespace {

bool is_real(const Landing& landing) { return landing.kind == LandingKind::real; }

/// Half of the tries over the cones.
struct Half {
    ChangeRays rays;
    SampleDimension dimension;  // of its random numbers
    StratifiedSet points;       // of all pixels
};

/// A quarter of the smallest bound's radius: from afar its cone grows by 9/16 at most.
float largest_shared_reach(const std::vector<BoundingSphere>& bounds) {
    float smallest = 0;
    for (const BoundingSphere& sphere : bounds)
        if (smallest == 0 || sphere.radius < smallest) smallest = sphere.radius;
    return smallest / 4;
}

/// What all pixels of a tile share.
struct Search {
    Search(const TilePass& tile, std::span<const Landings> landings, int ray)
        : counts(change_counts(tile.scene, tile.settings)),
          camera_rays(landings),
          first_ray(ray),
          pass(tile.from(landings[0], tile.keys(0))),
          surfaces(half(ChangeKind::surfaces, change_by_cones)),
          shadows(half(ChangeKind::shadows, change_by_cones_again)),
          shared_reach(largest_shared_reach(tile.scene.virtual_objects.bounds())) {}
    Half half(ChangeKind kind, SampleDimension dimension) const {
        return {{kind, counts.light}, dimension, frame_set(pass.keys[0], dimension)};
    }

    ChangeCounts counts;
    std::span<const Landings> camera_rays;
    int first_ray;
    SamplePass pass;  // of the first of them
    Half surfaces, shadows;
    float shared_reach;  // m: from points this close to each other bounds look nearly alike
};

/// Points on one surface, and the smallest ball about them.
struct Vicinity {
    glm::vec3 position{0.0f}, normal{0.0f};
    float reach = 0;  // m, of the points about `position`
};

Vicinity vicinity_of(const Landing& landing) {
    return {ray_origin(landing.position, landing.geometric_normal, landing.normal, surface_offset),
            landing.normal, 0};
}

/// Of all camera rays of a pixel that landed on real surfaces, if these have one normal and the
/// points are so close that bounds look nearly alike from all of them.
std::optional<Vicinity> common_vicinity(const Search& search, std::size_t lane) {
    Vicinity common;
    int count = 0;
    for (const Landings& landings : search.camera_rays) {
        if (!is_real(landings[lane])) continue;
        const Vicinity one = vicinity_of(landings[lane]);
        if (count++ == 0) common.normal = one.normal;
        common.position += one.position;
        if (one.normal != common.normal) return std::nullopt;
    }
    common.position /= float(std::max(1, count));
    for (const Landings& landings : search.camera_rays) {
        if (!is_real(landings[lane])) continue;
        const float apart = glm::distance(common.position, vicinity_of(landings[lane]).position);
        common.reach = std::max(common.reach, apart);
    }
    return common.reach <= search.shared_reach ? std::optional(common) : std::nullopt;
}

/// Cones that would send this share of an even sky's irradiance, or more, get all tries: a change
/// of a tenth of the light is plainly seen.
constexpr float full_fill = 0.1f;
/// Of all tries, at least: one for a pixel of 4 x 4 samples.
constexpr float least_share = 1.0f / 16;

/// A pixel's part of a half.
struct HalfOfPixel {
    Half& half;
    StratifiedSet points{};
    float rounding = 0;  // one for all its rays
};

/// One pixel's search.
struct PixelSearch {
    Search& search;
    std::size_t lane;
    HalfOfPixel surfaces{search.surfaces}, shadows{search.shadows};
    LightRun run{};  // of its light tries
    ChangeCones cones{};
    float by_cones = 0;  // tries over the cones, on average

    const SampleKey& key() const { return search.pass.keys[lane]; }
    ChangeSums& sums() const { return search.pass.sums[lane].change; }

    void look_from(const Vicinity& place) {
        find_cones(search.pass.scene.virtual_objects.bounds(), place.position, place.normal,
                   place.reach, cones);
        by_cones =
            float(search.counts.cones) * std::clamp(cones.fill / full_fill, least_share, 1.0f);
    }
};

/// A sample of the pixel's light, if virtual geometry may be seen there.
void try_light(PixelSearch& pixel, const Landing& from, const LightSample& light) {
    if (!(may_hold(pixel.cones, light.direction) && light.pdf > 0 &&
          glm::dot(from.normal, light.direction) > 0))
        return;
    const float density = pdf_cones(pixel.cones, light.direction);
    if (density == 0) return;
    ChangeTry t;
    t.from = &from;
    t.sums = &pixel.sums();
    t.direction = light.direction;
    t.cone_density = pixel.by_cones * density;
    t.light = light;
    t.knows_light = true;
    follow(pixel.search.shadows.rays, t, pixel.search.pass);
}

/// Eight samples of the pixel's light that stand together; most lie in no cone.
void try_eight_lights(PixelSearch& pixel, const Landing& from, std::size_t first) {
    const LightNets& nets = pixel.search.pass.nets;
    const auto plane = [&](std::size_t axis) {
        return Floats(&nets.direction[axis][first], stdx::element_aligned);
    };
    const Lanes held = may_hold(pixel.cones, Vectors{plane(0), plane(1), plane(2)});
    if (stdx::none_of(held)) return;
    for (std::size_t k = 0; k < lane_count; ++k)
        if (held[k]) try_light(pixel, from, nets.samples[first + k]);
}

void try_lights(PixelSearch& pixel, const Landing& from, int ray) {
    const LightNets& nets = pixel.search.pass.nets;
    const int tries = pixel.search.counts.light;
    const int begin = ray * tries;
    if (tries % lane_count == 0 && nets.samples.size() >= lane_count) {
        for (int n = begin; n < begin + tries; n += lane_count)
            try_eight_lights(pixel, from, nets.first_of_eight(pixel.run, n));
    } else {
        for (int n = begin; n < begin + tries; ++n)
            try_light(pixel, from, nets.at(pixel.run, n));
    }
}

void try_cone(PixelSearch& pixel, const Landing& from, HalfOfPixel& part, int number) {
    const DirectionSample drawn = sample_cones(pixel.cones, part.points.at(std::uint32_t(number)));
    if (!(drawn.pdf > 0)) return;
    ChangeTry t;
    t.from = &from;
    t.sums = &pixel.sums();
    t.key = pixel.key();
    t.key.sample = std::uint32_t(number);
    t.direction = drawn.direction;
    t.cone_density = pixel.by_cones * drawn.pdf;
    follow(part.half.rays, t, pixel.search.pass);
}

/// One half of the tries over the cones: whole numbers of them, whose sum over a pixel's rays is
/// rounded up or down at random to the right mean.
void try_cones(PixelSearch& pixel, const Landing& from, HalfOfPixel& part) {
    const float before = pixel.sums().cone_tries, after = before + 0.5f * pixel.by_cones;
    for (int number = int(before + part.rounding); number < int(after + part.rounding); ++number)
        try_cone(pixel, from, part, number);
}

/// The pixel's random numbers.
void begin(PixelSearch& pixel) {
    const Search& search = pixel.search;
    const int camera_rays = search.pass.settings.primary;
    for (HalfOfPixel* part : {&pixel.surfaces, &pixel.shadows}) {
        part->points = run_of(part->half.points, pixel.key().place,
                              (camera_rays * search.counts.cones + 1) / 2);
        part->rounding = uniform(pixel.key(), part->half.dimension);
    }
    pixel.run = light_run(search.pass, pixel.key(), change_by_light,
                          std::max(1, camera_rays * search.counts.light));
}

void search_pixel(PixelSearch& pixel) {
    const Search& search = pixel.search;
    const std::optional<Vicinity> common = common_vicinity(search, pixel.lane);
    bool looked = false, begun = false;
    for (std::size_t p = 0; p < search.camera_rays.size(); ++p) {
        const Landing& from = search.camera_rays[p][pixel.lane];
        if (!is_real(from)) continue;
        ++pixel.sums().camera_rays;
        if (!common)
            pixel.look_from(vicinity_of(from));
        else if (!std::exchange(looked, true))
            pixel.look_from(*common);
        if (pixel.cones.empty()) continue;
        if (!std::exchange(begun, true)) begin(pixel);
        try_lights(pixel, from, search.first_ray + int(p));
        try_cones(pixel, from, pixel.surfaces);
        if (search.counts.light > 0) try_cones(pixel, from, pixel.shadows);
        pixel.sums().cone_tries += 0.5f * pixel.by_cones;
    }
}

bool any_real(std::span<const Landings> camera_rays, std::size_t lane) {
    return std::any_of(camera_rays.begin(), camera_rays.end(),
                       [lane](const Landings& landings) { return is_real(landings[lane]); });
}

}  // namespace

ChangeCounts change_counts(const TwoModeScene& scene, const SamplingSettings& settings) {
    const bool lit = scene.environment.mean_luminance > 0;
    return {lit ? settings.light_tries * settings.secondary : 0, settings.secondary};
}

void add_changes(const TilePass& tile, std::span<const Landings> camera_rays, int first_ray) {
    Search search(tile, camera_rays, first_ray);
    for (std::size_t lane = 0; lane < packet_width; ++lane) {
        if (!any_real(camera_rays, lane)) continue;
        PixelSearch pixel{search, lane};
        search_pixel(pixel);
    }
    follow_rest(search.shadows.rays, search.pass);
    follow_rest(search.surfaces.rays, search.pass);
}

}  // namespace inlay
