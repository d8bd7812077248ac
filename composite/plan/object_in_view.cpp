#include "composite/plan/object_in_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace inlay {
namespace {

// The tracer places objects in single precision, and a transform may shear by 1e-3.
constexpr double margin = 2e-3;
constexpr double window_margin = 1e-6;  // of x / z: rays are made in single precision too

using Corners = std::array<glm::dvec3, 8>;

struct Rectangle {
    glm::dvec2 least, greatest;
};

Rectangle everything() {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    return {glm::dvec2(-infinity), glm::dvec2(infinity)};
}

Rectangle common(const Rectangle& a, const Rectangle& b) {
    return {glm::max(a.least, b.least), glm::min(a.greatest, b.greatest)};
}

double area(const Rectangle& r) {
    const glm::dvec2 size = glm::max(r.greatest - r.least, glm::dvec2(0));
    return size.x * size.y;
}

Corners corners_of(const ObjectBounds& bounds, const glm::dmat4& camera_from_object) {
    const glm::dvec3 half = (1 + margin) * 0.5 * (bounds.greatest - bounds.least);
    Corners corners;
    for (int i = 0; i < 8; ++i) {
        const glm::dvec3 sign(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
        corners[std::size_t(i)] =
            glm::dvec3(camera_from_object * glm::dvec4(bounds.middle() + sign * half, 1));
    }
    return corners;
}

/// Whether a plane through the camera leaves the whole object on the side that is not seen.
bool outside(const Corners& corners, const Ball& ball, const ViewWindow& w) {
    const std::array<glm::dvec3, 5> inward{
        glm::dvec3(1, 0, -w.least.x), glm::dvec3(-1, 0, w.greatest.x), glm::dvec3(0, 1, -w.least.y),
        glm::dvec3(0, -1, w.greatest.y), glm::dvec3(0, 0, 1)};
    return std::any_of(inward.begin(), inward.end(), [&](const glm::dvec3& n) {
        const double slack = 1e-6 * glm::length(ball.centre) * glm::length(n);
        return glm::dot(n, ball.centre) < -ball.radius * glm::length(n) ||
               std::all_of(corners.begin(), corners.end(),
                           [&](const glm::dvec3& p) { return glm::dot(n, p) < -slack; });
    });
}

/// Of the points' images; everything where one does not lie in front of the camera.
Rectangle image_of(const Corners& corners) {
    Rectangle r{glm::dvec2(std::numeric_limits<double>::infinity()),
                glm::dvec2(-std::numeric_limits<double>::infinity())};
    for (const glm::dvec3& p : corners) {
        if (!(p.z > 1e-9)) return everything();
        const glm::dvec2 at = glm::dvec2(p) / p.z;
        r = {glm::min(r.least, at), glm::max(r.greatest, at)};
    }
    return r;
}

/// Of a ball's image, exact: along each axis the two rays that touch its circle.
Rectangle image_of(const Ball& ball) {
    Rectangle r = everything();
    for (int axis = 0; axis < 2; ++axis) {
        const double across = ball.centre[axis], along = ball.centre.z;
        const double distance = std::hypot(across, along);
        if (distance <= ball.radius) continue;
        const double middle = std::atan2(across, along);
        const double half = std::asin(ball.radius / distance);
        const double quarter = std::numbers::pi / 2;
        if (middle - half > -quarter) r.least[axis] = std::tan(std::min(middle - half, quarter));
        if (middle + half < quarter) r.greatest[axis] = std::tan(std::max(middle + half, -quarter));
    }
    return r;
}

}  // namespace

Ball ball_of(const ObjectBounds& bounds, const glm::dmat4& camera_from_object) {
    const glm::dmat3 linear(camera_from_object);
    const double scale =
        std::max({glm::length(linear[0]), glm::length(linear[1]), glm::length(linear[2])});
    const glm::dvec3 centre(camera_from_object * glm::dvec4(bounds.middle(), 1));
    // Far from the origin, single precision moves a point by its share of the distance.
    return {centre, (1 + margin) * scale * bounds.radius + 1e-6 * glm::length(centre)};
}

ViewWindow view_window(const Lens& lens) {
    ViewWindow window{glm::dvec2(std::numeric_limits<double>::infinity()),
                      glm::dvec2(-std::numeric_limits<double>::infinity()),
                      {std::abs(lens.fx), std::abs(lens.fy)}};
    bool finite = true;
    const auto include = [&](double x, double y) {
        const glm::dvec2 at(unproject(lens, {x, y}));
        finite = finite && std::isfinite(at.x + at.y);
        window.least = glm::min(window.least, at);
        window.greatest = glm::max(window.greatest, at);
    };
    const double right = lens.width - 0.5, bottom = lens.height - 0.5;
    for (int x = 0; x <= lens.width; ++x)
        include(x - 0.5, -0.5), include(x - 0.5, bottom);
    for (int y = 0; y <= lens.height; ++y)
        include(-0.5, y - 0.5), include(right, y - 0.5);
    const double reach =
        finite ? window_margin * (1 + glm::length(window.least) + glm::length(window.greatest))
               : std::numeric_limits<double>::infinity();
    window.least -= reach;
    window.greatest += reach;
    return window;
}

ObjectInView object_in_view(const ObjectBounds& bounds, const glm::dmat4& camera_from_object,
                            const ViewWindow& window) {
    if (bounds.empty()) return {};
    const Corners corners = corners_of(bounds, camera_from_object);
    const Ball ball = ball_of(bounds, camera_from_object);
    if (outside(corners, ball, window)) return {};
    const Rectangle whole = common(image_of(corners), image_of(ball));
    const Rectangle view{window.least, window.greatest};
    const glm::dvec2 rim = rim_px / window.pixels_per_unit;
    const Rectangle rimmed{whole.least - rim, whole.greatest + rim};
    ObjectInView seen;
    seen.possible = !(area(common(rimmed, view)) <= 0);  // a window without bounds sees all
    seen.size_px = glm::max(whole.greatest - whole.least, glm::dvec2(0)) * window.pixels_per_unit;
    seen.share_of_view = std::min(1.0, area(common(whole, view)) / area(view));
    seen.share_with_rim = std::min(1.0, area(common(rimmed, view)) / area(view));
    return seen;
}

}  // namespace inlay
