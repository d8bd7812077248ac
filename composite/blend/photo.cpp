#include "composite/blend/photo.h"

#include <utility>

namespace inlay {

Photo linearise(Image<EncodedRgb> color) {
    Image<Rgb> linear = decode(color);
    return {std::move(color), std::move(linear)};
}

}  // namespace inlay
