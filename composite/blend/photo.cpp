#include "composite/blend/photo.h"

#include <utility>

namespace inlay {

Photo linearise(Image<EncodedRgb> color, const Rgb& exposure) {
    Image<Rgb> linear = decode(color, exposure);
    return {std::move(color), std::move(linear), exposure};
}

Photo at_reference_exposure(Photo photo) {
    if (photo.exposure == Rgb(1)) return photo;
    photo.encoded = encode(photo.linear);
    photo.exposure = Rgb(1);
    return photo;
}

}  // namespace inlay
