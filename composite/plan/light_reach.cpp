#include "composite/plan/light_reach.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace inlay {
namespace {

bool finite(const ViewWindow& w) {
    return std::isfinite(w.least.x + w.least.y) && std::isfinite(w.greatest.x + w.greatest.y);
}

/// The point of the frustum's slice at depth z that is nearest to `point`.
glm::dvec3 nearest_in_slice(const ViewWindow& w, double z, const glm::dvec3& point) {
    return {glm::clamp(glm::dvec2(point), z * w.least, z * w.greatest), z};
}

}  // namespace

LightRange light_range(const EnvironmentMap& environment) {
    const Image<Rgb>& radiance = environment.radiance;
    glm::dvec3 sum(0);
    LightRange range;
    for (int y = 0; y < radiance.height; ++y) {
        const double solid_angle = texel_solid_angle(radiance, y);
        for (const Rgb& c : radiance.row(y)) {
            sum += solid_angle * glm::dvec3(c);
            range.brightest = glm::max(range.brightest, c);
        }
    }
    range.mean = Rgb(sum / (4 * std::numbers::pi));
    return range;
}

double contrast(const LightRange& environment, const Rgb& exposure) {
    double most = 1;
    for (int c = 0; c < 3; ++c) {
        const double white = 1 / double(exposure[c]);
        const double brightest = std::max({double(environment.brightest[c]), white, 1.0});
        const double mean = std::min({double(environment.mean[c]), white, 1.0});
        if (!(mean > 0)) return std::numeric_limits<double>::infinity();
        most = std::max(most, brightest / mean);
    }
    return most;
}

double distance_to(const SeenSpace& seen, const glm::dvec3& point) {
    const ViewWindow& w = seen.window;
    if (!finite(w) || !std::isfinite(point.x + point.y + point.z)) return 0;
    // The squared distance to the slice at z is convex and made of parabolas: one for each choice
    // of a left, a right or no side that is nearest, and as many up and down. Its least value is
    // that of one of them, or lies at an end.
    double least = std::numeric_limits<double>::infinity();
    for (const double x : {0.0, w.least.x, w.greatest.x}) {
        for (const double y : {0.0, w.least.y, w.greatest.y}) {
            const double z = (x * point.x + y * point.y + point.z) / (x * x + y * y + 1);
            const glm::dvec3 nearest =
                nearest_in_slice(w, std::clamp(z, 0.0, seen.farthest), point);
            least = std::min(least, glm::distance(point, nearest));
        }
    }
    return least;
}

double hidden_share(const Ball& ball, const SeenSpace& seen) {
    const double distance = distance_to(seen, ball.centre) - seen.offset;
    if (!(distance > ball.radius)) return 1;
    const double sine = ball.radius / distance;
    return sine * sine;
}

double light_change(const Ball& ball, const SeenSpace& seen, double contrast) {
    const double share = hidden_share(ball, seen);
    return share > 0 ? share * contrast : 0;
}

}  // namespace inlay
