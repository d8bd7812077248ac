// ImageRay: the part of a ray that may meet a surface map, as a line in the image along which 1/z
// is linear too.
#pragma once

#include "render/trace/depth_pyramid.h"

#include <glm/glm.hpp>

#include <optional>

namespace inlay {

/// A ray in camera coordinates.
struct CameraRay {
    glm::dvec3 origin;     // m
    glm::dvec3 direction;  // unit
    double t_min = 0;      // m
};

/// All along s in 0..1.
struct ImageRay {
    glm::dvec2 start, step;                        // px: the image position is start + s step
    double inverse_depth, inverse_depth_step;      // 1/m: 1/z is linear in s
    double distance_over_z, distance_over_z_step;  // t/z too, of the distance t along the ray
    bool from_origin;  // s = 0 is the ray's own start, not a point where it was clipped

    glm::dvec2 position(double s) const { return start + s * step; }
    double inverse_z(double s) const { return inverse_depth + s * inverse_depth_step; }
    double distance(double s) const {
        return (distance_over_z + s * distance_over_z_step) / inverse_z(s);
    }
};

struct ClippedRay {
    std::optional<ImageRay> seen;  // empty: nowhere in the image within the map's depths
    bool leaves_image;             // or goes behind the camera; else it stays in it for ever
};

/// Clips against the image's edges and the depths that the map holds at all, so that z stays
/// positive and the line finite; exact for rays along the line of sight and parallel to the image.
ClippedRay clip_to_image(const CameraRay& ray, const Lens& lens, const InverseDepthRange& depths);

/// Where in s0..s1, within the pixel, the ray first lies in the pixel's slab. Exact: ray, front and
/// back are linear in s.
inline std::optional<double> meet(const ImageRay& ray, const PixelFacet& facet,
                                  const glm::ivec2& pixel, double s0, double s1) {
    if (facet.inverse_depth == 0) return std::nullopt;
    const auto front = [&](double s) {
        const glm::dvec2 from_centre = ray.position(s) - glm::dvec2(pixel);
        return double(facet.inverse_depth) + double(facet.per_x) * from_centre.x +
               double(facet.per_y) * from_centre.y;
    };
    const double front0 = front(s0), front1 = front(s1);
    const double ray0 = ray.inverse_z(s0), ray1 = ray.inverse_z(s1);
    const double before0 = ray0 - front0, before1 = ray1 - front1;  // > 0: in front of the slab
    if (before0 > 0) {
        if (before1 > 0) return std::nullopt;
        return s0 + (s1 - s0) * (before0 / (before0 - before1));
    }
    const double behind0 = double(facet.back) * front0 - ray0;  // > 0: behind the slab
    if (behind0 <= 0) return s0;
    const double behind1 = double(facet.back) * front1 - ray1;
    if (behind1 > 0) return std::nullopt;
    return s0 + (s1 - s0) * (behind0 / (behind0 - behind1));
}

}  // namespace inlay
