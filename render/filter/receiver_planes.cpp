// Cleaning, matching between frames, and widths per pixel.
#include "render/filter/receiver_planes.h"

#include "recordings/base/parallel.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace inlay {
namespace {

constexpr float farthest = 1e9f;        // m; beyond it, squares leave single precision
constexpr float brightest = 1e30f;      // sums of a kernel's worth of this stay finite
constexpr double grazing_cosine = 0.1;  // pixels are not taken for longer than at this angle

bool within(const glm::vec3& v, float limit) {
    for (int i = 0; i < 3; ++i) {
        if (!std::isfinite(v[i]) || std::abs(v[i]) > limit) return false;
    }
    return true;
}

Receiver blank_receiver(int width, int height) {
    return {Image<std::uint32_t>(width, height, 0), Image<glm::vec3>(width, height, glm::vec3(0)),
            Image<glm::vec3>(width, height, glm::vec3(0)), Image<float>(width, height, 0.0f),
            Image<float>(width, height, 0.0f)};
}

/// The mean of the rates above 0 around a pixel on its own object; 0 without any.
float mean_known_rate(const Image<float>& rates, const Image<std::uint32_t>& object, glm::ivec2 at,
                      int reach) {
    float sum = 0, count = 0;
    for (int y = std::max(at.y - reach, 0); y <= std::min(at.y + reach, rates.height - 1); ++y) {
        for (int x = std::max(at.x - reach, 0); x <= std::min(at.x + reach, rates.width - 1); ++x) {
            if (rates(x, y) == 0 || object(x, y) != object(at.x, at.y)) continue;
            sum += rates(x, y);
            ++count;
        }
    }
    return count > 0 ? sum / count : 0.0f;
}

/// Everything that decides the width at one pixel along one axis but the curvature.
struct WidthLimits {
    double direct_rate, indirect_rate, glossy;
    double g, narrowest;  // sample factor; m
};

float precision_at(double curvature, const WidthLimits& at, const LightLimits& limits,
                   const FilterSettings& settings) {
    LocalFrequencies f{curvature, at.direct_rate, limits.environment_bandwidth, at.glossy};
    double inverse = 0;
    if (limits.light == LightKind::direct) inverse = inverse_width(f, LightKind::direct, settings);
    if (limits.light == LightKind::indirect || limits.glossy_bandwidth != nullptr) {
        f.occluder = at.indirect_rate;  // S_RV holds direct and indirect light
        inverse = std::max(inverse, inverse_width(f, LightKind::indirect, settings));
    }
    if (inverse == 0) return 0;
    const double sigma = std::max(at.g / inverse, at.narrowest);
    return float(std::pow(clamped_bandwidth(1 / std::max(sigma, 1e-30)), 2));
}

}  // namespace

std::shared_ptr<const SurfacePlanes> surface_planes(const Receiver& r) {
    auto planes = std::make_shared<SurfacePlanes>();
    const Image<float> blank(r.object.width, r.object.height, 0.0f);
    planes->position.fill(blank);
    planes->normal.fill(blank);
    parallel_rows(blank.height, [&](int y) {
        for (int x = 0; x < blank.width; ++x) {
            for (std::size_t i = 0; i < 3; ++i) {
                planes->position[i](x, y) = r.position(x, y)[int(i)];
                planes->normal[i](x, y) = r.normal(x, y)[int(i)];
            }
        }
    });
    return planes;
}

bool any_object(const Receiver& r) {
    return std::any_of(r.object.pixels.begin(), r.object.pixels.end(),
                       [](std::uint32_t object) { return object != 0; });
}

Receiver cleaned(const Receiver& receiver) {
    Receiver result = blank_receiver(receiver.object.width, receiver.object.height);
    parallel_rows(result.object.height, [&](int y) {
        for (int x = 0; x < result.object.width; ++x) {
            const glm::vec3 &p = receiver.position(x, y), &n = receiver.normal(x, y);
            if (receiver.object(x, y) == 0 || !within(p, farthest) || !within(n, farthest))
                continue;
            const double length = glm::length(glm::dvec3(n));
            if (length < 1e-6) continue;
            result.object(x, y) = receiver.object(x, y);
            result.position(x, y) = p;
            result.normal(x, y) = glm::vec3(glm::dvec3(n) / length);
            result.occluder_direct(x, y) =
                float(clamped_bandwidth(double(receiver.occluder_direct(x, y))));
            result.occluder_indirect(x, y) =
                float(clamped_bandwidth(double(receiver.occluder_indirect(x, y))));
        }
    });
    return result;
}

PreparedReceiver prepare(Receiver receiver, const Lens& lens, const Pose& world_from_camera) {
    PreparedReceiver result;
    result.receiver = std::move(receiver);
    result.empty = !any_object(result.receiver);
    if (result.empty) return result;
    result.footprint = pixel_footprint(result.receiver, lens, world_from_camera);
    result.curvature = screen_curvature(result.receiver, result.footprint);
    result.surface = surface_planes(result.receiver);
    return result;
}

