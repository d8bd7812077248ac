// Depth steps of a surface map, moved to where the photograph shows them.
#pragma once

#include "recordings/base/color.h"
#include "recordings/base/surface_map.h"

namespace inlay {

struct EdgeSettings {
    float reach = 0.008f;    // m, across the nearer surface: how far depth steps may be off; 0: as
                             // they are
    float step = 0.02f;      // share of depth by which a step leaves both surfaces' planes
    float contrast = 0.06f;  // of encoded color, 0..1: edges with less stay where they are
};

/// Share of depth by which a surface is followed along its plane, at most, each of the two times.
inline constexpr float steepest_plane = 0.1f;

/// Throws Error that names the setting which is out of range.
void validate(const EdgeSettings& settings);

/// Decides anew, for every pixel near a depth step or a hole, which of the surfaces around it the
/// photograph shows there: the share of the nearer one is where its color lies between the colors
/// of both sides (pairs of samples by their fit, as Wang and Cohen 2007, "Robust Matting", eq. 1
/// to 3). First within 2.5 times the reach, at most a hundredth of the image's width, for what is
/// thick and bright enough to be sure, since sensors smear some depth steps by as much; then within
/// the reach. The pixel takes the plane of the one that fills more of it, and knows the other where
/// the edge crosses it (`map.split`). Pixels in holes that are narrower than the reach are filled.
/// What is so thin that no pixel of it is beyond the reach of its edges keeps its depth, and so do
/// steps of less than some 4 % of depth. `photo` is the map's photograph, as recorded. Same bytes
/// for any number of threads.
void follow_photograph(SurfaceMap& map, const Image<EncodedRgb>& photo,
                       const EdgeSettings& settings);

}  // namespace inlay
