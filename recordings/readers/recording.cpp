#include "recordings/readers/recording.h"

#include "recordings/base/check.h"
#include "recordings/readers/redwood.h"
#include "recordings/readers/seven_scenes.h"
#include "recordings/readers/tum_rgbd.h"

#include <cmath>

namespace inlay {
namespace fs = std::filesystem;
namespace {

struct Reader {
    const char* name;
    const char* looks_for;
    bool (*recognises)(const fs::path&);
    Recording (*open)(const fs::path&, const OpenOptions&);
};

/// The first that recognises a folder opens it.
const Reader readers[] = {
    {"tum", "rgb.txt and depth.txt", recognises_tum, open_tum},
    {"3dmatch", "frame-000000.color.* with camera-intrinsics.txt beside it or one level up",
     recognises_three_d_match, open_seven_scenes},
    {"7scenes", "frame-000000.color.*", recognises_seven_scenes, open_seven_scenes},
    {"open3d", "depth/ and one of color/, image/, rgb/", recognises_redwood, open_redwood},
};

std::string joined_names() {
    std::string names;
    for (const Reader& reader : readers)
        names += (names.empty() ? "" : ", ") + std::string(reader.name);
    return names;
}

const Reader& reader_named(const std::string& name) {
    for (const Reader& reader : readers)
        if (name == reader.name) return reader;
    throw Error(ExitCode::usage,
                "--profile: found '" + name + "', expected one of " + joined_names());
}

const Reader& reader_for(const fs::path& folder) {
    std::string sought;
    for (const Reader& reader : readers) {
        if (reader.recognises(folder)) return reader;
        sought += "\n  " + std::string(reader.name) + ": " + reader.looks_for;
    }
    throw Error(ExitCode::bad_data,
                folder.string() + ": found no recording that a reader knows; expected one of" +
                    sought + "\nGive the folder that holds these itself.");
}

void validate(const OpenOptions& options) {
    const auto check = [](bool good, const std::string& message) {
        require(good, message, ExitCode::usage);
    };
    if (options.depth_scale)
        check(std::isfinite(*options.depth_scale) && *options.depth_scale > 0,
              "--depth-scale: expected units per metre above 0");
    if (options.max_depth)
        check(std::isfinite(*options.max_depth) && *options.max_depth >= 0,
              "--max-depth: expected metres, 0 or more");
    if (options.lens) {
        const glm::dvec4& l = *options.lens;
        check(std::isfinite(l.x + l.y + l.z + l.w) && l.x > 0 && l.y != 0,
              "--lens: expected fx,fy,cx,cy in px with fx above 0 and fy other than 0");
    }
    if (options.distortion)
        for (const double k : *options.distortion)
            check(std::isfinite(k), "--distortion: expected five finite numbers k1,k2,p1,p2,k3");
}

}  // namespace

Recording open_recording(const fs::path& folder, const OpenOptions& options) {
    validate(options);
    std::error_code error;
    require(fs::exists(folder, error), folder.string() + ": no such folder",
            ExitCode::input_missing);
    require(fs::is_directory(folder, error),
            folder.string() + ": found a file, expected the folder of a recording");
    const Reader& reader = options.profile ? reader_named(*options.profile) : reader_for(folder);
    Recording recording = reader.open(folder, options);
    recording.info.profile = reader.name;
    return recording;
}

std::vector<std::string> reader_names() {
    std::vector<std::string> names;
    for (const Reader& reader : readers)
        names.emplace_back(reader.name);
    return names;
}

}  // namespace inlay
