// The layers of a frame by the names under which an EXR file holds them.
#pragma once

#include "composite/session/session.h"
#include "composite/write/write_exr.h"

#include <deque>
#include <string>
#include <vector>

namespace inlay {

/// All layer names, in the order of a file: E_R_direct, ..., the noisy ones last.
const std::vector<std::string>& layer_names();

/// Names of a comma-separated list; "all" is all of them, "" none. Throws Error (usage) that names
/// the nearest known layer.
std::vector<std::string> parse_layers(const std::string& list);

/// Layers of one frame, with the images that had to be made for them. Refers to `frame` as well.
struct NamedLayers {
    std::vector<ExrLayer> layers;
    std::deque<Image<glm::vec3>> vectors;
    std::deque<Image<float>> values;
};

/// The chosen layers; what was not simulated is 0, and M is 1. `P` (m, world), `N` (world) and `Z`
/// (m, along the camera's axis) are of the kind of surface, real or virtual, that covers more of
/// the pixel.
NamedLayers named_layers(const OutputFrame& frame, const std::vector<std::string>& names);

}  // namespace inlay
