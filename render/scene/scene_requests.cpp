#include "recordings/base/check.h"
#include "render/scene/scene_parts.h"

namespace inlay {
namespace {

/// Refuses a member of the description if it asks for any of `wishes`; those that are empty are not
/// asked for.
void refuse_if_asked(const JsonNode& document, const char* key,
                     const std::vector<std::string>& wishes, const std::string& remedy) {
    std::string asked;
    for (const std::string& wish : wishes)
        if (!wish.empty()) asked += (asked.empty() ? "" : " and ") + wish;
    if (asked.empty()) return;
    throw Error(ExitCode::bad_data, member(document, key).place + ": " + asked +
                                        " cannot be done by this version; remove \"" + key + "\"" +
                                        remedy);
}

void read_light(const JsonNode& node, const AssetFolders& assets, SceneRequests& requests) {
    require_known_keys(node, {"polygon", "mesh", "radiance"});
    const JsonNode* polygon = find(node, "polygon");
    const JsonNode* mesh = find(node, "mesh");
    if ((polygon != nullptr) == (mesh != nullptr))
        refuse(node, polygon ? "both \"polygon\" and \"mesh\"" : "no shape",
               "one of \"polygon\" and \"mesh\"");
    color_of(member(node, "radiance"), any_radiance);
    if (mesh) {
        find_asset(assets, text_of(*mesh), mesh->place);
        ++requests.mesh_lights;
        return;
    }
    if (items_of(*polygon).size() < 3)
        refuse(*polygon, describe(*polygon), "at least three corners");
    for (const JsonNode& corner : polygon->items)
        vector3_of(corner, any_length);
    ++requests.polygon_lights;
}

bool medium_of(const JsonNode& node) {
    constexpr Range any_coefficient{0, 1e6};  // 1/m
    require_known_keys(node, {"scattering", "absorption", "g"});
    Rgb extinction(0);
    for (const char* key : {"scattering", "absorption"})
        if (const JsonNode* n = find(node, key)) extinction += color_of(*n, any_coefficient);
    if (const JsonNode* n = find(node, "g")) number_of(*n, {-1, 1});
    return extinction != Rgb(0);
}

void read_camera(const JsonNode& node, SceneRequests& requests) {
    require_known_keys(node, {"aperture_radius", "focus_distance", "shutter"});
    if (const JsonNode* n = find(node, "aperture_radius"))
        requests.aperture_radius = number_of(*n, {0, 10});
    if (const JsonNode* n = find(node, "focus_distance"))
        requests.focus_distance = number_of(*n, {1e-3, 1e6});
    if (const JsonNode* n = find(node, "shutter")) requests.shutter = number_of(*n, {0, 1e3});
    if (requests.aperture_radius > 0 && requests.focus_distance == 0)
        refuse(node, "an aperture without a focus", "\"focus_distance\" too");
}

}  // namespace

SceneRequests requests_of(const JsonNode& document, const AssetFolders& assets) {
    SceneRequests requests;
    if (const JsonNode* lights = find(document, "lights")) {
        if (items_of(*lights).size() > 10000) refuse(*lights, describe(*lights), "at most 10000");
        for (const JsonNode& light : lights->items)
            read_light(light, assets, requests);
    }
    if (const JsonNode* n = find(document, "medium")) requests.medium = medium_of(*n);
    if (const JsonNode* n = find(document, "camera")) read_camera(*n, requests);
    return requests;
}

void refuse_what_cannot_be_done(const JsonNode& document, const SceneRequests& asked) {
    const auto wish = [](bool made, const char* what) { return std::string(made ? what : ""); };
    refuse_if_asked(document, "lights",
                    {wish(asked.polygon_lights > 0, "light of polygons (polygon_light)"),
                     wish(asked.mesh_lights > 0, "light of meshes (mesh_light)")},
                    " and light the scene by its environment");
    refuse_if_asked(document, "medium", {wish(asked.medium, "scattering or absorption (medium)")},
                    "");
    refuse_if_asked(document, "camera",
                    {wish(asked.aperture_radius > 0, "blur out of focus (defocus)"),
                     wish(asked.shutter > 0, "blur of what moves (motion_blur)")},
                    "");
}

}  // namespace inlay
