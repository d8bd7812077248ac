// RgbdFrame: what leaves a recording.
#pragma once

#include "recordings/base/color.h"
#include "recordings/base/image.h"
#include "recordings/base/lens.h"
#include "recordings/base/pose.h"

#include <optional>

namespace inlay {

struct RgbdFrame {
    int index = 0;            // the recording's own number
    double time = 0;          // s since the recording's first frame
    Lens lens;                // of both images, which are registered to each other
    Image<EncodedRgb> color;  // as recorded
    Image<float> depth;       // z-depth, m; 0 = not measured
    std::optional<Pose> recorded_world_from_camera;
};

}  // namespace inlay
