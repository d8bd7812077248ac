#include "render/scene/place_object.h"

#include "recordings/base/check.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>

namespace inlay {

namespace {

constexpr int search_radius = 5;        // px
constexpr double window_radius = 0.08;  // m, about the placed pixel
constexpr int min_window = 4;           // px
constexpr int max_window = 32;          // px
constexpr int fit_rounds = 8;
constexpr double least_residual = 1e-3;  // m, noise that any depth camera has

struct Plane {
    glm::dvec3 point;   // m
    glm::dvec3 normal;  // unit
};

/// The measured pixel nearest to `pixel`, the first in reading order of equals.
std::optional<glm::ivec2> nearest_surface(const SurfaceMap& surface, const glm::ivec2& pixel) {
    std::optional<glm::ivec2> nearest;
    int least = search_radius * search_radius + 1;
    for (int dy = -search_radius; dy <= search_radius; ++dy) {
        for (int dx = -search_radius; dx <= search_radius; ++dx) {
            const glm::ivec2 p = pixel + glm::ivec2(dx, dy);
            if (!surface.position.contains(p.x, p.y) || !surface.has_surface(p.x, p.y)) continue;
            if (dx * dx + dy * dy >= least) continue;
            least = dx * dx + dy * dy;
            nearest = p;
        }
    }
    return nearest;
}

std::vector<glm::dvec3> points_around(const SurfaceMap& surface, const glm::ivec2& centre,
                                      int radius) {
    std::vector<glm::dvec3> points;
    for (int y = centre.y - radius; y <= centre.y + radius; ++y)
        for (int x = centre.x - radius; x <= centre.x + radius; ++x)
            if (surface.position.contains(x, y) && surface.has_surface(x, y))
                points.emplace_back(surface.position(x, y));
    return points;
}

double median(std::vector<double> values) {
    const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// Least squares plane of weighted points: through their mean, along the least eigenvector of their
/// covariance.
Plane weighted_plane(const std::vector<glm::dvec3>& points, const std::vector<double>& weights) {
    double total = 0;
    glm::dvec3 mean{0};
    for (std::size_t i = 0; i < points.size(); ++i) {
        total += weights[i];
        mean += weights[i] * points[i];
    }
    mean /= total;
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    for (std::size_t i = 0; i < points.size(); ++i) {
        const glm::dvec3 d = points[i] - mean;
        const Eigen::Vector3d e(d.x, d.y, d.z);
        covariance += weights[i] * e * e.transpose();
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
    const Eigen::Vector3d n = solver.eigenvectors().col(0);
    return {mean, {n.x(), n.y(), n.z()}};
}

/// Iteratively reweighted fit (Tukey's biweight on the median residual) from a first guess.
Plane robust_plane(const std::vector<glm::dvec3>& points, Plane plane) {
    if (points.size() < 12) return plane;
    for (int round = 0; round < fit_rounds; ++round) {
        std::vector<double> residuals;
        for (const glm::dvec3& p : points)
            residuals.push_back(std::abs(glm::dot(p - plane.point, plane.normal)));
        const double cut = 4.685 * std::max(1.4826 * median(residuals), least_residual);
        std::vector<double> weights;
        int used = 0;
        for (const double r : residuals) {
            const double t = r / cut;
            weights.push_back(t < 1 ? (1 - t * t) * (1 - t * t) : 0.0);
            used += t < 1;
        }
        if (used < 12) return plane;
        plane = weighted_plane(points, weights);
    }
    return plane;
}

/// The plane of the surface around a measured pixel, camera frame, its normal towards the camera.
Plane plane_at(const SurfaceMap& surface, const glm::ivec2& pixel) {
    const glm::dvec3 centre(surface.position(pixel.x, pixel.y));
    const int radius =
        std::clamp(int(std::lround(std::abs(surface.lens.fx) * window_radius / centre.z)),
                   min_window, max_window);
    glm::dvec3 normal(surface.normal(pixel.x, pixel.y));
    if (!(glm::length(normal) > 0.5)) normal = -glm::normalize(centre);
    Plane plane =
        robust_plane(points_around(surface, pixel, radius), {centre, glm::normalize(normal)});
    if (glm::dot(plane.normal, centre) > 0) plane.normal = -plane.normal;
    return plane;
}

/// Where the ray through a pixel meets the plane, camera frame; `measured` where the plane is seen
/// edge-on or is not the surface there.
glm::dvec3 base_point(const SurfaceMap& surface, const glm::ivec2& pixel, const Plane& plane,
                      const glm::dvec3& measured) {
    const glm::dvec3 ray = unproject(surface.lens, pixel);
    const double cosine = glm::dot(plane.normal, glm::normalize(ray));
    if (std::abs(cosine) < 0.03) return measured;
    const glm::dvec3 p = ray * (glm::dot(plane.normal, plane.point) / glm::dot(plane.normal, ray));
    return glm::length(p - measured) < 2 * window_radius ? p : measured;
}

/// Columns x, y = up, z = the part of `facing` across up (or of `fallback`), turned about up.
glm::dmat3 standing_axes(const glm::dvec3& up, const glm::dvec3& facing, const glm::dvec3& fallback,
                         double turn_deg) {
    const auto across = [&](const glm::dvec3& v) { return v - glm::dot(v, up) * up; };
    glm::dvec3 z = across(facing);
    if (glm::length(z) < 1e-3 * glm::length(facing)) z = across(fallback);
    z = glm::normalize(z);
    const glm::dvec3 x = glm::cross(up, z);
    const double angle = turn_deg * std::numbers::pi / 180;
    return {std::cos(angle) * x - std::sin(angle) * z, up,
            std::sin(angle) * x + std::cos(angle) * z};
}

std::string pixel_text(const Placement& p) {
    return "pixel (" + std::to_string(p.pixel.x) + ", " + std::to_string(p.pixel.y) +
           ") of frame " + std::to_string(p.frame);
}

}  // namespace

glm::dmat4 place_on_surface(const Placement& placement, const SurfaceMap& surface,
                            const glm::dvec3& up_world, const std::string& name) {
    require(surface.position.contains(placement.pixel.x, placement.pixel.y),
            "object \"" + name + "\": place: " + pixel_text(placement) +
                " lies outside the image, " + std::to_string(surface.lens.width) + " x " +
                std::to_string(surface.lens.height) + " px");
    const auto measured_pixel = nearest_surface(surface, placement.pixel);
    require(measured_pixel.has_value(),
            "object \"" + name + "\": place: no measured surface within " +
                std::to_string(search_radius) + " px of " + pixel_text(placement) +
                "; choose a pixel where depth was measured");
    const Plane plane = plane_at(surface, *measured_pixel);
    const glm::dvec3 measured(surface.position(measured_pixel->x, measured_pixel->y));
    const Pose& world_from_camera = surface.world_from_camera;
    const glm::dvec3 base =
        world_from_camera * base_point(surface, placement.pixel, plane, measured);
    const glm::dvec3 up = placement.align_normal
                              ? glm::normalize(world_from_camera.rotation * plane.normal)
                              : glm::normalize(up_world);
    glm::dmat4 world_from_base(standing_axes(up, world_from_camera.translation - base,
                                             world_from_camera.rotation[1], placement.turn_deg));
    world_from_base[3] = glm::dvec4(base, 1);
    return world_from_base;
}

VirtualScene resolve_placements(const SceneFile& scene,
                                const std::function<SurfaceMap(int frame)>& surface_of_frame,
                                const glm::dvec3& up_world) {
    VirtualScene result;
    std::map<int, SurfaceMap> surfaces;
    for (const SceneEntry& entry : scene.entries) {
        SceneObject object = entry.object;
        if (entry.placement) {
            const int frame = entry.placement->frame;
            if (!surfaces.contains(frame)) surfaces.emplace(frame, surface_of_frame(frame));
            const glm::dmat4 world_from_base =
                place_on_surface(*entry.placement, surfaces.at(frame), up_world, object.name);
            for (MotionKey& key : object.motion)
                key.world_from_object = world_from_base * key.world_from_object;
        }
        result.objects.push_back(std::move(object));
    }
    return result;
}

}  // namespace inlay
