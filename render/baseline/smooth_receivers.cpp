// Cleaning, cutting out, smoothing and pasting back.
#include "render/baseline/smooth_receivers.h"

#include "recordings/base/check.h"
#include "recordings/base/parallel.h"
#include "render/filter/layer_sizes.h"
#include "render/filter/receiver_planes.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace inlay {
namespace {

/// Pixels from `begin` to before `end`.
struct Rectangle {
    glm::ivec2 begin{0}, end{0};
};

Rectangle occupied(const Image<std::uint32_t>& object) {
    Rectangle r{{object.width, object.height}, {0, 0}};
    for (int y = 0; y < object.height; ++y) {
        for (int x = 0; x < object.width; ++x) {
            if (object(x, y) == 0) continue;
            r.begin = glm::min(r.begin, glm::ivec2(x, y));
            r.end = glm::max(r.end, glm::ivec2(x + 1, y + 1));
        }
    }
    return r;
}

bool is_whole(const Rectangle& r, int width, int height) {
    return r.begin == glm::ivec2(0) && r.end == glm::ivec2(width, height);
}

template <class Pixel>
Image<Pixel> cut(const Image<Pixel>& image, const Rectangle& r) {
    const glm::ivec2 size = r.end - r.begin;
    Image<Pixel> result(size.x, size.y);
    for (int y = 0; y < size.y; ++y)
        std::copy_n(&image(r.begin.x, r.begin.y + y), size.x, &result(0, y));
    return result;
}

Receiver cut(const Receiver& receiver, const Rectangle& r) {
    return {cut(receiver.object, r), cut(receiver.position, r), cut(receiver.normal, r),
            cut(receiver.occluder_direct, r), cut(receiver.occluder_indirect, r)};
}

void paste(const FilterPlanes& planes, std::size_t first, const Rectangle& r, Image<Rgb>& image) {
    const glm::ivec2 size = r.end - r.begin;
    parallel_rows(size.y, [&](int y) {
        for (int x = 0; x < size.x; ++x) {
            if (planes.object(x, y) == 0) continue;
            image(r.begin.x + x, r.begin.y + y) = {planes.channels[first](x, y),
                                                   planes.channels[first + 1](x, y),
                                                   planes.channels[first + 2](x, y)};
        }
    });
}

using ImagePairs = std::vector<std::pair<const Image<Rgb>*, Image<Rgb>*>>;  // from, to

/// One call of the smoother; the results are black before.
void smooth_images(const PreparedReceiver& receiver, const Rectangle& r, const ImagePairs& images,
                   const Smoother& smoother) {
    const bool whole = is_whole(r, images.front().first->width, images.front().first->height);
    std::vector<Image<Rgb>> cuts(whole ? 0 : images.size());
    std::vector<const Image<Rgb>*> pointers;
    for (std::size_t i = 0; i < images.size(); ++i) {
        if (!whole) cuts[i] = cut(*images[i].first, r);
        pointers.push_back(whole ? images[i].first : &cuts[i]);
    }
    FilterPlanes planes = planes_of(receiver, pointers, nullptr);
    smoother(planes);
    for (std::size_t i = 0; i < images.size(); ++i)
        paste(planes, 3 * i, r, *images[i].second);
}

using Layer = Image<Rgb> Irradiance::*;

void smooth_kind(const NoisyLayers& now, Receiver NoisyLayers::*kind,
                 const std::vector<Layer>& layers, const SmootherNeeds& needs,
                 const Smoother& smoother, Layers& result) {
    ImagePairs direct, indirect;
    for (const Layer layer : layers) {
        for (Irradiance* light : {&result.direct, &result.indirect})
            light->*layer = Image<Rgb>(now.lens.width, now.lens.height, Rgb(0));
        direct.emplace_back(&(now.direct.*layer), &(result.direct.*layer));
        indirect.emplace_back(&(now.indirect.*layer), &(result.indirect.*layer));
    }
    if (!any_object(now.*kind)) return;
    const Rectangle r = occupied((now.*kind).object);
    PreparedReceiver receiver;
    const bool whole = is_whole(r, now.lens.width, now.lens.height);
    receiver.receiver = whole ? cleaned(now.*kind) : cleaned(cut(now.*kind, r));
    if (needs.surface) receiver.surface = surface_planes(receiver.receiver);
    if (!needs.lights_apart) {
        direct.insert(direct.end(), indirect.begin(), indirect.end());
        smooth_images(receiver, r, direct, smoother);
    } else {
        smooth_images(receiver, r, direct, smoother);
        smooth_images(receiver, r, indirect, smoother);
    }
}

}  // namespace

Layers smooth_receivers(const NoisyLayers& now, const SmootherNeeds& needs,
                        const Smoother& smoother) {
    require_layer_sizes(now);
    const Image<float> blank(now.lens.width, now.lens.height, 0.0f);
    Layers result{now.m, now.k_v, now.s_rv, {}, {}, blank, blank};
    for (Rgb& s : result.s_rv.pixels) {
        if (!std::isfinite(s.r + s.g + s.b)) s = Rgb(0);
    }
    smooth_kind(now, &NoisyLayers::real, {&Irradiance::e_r, &Irradiance::e_rv_real}, needs,
                smoother, result);
    smooth_kind(now, &NoisyLayers::virtual_, {&Irradiance::e_rv_virtual}, needs, smoother, result);
    return result;
}

void require_width(double value, const char* name) {
    require(std::isfinite(value) && value > 0,
            std::string(name) + " is " + std::to_string(value) + ", expected a positive number",
            ExitCode::usage);
}

}  // namespace inlay
