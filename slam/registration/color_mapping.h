// Where the color camera sees what the depth camera measured.
#pragma once

#include "recordings/base/lens.h"
#include "recordings/base/pose.h"

#include <array>
#include <span>

namespace inlay {

/// Where the depth camera was.
struct TimedCamera {
    double time = 0;  // s
    Pose world_from_camera;
};

/// Everything that is estimated. The default is "registered already".
struct ColorMapping {
    Pose color_from_depth;  // depth camera's frame -> color camera's frame
    double delay = 0;       // s: the color image shows the world that much after the depth image
    double log_focal = 0;   // logarithm of the color camera's focal length over the lens's own
    double rim = 0;         // px of the depth image by which rims lie beyond their outermost pixel
};

/// Indices of the parameters by which a mapping moves.
struct MappingParameter {
    static constexpr std::size_t rotation = 0;     // 3: rad, a turn in the color camera's frame
    static constexpr std::size_t translation = 3;  // 3: m
    static constexpr std::size_t delay = 6, log_focal = 7, rim = 8;
    static constexpr std::size_t count = 9;
};
using MappingStep = std::array<double, MappingParameter::count>;

/// The values of the parameters; the rotation's is its logarithm.
MappingStep parameters_of(const ColorMapping& mapping);

/// The mapping after a small step.
ColorMapping moved(const ColorMapping& mapping, const MappingStep& step);

/// The color camera's lens with the mapping's focal length.
Lens refined(const Lens& color_lens, const ColorMapping& mapping);

/// A mapping for the points of one depth image.
struct FrameMapping {
    Pose color_from_depth;  // with the camera's motion during the delay
    glm::dmat3 turn{0.0};   // 1/s: how its rotation and
    glm::dvec3 drift{0.0};  // m/s: its translation change with the delay
    glm::dvec3 pivot{0.0};  // m, about which the mapping's own rotation turns
    Lens lens;              // the color camera's
    double rim = 0;         // px
};

/// The mapping at a depth image's time (s). `trajectory` ascends in time; between its poses and a
/// little beyond its ends the camera moves steadily. With fewer than two poses it stands still.
FrameMapping mapping_at(const ColorMapping& mapping, const Lens& color_lens,
                        std::span<const TimedCamera> trajectory, double time);

/// A point of a rim, in the depth camera's frame.
struct RimPoint {
    glm::dvec3 position{0};  // m, at the center of the rim's outermost pixel
    glm::dvec3 outward{0};   // m per px of the depth image, along the rim's normal
};

/// Where the color camera sees a point of a rim.
struct SeenRim {
    bool ahead = false;       // of the camera, at a depth that can be divided by
    glm::dvec3 p_color{0};    // m, the color camera's frame
    glm::dvec2 position{0};   // px
    glm::dvec2 normal{0};     // unit, towards the far surface
    glm::dmat3x2 slope{0.0};  // px per m: how the position changes with p_color
    glm::dvec2 outward{0};    // px per px: how it changes with the rim
};
SeenRim see(const FrameMapping& mapping, const RimPoint& point);

/// How the part of a seen point's position along `direction` changes with each parameter.
MappingStep derivative(const FrameMapping& mapping, const RimPoint& point, const SeenRim& seen,
                       const glm::dvec2& direction);

}  // namespace inlay
