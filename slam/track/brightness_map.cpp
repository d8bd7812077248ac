#include "slam/track/brightness_map.h"

#include "recordings/base/parallel.h"
#include "slam/depth/camera_view.h"

#include <array>
#include <cmath>
#include <utility>

namespace inlay {
namespace {

constexpr std::array<float, 3> binomial{0.25f, 0.5f, 0.25f};

Image<float> luminance_of(const Image<EncodedRgb>& photograph) {
    Image<float> result(photograph.width, photograph.height);
    parallel_rows(result.height, [&](int y) {
        for (int x = 0; x < result.width; ++x)
            result(x, y) = luminance(decode(photograph(x, y)));
    });
    return result;
}

/// The mean of each 2 x 2 block; 0 where one of its pixels is not known.
Image<float> halve(const Image<float>& fine) {
    Image<float> coarse(fine.width / 2, fine.height / 2);
    parallel_rows(coarse.height, [&](int y) {
        for (int x = 0; x < coarse.width; ++x) {
            const float a = fine(2 * x, 2 * y), b = fine(2 * x + 1, 2 * y);
            const float c = fine(2 * x, 2 * y + 1), d = fine(2 * x + 1, 2 * y + 1);
            const bool known = a > 0 && b > 0 && c > 0 && d > 0;
            coarse(x, y) = known ? (a + b + c + d) / 4 : 0.0f;
        }
    });
    return coarse;
}

/// The mean luminance around a pixel; 0 at the border and where one around it is not known.
float smoothed(const Image<float>& luminance, int x, int y) {
    if (!luminance.contains(x - 1, y - 1) || !luminance.contains(x + 1, y + 1)) return 0;
    float sum = 0;
    for (int v = 0; v < 3; ++v) {
        for (int u = 0; u < 3; ++u) {
            const float here = luminance(x + u - 1, y + v - 1);
            if (!(here > 0)) return 0;
            sum += binomial[std::size_t(u)] * binomial[std::size_t(v)] * here;
        }
    }
    return sum;
}

/// The slope by central differences of the values and of the rays, so that it heeds the lens's
/// distortion; 0 at the border and where a value is not known.
glm::vec2 slope_at(const BrightnessMap& map, const Image<glm::vec3>& rays, int x, int y) {
    if (!map.pixels.contains(x - 1, y - 1) || !map.pixels.contains(x + 1, y + 1))
        return glm::vec2(0);
    const auto value = [&](int u, int v) { return map.pixels(u, v).value; };
    const float left = value(x - 1, y), right = value(x + 1, y);
    const float above = value(x, y - 1), below = value(x, y + 1);
    if (!(left > 0 && right > 0 && above > 0 && below > 0)) return glm::vec2(0);
    const glm::vec3 across = rays(x + 1, y) - rays(x - 1, y);
    const glm::vec3 down = rays(x, y + 1) - rays(x, y - 1);
    const glm::mat2 differences{glm::vec2(across.x, down.x), glm::vec2(across.y, down.y)};
    return glm::inverse(differences) * glm::vec2(right - left, below - above);
}

BrightnessMap map_of(const Image<float>& luminance, const Lens& lens) {
    BrightnessMap map{lens, Image<Brightness>(lens.width, lens.height)};
    parallel_rows(lens.height, [&](int y) {
        for (int x = 0; x < lens.width; ++x)
            map.pixels(x, y).value = std::sqrt(smoothed(luminance, x, y));
    });
    const CameraView view = camera_view(lens);
    parallel_rows(lens.height, [&](int y) {
        for (int x = 0; x < lens.width; ++x)
            map.pixels(x, y).slope = slope_at(map, *view.rays, x, y);
    });
    return map;
}

}  // namespace

std::vector<BrightnessMap> brightness_pyramid(const Image<EncodedRgb>& photograph,
                                              std::span<const Lens> lenses) {
    std::vector<BrightnessMap> pyramid;
    Image<float> level = luminance_of(photograph);
    for (const Lens& lens : lenses) {
        while (level.width > lens.width)
            level = halve(level);
        if (level.width != lens.width || level.height != lens.height)
            level = Image<float>(lens.width, lens.height, 0.0f);
        pyramid.push_back(map_of(level, lens));
    }
    return pyramid;
}

Brightness brightness_at(const BrightnessMap& map, const glm::vec2& position) {
    const int x = int(std::floor(position.x)), y = int(std::floor(position.y));
    if (!map.pixels.contains(x, y) || !map.pixels.contains(x + 1, y + 1)) return {};
    const glm::vec2 f = position - glm::vec2(float(x), float(y));
    Brightness sum;
    for (int corner = 0; corner < 4; ++corner) {
        const int u = corner & 1, v = corner >> 1;
        const Brightness& here = map.pixels(x + u, y + v);
        if (!(here.value > 0)) return {};
        const float share = (u == 1 ? f.x : 1 - f.x) * (v == 1 ? f.y : 1 - f.y);
        sum.value += share * here.value;
        sum.slope += share * here.slope;
    }
    return sum;
}

}  // namespace inlay
