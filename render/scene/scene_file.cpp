#include "render/scene/scene_file.h"

#include "recordings/base/check.h"
#include "recordings/environment/latlong_files.h"
#include "render/scene/scene_parts.h"

#include <set>

namespace inlay {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void refuse_unable(const JsonNode& node, const std::string& what,
                                const std::string& remedy) {
    throw Error(ExitCode::bad_data,
                node.place + ": " + what + " cannot be done by this version; " + remedy);
}

GaussianLobe lobe_of(const JsonNode& node) {
    require_known_keys(node, {"direction", "sharpness", "radiance"});
    return {direction_of(member(node, "direction")), number_of(member(node, "sharpness"), {0, 1e5}),
            color_of(member(node, "radiance"), any_radiance)};
}

DescribedLight described_light_of(const JsonNode& node) {
    DescribedLight light;
    if (const JsonNode* n = find(node, "ambient")) light.ambient = color_of(*n, any_radiance);
    if (const JsonNode* n = find(node, "lobes")) {
        if (items_of(*n).size() > 256) refuse(*n, describe(*n), "at most 256 lobes");
        for (const JsonNode& item : n->items)
            light.lobes.push_back(lobe_of(item));
    }
    return light;
}

View view_of(const JsonNode& node) {
    require_known_keys(node, {"width", "height", "lens", "world_from_camera", "up"});
    View view;
    view.lens.width = integer_of(member(node, "width"), {1, 16384});
    view.lens.height = integer_of(member(node, "height"), {1, 16384});
    const JsonNode& lens = member(node, "lens");
    const std::vector<double> v = numbers_of(lens, 4, {-1e6, 1e6});
    if (!(v[0] > 0) || v[1] == 0)
        refuse(lens, "a focal length of " + std::to_string(v[0]) + ", " + std::to_string(v[1]),
               "[fx, fy, cx, cy] in px with fx above 0 and fy not 0");
    view.lens.fx = v[0], view.lens.fy = v[1], view.lens.cx = v[2], view.lens.cy = v[3];
    view.world_from_camera = pose_of(member(node, "world_from_camera"));
    if (const JsonNode* n = find(node, "up")) view.up = direction_of(*n);
    return view;
}

std::vector<PathKey> path_of(const JsonNode& node) {
    std::vector<PathKey> path;
    for (const JsonNode& item : items_of(node)) {
        require_known_keys(item, {"time", "world_from_camera"});
        path.push_back({number_of(member(item, "time"), any_time),
                        pose_of(member(item, "world_from_camera"))});
    }
    require_increasing_times(node.items);
    return path;
}

void read_objects(SceneFile& scene, const JsonNode& node, const AssetFolders& assets) {
    if (items_of(node).size() > 10000) refuse(node, describe(node), "at most 10000 objects");
    std::set<std::string> names;
    for (const JsonNode& item : node.items) {
        SceneEntry entry = entry_of(item, assets, scene.warnings);
        if (!names.insert(entry.object.name).second)
            refuse(member(item, "name"), "a second \"" + entry.object.name + "\"",
                   "a name of its own for every object");
        scene.entries.push_back(std::move(entry));
    }
}

}  // namespace

EnvironmentSpec environment_of(const JsonNode& node, const AssetFolders& assets) {
    require_known_keys(node, {"file", "constant", "ambient", "lobes", "mirrored_ball", "estimate",
                              "rotate_deg", "scale", "world_from_environment"});
    if (const JsonNode* n = find(node, "mirrored_ball"))
        refuse_unable(*n, "a mirrored ball", "unwrap it to a latitude-longitude \"file\"");
    if (const JsonNode* n = find(node, "estimate"))
        refuse_unable(*n, "an environment estimated from the recording",
                      "describe it with \"ambient\" and \"lobes\", or give a \"file\"");
    const JsonNode* file = find(node, "file");
    const JsonNode* constant = find(node, "constant");
    const bool lobes = find(node, "ambient") || find(node, "lobes");
    if (int(file != nullptr) + int(constant != nullptr) + int(lobes) != 1)
        refuse(node, "no source of light or several",
               "one of \"file\", \"constant\", and \"ambient\" with \"lobes\"");
    EnvironmentSpec spec;
    if (file) {
        spec.source = find_asset(assets, text_of(*file), file->place);
    } else if (constant) {
        spec.source = DescribedLight{color_of(*constant, any_radiance), {}};
    } else {
        spec.source = described_light_of(node);
    }
    if (const JsonNode* n = find(node, "rotate_deg")) spec.rotate_deg = number_of(*n, {-1e6, 1e6});
    if (const JsonNode* n = find(node, "scale")) spec.scale = float(number_of(*n, {0, 1e6}));
    if (const JsonNode* n = find(node, "world_from_environment")) {
        if (const JsonNode* turned = find(node, "rotate_deg"))
            refuse(*turned, "both \"rotate_deg\" and \"world_from_environment\"", "one of them");
        spec.world_from_environment = rotation_of(*n);
    }
    return spec;
}

SceneFile load_scene_file(const fs::path& file, const std::vector<fs::path>& more_folders,
                          SceneUse use) {
    const JsonNode document = read_json(file);
    require_known_keys(document, {"version", "environment", "objects", "lights", "medium", "camera",
                                  "view", "path"});
    const JsonNode& version = member(document, "version");
    if (number_of(version, {-1e9, 1e9}) != 1) refuse(version, describe(version), "version 1");
    const AssetFolders assets = asset_folders(file, more_folders);
    SceneFile scene;
    scene.requests = requests_of(document, assets);
    if (use == SceneUse::simulate) refuse_what_cannot_be_done(document, scene.requests);
    scene.environment = environment_of(member(document, "environment"), assets);
    if (const JsonNode* n = find(document, "objects")) read_objects(scene, *n, assets);
    if (const JsonNode* n = find(document, "view")) scene.view = view_of(*n);
    if (const JsonNode* n = find(document, "path")) scene.path = path_of(*n);
    scene.files = *assets.opened;
    return scene;
}

LoadedEnvironment load_environment(const EnvironmentSpec& spec, const glm::dvec3& up_world,
                                   const glm::dvec3& forward_world) {
    LoadedEnvironment result;
    if (const auto* file = std::get_if<fs::path>(&spec.source)) {
        LatlongFile loaded = load_latlong(*file);
        result = {{std::move(loaded.radiance)}, loaded.replaced_texels};
    } else {
        const auto& light = std::get<DescribedLight>(spec.source);
        result.map.radiance = light.lobes.empty() ? make_constant(light.ambient)
                                                  : make_lobes(light.ambient, light.lobes);
    }
    result.map.radiance = scaled(result.map.radiance, spec.scale);
    result.map.world_from_environment = spec.world_from_environment.value_or(
        align_environment(up_world, forward_world, spec.rotate_deg));
    return result;
}

}  // namespace inlay
