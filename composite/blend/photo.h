// Photo: a frame's picture as recorded and as linear radiance.
#pragma once

#include "recordings/base/color.h"
#include "recordings/base/image.h"

namespace inlay {

struct Photo {
    Image<EncodedRgb> encoded;  // as recorded
    Image<Rgb> linear;          // L_cam, relative radiance at the reference exposure
    Rgb exposure{1};            // by which the camera made it brighter than that, per channel
};

/// Undoes the sRGB curve of a recorded picture, which eq. 6.2 of Mehta 2015 needs before it
/// multiplies, and its exposure (> 0).
Photo linearise(Image<EncodedRgb> color, const Rgb& exposure = Rgb(1));

/// The photograph as it would have been recorded at exposure 1.
Photo at_reference_exposure(Photo photo);

}  // namespace inlay
