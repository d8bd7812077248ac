#include "slam/depth/smooth_normals.h"

#include "recordings/base/random.h"

#include <gtest/gtest.h>

#include <cmath>

namespace inlay {
namespace {

const Lens lens{40, 30, 50, 50, 19.5, 14.5};

/// A plane that faces the camera, with normals tilted at random by about 0.2 rad.
SurfaceMap noisy_wall(float confidence) {
    SurfaceMap wall = empty_surface_map(lens, {});
    for (int y = 0; y < lens.height; ++y) {
        for (int x = 0; x < lens.width; ++x) {
            const SampleKey key{1, 0, std::uint32_t(y * lens.width + x), 0};
            wall.position(x, y) = glm::vec3(unproject(lens, {x, y}));
            wall.normal(x, y) =
                glm::normalize(glm::vec3(uniform(key, 0) - 0.5f, uniform(key, 1) - 0.5f, -1.0f));
            wall.confidence(x, y) = confidence;
        }
    }
    return wall;
}

double rms_angle(const Image<glm::vec3>& normals) {
    double sum = 0;
    for (const glm::vec3& n : normals.pixels)
        sum += std::pow(std::acos(std::min(1.0f, -n.z)), 2);
    return std::sqrt(sum / double(normals.pixels.size()));
}

TEST(SmoothNormals, NoiseOfAFirstViewFallsWithTheWindow) {
    const SurfaceMap wall = noisy_wall(0);
    // 49 independent normals: a seventh of the spread; at the border the window has 16 of them.
    EXPECT_LT(rms_angle(smooth_normals(wall)), rms_angle(wall.normal) / 4);
}

TEST(SmoothNormals, FullConfidenceKeepsEveryNormal) {
    const SurfaceMap wall = noisy_wall(1);
    EXPECT_EQ(smooth_normals(wall).pixels, wall.normal.pixels);
}

TEST(SmoothNormals, StepsCreasesAndHolesDoNotMix) {
    SurfaceMap scene = noisy_wall(0);
    const glm::vec3 ahead(0, 0, -1), aside(-1, 0, 0);
    for (int y = 0; y < lens.height; ++y) {
        for (int x = 0; x < lens.width; ++x) {
            scene.normal(x, y) = x < 20 ? ahead : aside;       // a crease in the middle
            if (y >= 20) scene.position(x, y) *= 2.0f;         // a step below it
            if (y >= 25) scene.position(x, y) = glm::vec3(0);  // holes below that
            if (y >= 20 && y < 25) scene.normal(x, y) = glm::vec3(0, 0.6f, -0.8f);
        }
    }
    const Image<glm::vec3> smooth = smooth_normals(scene);
    EXPECT_LT(glm::length(smooth(19, 10) - ahead), 1e-6f);  // rounding
    EXPECT_LT(glm::length(smooth(20, 10) - aside), 1e-6f);
    EXPECT_LT(glm::length(smooth(10, 19) - ahead), 1e-6f);
    EXPECT_EQ(smooth(10, 27), scene.normal(10, 27));
}

}  // namespace
}  // namespace inlay
