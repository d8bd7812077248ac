// How an RGB-D recording's color images lie to its depth images: the rigid motion between the two
// cameras, the color camera's focal length and the delay between the images, or that they are
// registered already.
#pragma once

#include "recordings/base/color.h"
#include "recordings/base/image.h"
#include "recordings/base/lens.h"
#include "recordings/base/pose.h"
#include "slam/registration/color_mapping.h"
#include "slam/registration/depth_edges.h"

#include <cstdint>
#include <span>
#include <vector>

namespace inlay {

/// What one frame contributes.
struct RegistrationFrame {
    Image<float> depth;       // z-depth, m; 0, NaN and infinities are not measured
    Image<EncodedRgb> color;  // as recorded
    double time = 0;          // s, of both
};

struct RegistrationSettings {
    int frames = 30;          // for spread_frames(); with fewer than 12 the uncertainty is vague
    int points = 400;         // per frame, at most: rims chosen at random
    bool lens_known = false;  // the color camera's focal length is not to be refined
    std::uint32_t seed = 1;   // of the choice
    DepthEdgeSettings edges;
};

/// Throws Error that names the setting which is out of range.
void validate(const RegistrationSettings& settings);

/// The places of `chosen` frames, or of all if there are fewer, spread over a recording of `count`.
std::vector<int> spread_frames(int count, int chosen);

/// An estimate with its doubts, standard deviations from leaving out a quarter of the recording at
/// a time.
struct ColorRegistration {
    Pose color_from_depth;         // depth camera's frame -> color camera's frame
    Lens color_lens;               // the color camera's, its focal length refined if not known
    double delay = 0;              // s: the color image shows the world that much later
    glm::dvec3 rotation_sd{0};     // rad
    glm::dvec3 translation_sd{0};  // m
    double delay_sd = 0;           // s
    double focal_sd = 0;           // px, of fx
    double sd_px = 0;              // px, rms over the rims
    double shift_px = 0;           // px, rms over the rims, from where they would be if depth and
                                   // color were registered already
    double delay_px = 0;           // px, likewise by the delay alone
    double distance_before = 0;    // px, mean from rims to edges if registered already; cap 10
    double distance_after = 0;     // px, likewise with this estimate
    double near_before = 0;        // share of the rims within 2 px of an edge
    double near_after = 0;         // likewise
    bool needed = false;           // the images are not registered: use the pose and the lens
    bool delay_needed = false;     // they are not of the same time: use the delay
    int points = 0;                // rims used; 0: too few for an estimate, all else is default
};

/// Estimates the mapping under which rims of depth images lie on edges of color images: a search
/// over focal length, baseline and two rotations on some of the frames, then refinement on all.
/// `trajectory` (ascending times) gives the depth camera's motion, for the delay; with fewer than
/// two poses the delay is taken to be 0. A mapping is said to be needed if it moves rims by more
/// than 1 px and three standard deviations, and explains quarters of the recording that it was not
/// estimated from better than "registered already" does. Needs three frames with 50 rim pixels
/// each. Throws Error if an image does not have its lens's size, or times do not ascend.
ColorRegistration register_color(std::span<const RegistrationFrame> frames, const Lens& depth_lens,
                                 const Lens& color_lens, std::span<const TimedCamera> trajectory,
                                 const RegistrationSettings& settings = {});

}  // namespace inlay
