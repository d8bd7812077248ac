#include "composite/session/named_layers.h"

#include "recordings/base/check.h"
#include "recordings/base/nearest_word.h"

#include <algorithm>
#include <sstream>
#include <string_view>

namespace inlay {
namespace {

constexpr const char* color_names[] = {"E_R_direct",
                                       "E_R_indirect",
                                       "E_RV_real_direct",
                                       "E_RV_real_indirect",
                                       "E_RV_virtual_direct",
                                       "E_RV_virtual_indirect",
                                       "S_RV",
                                       "k_V"};

/// The image of a color layer; `AnyLayers` is Layers or NoisyLayers.
template <class AnyLayers>
const Image<Rgb>& color_image(const AnyLayers& layers, std::string_view name) {
    if (name == "E_R_direct") return layers.direct.e_r;
    if (name == "E_R_indirect") return layers.indirect.e_r;
    if (name == "E_RV_real_direct") return layers.direct.e_rv_real;
    if (name == "E_RV_real_indirect") return layers.indirect.e_rv_real;
    if (name == "E_RV_virtual_direct") return layers.direct.e_rv_virtual;
    if (name == "E_RV_virtual_indirect") return layers.indirect.e_rv_virtual;
    return name == "S_RV" ? layers.s_rv : layers.k_v;
}

const std::string noisy_suffix = "_noisy";

/// The receiver that covers more of a pixel, or null.
const Receiver* main_receiver(const NoisyLayers& noisy, std::size_t pixel) {
    const Receiver& first = noisy.m.pixels[pixel] > 0.5f ? noisy.real : noisy.virtual_;
    const Receiver& second = noisy.m.pixels[pixel] > 0.5f ? noisy.virtual_ : noisy.real;
    const auto seen = [&](const Receiver& r) {
        return !r.object.empty() && r.object.pixels[pixel] != 0;
    };
    if (seen(first)) return &first;
    return seen(second) ? &second : nullptr;
}

const Image<glm::vec3>& add_vectors(NamedLayers& out, const OutputFrame& frame, bool normals) {
    const Image<Rgb>& like = frame.composite.linear;
    Image<glm::vec3>& image = out.vectors.emplace_back(like.width, like.height, glm::vec3(0));
    for (std::size_t i = 0; frame.noisy && i < image.pixels.size(); ++i) {
        if (const Receiver* r = main_receiver(*frame.noisy, i))
            image.pixels[i] = normals ? r->normal.pixels[i] : r->position.pixels[i];
    }
    return image;
}

const Image<float>& add_depth(NamedLayers& out, const OutputFrame& frame) {
    const Image<Rgb>& like = frame.composite.linear;
    Image<float>& image = out.values.emplace_back(like.width, like.height, 0.0f);
    if (!frame.noisy) return image;
    const Pose camera_from_world = inverse(frame.noisy->world_from_camera);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        if (const Receiver* r = main_receiver(*frame.noisy, i))
            image.pixels[i] = float((camera_from_world * glm::dvec3(r->position.pixels[i])).z);
    }
    return image;
}

/// The image itself, or one of `like`'s size with `fill` everywhere where it is empty.
const Image<float>& or_constant(NamedLayers& out, const Image<float>& image, const Image<Rgb>& like,
                                float fill) {
    if (!image.empty()) return image;
    return out.values.emplace_back(like.width, like.height, fill);
}

ExrLayer color_layer_of(NamedLayers& out, const OutputFrame& frame, const std::string& name) {
    const bool noisy = name.ends_with(noisy_suffix);
    const std::string base = noisy ? name.substr(0, name.size() - noisy_suffix.size()) : name;
    const Image<Rgb>* image = nullptr;
    if (!noisy) image = &color_image(frame.layers, base);
    if (noisy && frame.noisy) image = &color_image(*frame.noisy, base);
    if (!image || image->empty()) {
        const Image<Rgb>& like = frame.composite.linear;
        image = &out.vectors.emplace_back(like.width, like.height, Rgb(0));
    }
    return color_layer(name, *image);
}

ExrLayer layer_of(NamedLayers& out, const OutputFrame& frame, const std::string& name) {
    const Image<Rgb>& like = frame.composite.linear;
    if (name == "M") return value_layer(name, or_constant(out, frame.layers.m, like, 1));
    if (name == "camera") return color_layer(name, frame.camera);
    if (name == "P") return vector_layer(name, add_vectors(out, frame, false));
    if (name == "N") return vector_layer(name, add_vectors(out, frame, true));
    if (name == "Z") return value_layer(name, add_depth(out, frame));
    if (name == "bandwidth_direct")
        return value_layer(name, or_constant(out, frame.layers.bandwidth_direct, like, 0));
    if (name == "bandwidth_indirect")
        return value_layer(name, or_constant(out, frame.layers.bandwidth_indirect, like, 0));
    return color_layer_of(out, frame, name);
}

}  // namespace

const std::vector<std::string>& layer_names() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> all(std::begin(color_names), std::end(color_names));
        for (const char* name :
             {"M", "camera", "P", "N", "Z", "bandwidth_direct", "bandwidth_indirect"})
            all.emplace_back(name);
        for (const std::string_view name : color_names)  // albedo is not filtered
            if (name != "k_V") all.push_back(std::string(name) + noisy_suffix);
        return all;
    }();
    return names;
}

std::vector<std::string> parse_layers(const std::string& list) {
    if (list == "all") return layer_names();
    std::vector<std::string> result;
    std::istringstream items(list);
    for (std::string name; std::getline(items, name, ',');) {
        const auto& known = layer_names();
        require(std::find(known.begin(), known.end(), name) != known.end(),
                "--layers " + list + ": there is no layer '" + name + "'; did you mean '" +
                    nearest_word(name, known) + "'?",
                ExitCode::usage);
        result.push_back(name);
    }
    return result;
}

NamedLayers named_layers(const OutputFrame& frame, const std::vector<std::string>& names) {
    NamedLayers out;
    for (const std::string& name : names)
        out.layers.push_back(layer_of(out, frame, name));
    return out;
}

}  // namespace inlay
