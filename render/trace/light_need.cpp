#include "render/trace/light_need.h"

#include "recordings/base/parallel.h"

#include <algorithm>
#include <numbers>

namespace inlay {
namespace {

/// Shares of an open surface's irradiance above which a change is seen plainly, and at all.
constexpr float plain_change = 0.06f, slight_change = 0.003f;

/// Neighbors, of 8, that a filter could mix a pixel with: they turn away by less than its default
/// stop, 10 degrees, and lie in the pixel's plane, within a share of their distance from the
/// camera.
int neighbors_alike(const Receiver& real, const glm::vec3& camera, int x, int y) {
    constexpr float alike_cosine = 0.985f, alike_gap = 0.005f;
    const glm::vec3 &position = real.position(x, y), &normal = real.normal(x, y);
    const float gap = alike_gap * glm::distance(position, camera);
    int alike = 0;
    for (int v = std::max(0, y - 1); v <= std::min(real.object.height - 1, y + 1); ++v) {
        for (int u = std::max(0, x - 1); u <= std::min(real.object.width - 1, x + 1); ++u) {
            if ((u == x && v == y) || real.object(u, v) == 0) continue;
            alike += glm::dot(real.normal(u, v), normal) > alike_cosine &&
                     std::abs(glm::dot(real.position(u, v) - position, normal)) < gap;
        }
    }
    return alike;
}

/// The need of a pixel that has to rely on its own samples, since it has few neighbors to mix with:
/// a single sample is often 0, and a ratio to that is not light. The side of a straight edge has 5.
LightNeed need_alone(int alike) {
    if (alike < 2) return LightNeed::plain;
    return alike < 5 ? LightNeed::slight : LightNeed::hardly;
}

}  // namespace

LightNeed light_need(float hidden, const Rgb& change, float mean_luminance) {
    const float open = std::numbers::pi_v<float> * mean_luminance;
    const float seen = hidden + (open > 0 ? luminance(glm::abs(change)) / open : 0.0f);
    if (seen > plain_change) return LightNeed::plain;
    return seen > slight_change ? LightNeed::slight : LightNeed::hardly;
}

Image<LightNeed> light_needs(const NoisyLayers& layers, float mean_luminance) {
    const glm::vec3 camera(layers.world_from_camera.translation);
    Image<LightNeed> needs(layers.m.width, layers.m.height, LightNeed::hardly);
    parallel_rows(needs.height, [&](int y) {
        for (int x = 0; x < needs.width; ++x) {
            if (layers.real.object(x, y) == 0) continue;
            const LightNeed by_change = light_need(layers.change_rates.share(x, y),
                                                   layers.direct.e_rv_real(x, y), mean_luminance);
            needs(x, y) =
                std::max(by_change, need_alone(neighbors_alike(layers.real, camera, x, y)));
        }
    });
    return needs;
}

int samples_for(LightNeed need, int most) {
    constexpr int shares[light_need_count] = {16, 4, 1};
    return std::max(1, most / shares[std::size_t(need)]);
}

}  // namespace inlay