Image<std::int32_t> matching_pixels(const PreparedReceiver& now, const Pose& world_from_camera,
                                    const NoisyLayers& previous, const Receiver& previous_receiver,
                                    const FilterSettings& settings) {
    const Receiver& r = now.receiver;
    const Pose camera_from_world = inverse(previous.world_from_camera);
    const double stop = std::cos(settings.normal_stop_deg * std::numbers::pi / 180);
    Image<std::int32_t> source(r.object.width, r.object.height, -1);
    parallel_rows(source.height, [&](int y) {
        for (int x = 0; x < source.width; ++x) {
            if (r.object(x, y) == 0) continue;
            const glm::dvec3 p(r.position(x, y)), n(r.normal(x, y));
            const glm::dvec3 p_camera = camera_from_world * p;
            if (p_camera.z < 1e-6) continue;
            const auto pixel = nearest_pixel(previous.lens, project(previous.lens, p_camera));
            if (!pixel || previous_receiver.object(pixel->x, pixel->y) != r.object(x, y)) continue;
            const std::size_t at = previous_receiver.object.index(pixel->x, pixel->y);
            if (glm::dot(n, glm::dvec3(previous_receiver.normal.pixels[at])) < stop) continue;
            const glm::dvec3 ray = p - world_from_camera.translation;
            const double cosine = std::abs(glm::dot(n, ray)) / std::max(glm::length(ray), 1e-12);
            const double reach = settings.rejection_distance * double(now.footprint(x, y)) /
                                 std::max(cosine, grazing_cosine);
            if (glm::distance(p, glm::dvec3(previous_receiver.position.pixels[at])) <= reach)
                source(x, y) = std::int32_t(at);
        }
    });
    return source;
}

PreparedReceiver resampled(const PreparedReceiver& now, const Receiver& previous,
                           const Image<std::int32_t>& source) {
    PreparedReceiver result;
    result.footprint = now.footprint;
    result.curvature = now.curvature;
    result.receiver = blank_receiver(source.width, source.height);
    parallel_rows(source.height, [&](int y) {
        for (int x = 0; x < source.width; ++x) {
            if (source(x, y) < 0) continue;
            const auto from = std::size_t(source(x, y));
            Receiver& to = result.receiver;
            to.object(x, y) = previous.object.pixels[from];
            to.position(x, y) = previous.position.pixels[from];
            to.normal(x, y) = previous.normal.pixels[from];
            to.occluder_direct(x, y) = previous.occluder_direct.pixels[from];
            to.occluder_indirect(x, y) = previous.occluder_indirect.pixels[from];
        }
    });
    result.surface = surface_planes(result.receiver);
    result.empty = !any_object(result.receiver);
    return result;
}

FilterPlanes planes_of(const PreparedReceiver& receiver, std::span<const Image<Rgb>* const> images,
                       const Image<std::int32_t>* source) {
    FilterPlanes planes;
    planes.surface = receiver.surface;
    planes.object = receiver.receiver.object;
    const Image<float> blank(planes.object.width, planes.object.height, 0.0f);
    planes.channels.assign(3 * images.size(), blank);
    parallel_rows(blank.height, [&](int y) {
        for (std::size_t i = blank.index(0, y); i < blank.index(0, y) + std::size_t(blank.width);
             ++i) {
            const std::size_t from =
                source == nullptr ? i : std::size_t(std::max(source->pixels[i], 0));
            for (const Image<Rgb>* image : images) {
                if (planes.object.pixels[i] != 0 && !within(image->pixels[from], brightest))
                    planes.object.pixels[i] = 0;
            }
            if (planes.object.pixels[i] == 0) continue;
            for (std::size_t c = 0; c < planes.channels.size(); ++c)
                planes.channels[c].pixels[i] = images[c / 3]->pixels[from][int(c % 3)];
        }
    });
    return planes;
}

Image<float> filled_rates(const Image<float>& rates, const Image<std::uint32_t>& object,
                          int reach) {
    Image<float> result = rates;
    parallel_rows(rates.height, [&](int y) {
        for (int x = 0; x < rates.width; ++x) {
            if (object(x, y) != 0 && rates(x, y) == 0)
                result(x, y) = mean_known_rate(rates, object, {x, y}, reach);
        }
    });
    return result;
}

void set_precision(FilterPlanes& planes, const PreparedReceiver& receiver,
                   const LightLimits& limits, const FilterSettings& settings) {
    const Receiver& r = receiver.receiver;
    const double g = sample_factor(limits.samples, settings);
    planes.precision_x = Image<float>(r.object.width, r.object.height, 0.0f);
    planes.precision_y = planes.precision_x;
    parallel_rows(r.object.height, [&](int y) {
        for (int x = 0; x < r.object.width; ++x) {
            if (planes.object(x, y) == 0) continue;
            const double glossy = limits.glossy_bandwidth == nullptr
                                      ? 0.0
                                      : clamped_bandwidth(double((*limits.glossy_bandwidth)(x, y)));
            const WidthLimits at{double(r.occluder_direct(x, y)), double(r.occluder_indirect(x, y)),
                                 glossy, g, limits.narrowest * double(receiver.footprint(x, y))};
            const double turning = limits.ignore_curvature ? 0.0 : 1.0;
            planes.precision_x(x, y) =
                precision_at(turning * double(receiver.curvature.x(x, y)), at, limits, settings);
            planes.precision_y(x, y) =
                precision_at(turning * double(receiver.curvature.y(x, y)), at, limits, settings);
        }
    });
}

}  // namespace inlay
