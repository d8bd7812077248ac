#include "render/scene/mesh_size_check.h"

#include "recordings/base/check.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <fstream>
#include <sstream>
#include <string>

namespace inlay {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

constexpr std::uint64_t max_elements =
    100'000'000;  // of one glTF accessor: 20 M triangles and more

void require_plausible_ply(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    const std::uintmax_t bytes = fs::file_size(file);
    std::string line;
    for (int number = 1; number <= 1000 && std::getline(stream, line); ++number) {
        std::istringstream words(line);
        std::string keyword, name, count;
        words >> keyword >> name >> count;
        if (keyword == "end_header") return;
        if (keyword != "element") continue;
        const bool digits = !count.empty() && count.size() < 16 &&
                            count.find_first_not_of("0123456789") == std::string::npos;
        require(digits && std::stoull(count) <= bytes,
                file.string() + ": line " + std::to_string(number) + " claims " + count + " of \"" +
                    name + "\" in a file of " + std::to_string(bytes) +
                    " bytes; the file is damaged or cut off");
    }
    throw Error(ExitCode::bad_data, file.string() +
                                        ": no end_header within 1000 lines; expected a "
                                        "PLY file");
}

/// The JSON text of a .gltf or of the first chunk of a .glb.
std::string gltf_text(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    std::ostringstream content;
    content << stream.rdbuf();
    std::string text = content.str();
    if (!text.starts_with("glTF")) return text;
    require(text.size() >= 20, file.string() + ": cut off within the header");
    std::uint64_t length = 0;
    for (std::size_t i = 16; i-- > 12;)
        length = length << 8 | std::uint64_t(static_cast<unsigned char>(text[i]));
    require(length <= text.size() - 20, file.string() + ": cut off within the first chunk");
    return text.substr(20, std::size_t(length));
}

json gltf_document(const fs::path& file) {
    try {
        return json::parse(gltf_text(file), [&](int depth, json::parse_event_t, json&) {
            require(depth <= 64, file.string() + ": nested deeper than 64 levels");
            return true;
        });
    } catch (const json::exception& fault) {
        throw Error(ExitCode::bad_data, file.string() + ": not valid glTF (" + fault.what() + ")");
    }
}

void require_plausible_gltf(const fs::path& file) {
    const json document = gltf_document(file);
    if (!document.is_object() || !document.contains("accessors")) return;
    const json& accessors = document["accessors"];
    for (std::size_t i = 0; accessors.is_array() && i < accessors.size(); ++i) {
        const auto place = file.string() + ": accessors[" + std::to_string(i) + "]";
        const json& a = accessors[i];
        require(a.is_object() && a.contains("count") && a["count"].is_number_unsigned(),
                place + ": no \"count\"; expected a whole number");
        require(a["count"].get<std::uint64_t>() <= max_elements,
                place + ": claims " + a["count"].dump() + " elements; expected at most " +
                    std::to_string(max_elements));
    }
}

/// Triangles of a glTF primitive: modes 4, 5 and 6 are lists, strips and fans.
std::size_t triangles_of(const json& document, const json& primitive) {
    const json& accessors = document.at("accessors");
    const json& source = primitive.contains("indices") ? primitive.at("indices")
                                                       : primitive.at("attributes").at("POSITION");
    const auto count = accessors.at(source.get<std::size_t>()).at("count").get<std::size_t>();
    const int mode = primitive.value("mode", 4);
    if (mode == 4) return count / 3;
    return (mode == 5 || mode == 6) && count >= 3 ? count - 2 : 0;
}

}  // namespace

std::string mesh_extension(const fs::path& file) {
    std::string extension = file.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return char(std::tolower(c)); });
    require(
        extension == ".obj" || extension == ".ply" || extension == ".gltf" || extension == ".glb",
        file.string() + ": ends in \"" + extension + "\"; expected .obj, .ply, .gltf or .glb");
    return extension;
}

void require_plausible_counts(const fs::path& file) {
    const std::string extension = mesh_extension(file);
    if (extension == ".ply") require_plausible_ply(file);
    if (extension == ".gltf" || extension == ".glb") require_plausible_gltf(file);
}

std::size_t listed_triangles(const fs::path& file) {
    const std::string extension = mesh_extension(file);
    if (extension != ".gltf" && extension != ".glb") return 0;
    const json document = gltf_document(file);
    std::size_t sum = 0;
    try {
        for (const json& mesh : document.at("meshes"))
            for (const json& primitive : mesh.at("primitives"))
                sum += triangles_of(document, primitive);
    } catch (const json::exception& fault) {
        throw Error(ExitCode::bad_data, file.string() + ": incomplete glTF (" + fault.what() + ")");
    }
    return sum;
}

}  // namespace inlay
