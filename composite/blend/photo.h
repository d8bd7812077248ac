// Photo: a frame's picture as recorded and as linear radiance.
#pragma once

#include "recordings/base/color.h"
#include "recordings/base/image.h"

namespace inlay {

struct Photo {
    Image<EncodedRgb> encoded;  // as recorded
    Image<Rgb> linear;          // L_cam, relative radiance, 0..1
};

/// Undoes the sRGB curve of a recorded picture, which eq. 6.2 of Mehta 2015 needs before it
/// multiplies.
Photo linearise(Image<EncodedRgb> color);

}  // namespace inlay
