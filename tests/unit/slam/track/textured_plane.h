// A plane with a smooth random texture, seen from cameras that move along it and turn about its
// normal: depth alone does not tell how.
#pragma once

#include "recordings/base/lens.h"
#include "recordings/base/random.h"
#include "recordings/base/rgbd_frame.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace inlay::test {

constexpr double plane_distance = 1.0;  // m, along z of the world

/// What differs from the perfect frame.
struct PlaneFaults {
    float depth_noise = 0;  // m, standard deviation
    float color_noise = 0;  // of 255, standard deviation
    float exposure = 1;     // factor on the linear color
    float contrast = 0.5f;  // of the texture; 0: a uniform wall
};

inline Lens plane_lens() { return {320, 240, 262, 262, 159.5, 119.5}; }

/// Nearly Gaussian with variance 1: four uniform numbers.
inline float bell(const SampleKey& key, std::uint32_t first) {
    float sum = -2;
    for (std::uint32_t i = 0; i < 4; ++i)
        sum += uniform(key, first + i);
    return 1.732f * sum;
}

/// Linear color (0..1) at a point (m) of the plane: waves of 4 to 25 cm in all directions.
inline Rgb texture(double x, double y, float contrast) {
    Rgb sum(0);
    for (std::uint32_t i = 0; i < 12; ++i) {
        const SampleKey key{11, 0, i, 0};
        const double angle = 2 * std::numbers::pi * double(uniform(key, 0));
        const double wave = 0.04 * std::pow(6.0, double(uniform(key, 1)));  // m
        const double along = (x * std::cos(angle) + y * std::sin(angle)) / wave;
        for (int c = 0; c < 3; ++c) {
            const double phase = double(uniform(key, 2 + std::uint32_t(c / 2)));
            sum[c] += float(std::sin(2 * std::numbers::pi * (along + phase)));
        }
    }
    return Rgb(0.25f) + contrast * 0.08f * sum;
}

/// World from camera of frame i: 5 mm along x and 0.3 degrees about the line of sight per frame.
inline Pose plane_pose(int i) {
    const double angle = i * 0.3 * std::numbers::pi / 180;
    return {glm::mat3_cast(glm::angleAxis(angle, glm::dvec3(0, 0, 1))), {0.005 * i, 0, 0}};
}

/// One pixel's byte of a linear color with noise.
inline std::uint8_t noisy(std::uint8_t byte, float noise) {
    return std::uint8_t(std::lround(std::clamp(float(byte) + noise, 0.0f, 255.0f)));
}

inline RgbdFrame plane_frame(int index, const Pose& world_from_camera, const PlaneFaults& faults,
                             const Lens& lens = plane_lens()) {
    RgbdFrame frame{index, index / 30.0, lens, {}, {}, {}};
    frame.color = Image<EncodedRgb>(lens.width, lens.height);
    frame.depth = Image<float>(lens.width, lens.height);
    for (int y = 0; y < lens.height; ++y) {
        for (int x = 0; x < lens.width; ++x) {
            const glm::dvec3 ray = world_from_camera.rotation * unproject(lens, {x, y});
            const double z = (plane_distance - world_from_camera.translation.z) / ray.z;
            const glm::dvec3 p = world_from_camera.translation + z * ray;
            const SampleKey key{5, std::uint32_t(index), std::uint32_t(y * lens.width + x), 0};
            frame.depth(x, y) = float(z) + faults.depth_noise * bell(key, 0);
            const EncodedRgb c = encode(faults.exposure * texture(p.x, p.y, faults.contrast));
            const float noise = faults.color_noise;
            frame.color(x, y) = {noisy(c.r, noise * bell(key, 4)), noisy(c.g, noise * bell(key, 8)),
                                 noisy(c.b, noise * bell(key, 12))};
        }
    }
    return frame;
}

}  // namespace inlay::test
