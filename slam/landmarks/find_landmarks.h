// Corners of a color image that depth places in space.
#pragma once

#include "recordings/base/color.h"
#include "recordings/base/lens.h"
#include "slam/landmarks/landmarks.h"

namespace inlay {

/// Up to 700 ORB corners (Rublee, Rabaud, Konolige and Bradski 2011), as many from each part of the
/// image as there are. `depth` (m, cleaned) and its `lens` show the same view as `color`, at its
/// size or another. Corners without depth or at a depth step are left out: what is at a step
/// changes with the view. Same bytes for any number of threads.
Landmarks find_landmarks(const Image<EncodedRgb>& color, const Image<float>& depth,
                         const Lens& lens);

}  // namespace inlay
