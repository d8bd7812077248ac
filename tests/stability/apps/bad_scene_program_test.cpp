// `inlay replay` with scenes, options and places for its output that cannot be used.
#include "tests/support/program_runs.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfRgbaFile.h>

#include <cmath>
#include <limits>

namespace inlay {
namespace {

namespace fs = std::filesystem;
using test::Outcome;
using test::replay;
using test::run_program;
using test::TemporaryFolder;
using test::tiny_recording;
using test::tiny_scene;
using test::write_file;
using testing::AllOf;
using testing::HasSubstr;
using testing::SizeIs;

/// Light from everywhere and one object, from its JSON.
std::string scene_with(const std::string& object,
                       const std::string& environment = R"({"constant": [1, 1, 1]})") {
    return R"({"version": 1, "environment": )" + environment + R"(, "objects": [)" + object + "]}";
}

const std::string grey = R"("material": {"type": "diffuse", "reflectance": [0.5, 0.5, 0.5]})";
const std::string standing = R"("transform": [1,0,0,0, 0,1,0,0.05, 0,0,1,0.1, 0,0,0,1], )" + grey;
const std::string ball = R"({"name": "ball", "sphere": {"radius": 0.05}, )" + standing + "}";
const std::string triangle = R"({"name": "triangle", "mesh": "m.obj", )" + standing + "}";

struct BadScene {
    const char* what;
    std::string scene, mesh;
    std::vector<const char*> words;  // of the message
};

TEST(BadScenes, AreRefusedBeforeAnythingIsWritten) {
    const std::string corners = "v 0 0 0\nv 0.1 0 0\nv 0 0.1 0\n";
    const std::vector<BadScene> table = {
        {"an unknown key",
         R"({"version": 1, "environment": {"constant": [1, 1, 1]}, "objcts": []})",
         "",
         {"scene.json", "objcts", "did you mean \"objects\""}},
        {"no JSON", "{", "", {"scene.json"}},
        {"an index out of range", scene_with(triangle), corners + "f 1 2 9\n", {"m.obj", "index"}},
        {"a vertex that is not a number",
         scene_with(triangle),
         "v nan 0 0\nv 0.1 0 0\nv 0 0.1 0\nf 1 2 3\n",
         {"m.obj", "vertex 0"}},
        {"a file outside of the scene's folder",
         scene_with(triangle),
         "mtllib ../../x\n" + corners + "f 1 2 3\n",
         {"m.obj", "leads out of the scene's folders"}},
        {"a mesh that is not there", scene_with(triangle), "", {"m.obj"}},
    };
    for (const BadScene& row : table) {
        const TemporaryFolder folder;
        write_file(folder / "scene.json", row.scene);
        if (!row.mesh.empty()) write_file(folder / "m.obj", row.mesh);
        const Outcome outcome = replay(tiny_recording(), folder / "scene.json", folder / "out");
        EXPECT_EQ(outcome.code, row.mesh.empty() && row.scene == scene_with(triangle) ? 66 : 65)
            << row.what << ": " << outcome.err;
        for (const char* word : row.words)
            EXPECT_THAT(outcome.err, HasSubstr(word)) << row.what;
        EXPECT_FALSE(fs::exists(folder / "out")) << row.what;
    }
}

TEST(BadScenes, AMissingOneIsSixtySix) {
    const TemporaryFolder folder;
    const Outcome outcome = replay(tiny_recording(), folder / "none.json", folder / "out");
    EXPECT_EQ(outcome.code, 66);
    EXPECT_THAT(outcome.err, HasSubstr("none.json"));
}

TEST(BadScenes, NothingStandsWhereNothingWasMeasured) {
    const TemporaryFolder folder;
    const fs::path recording = test::copy_of_recording(folder);
    const fs::path first = recording / "depth/000000.png";
    cv::Mat depth = cv::imread(first.string(), cv::IMREAD_UNCHANGED);
    depth(cv::Rect(0, 0, 48, 72)).setTo(0);
    test::write_image(first, depth);
    write_file(folder / "scene.json", scene_with(R"({"name": "ball", "sphere": {"radius": 0.05}, )"
                                                 R"("place": {"frame": 0, "pixel": [20, 40]}, )" +
                                                 grey + "}"));
    // Later frames measured what the first one did not, and a look ahead knows them.
    EXPECT_EQ(replay(recording, folder / "scene.json", folder / "ahead").code, 0);
    const Outcome outcome = replay(recording, folder / "scene.json", folder / "out", "--slam fast");
    EXPECT_EQ(outcome.code, 65);
    EXPECT_THAT(outcome.err, AllOf(HasSubstr("ball"), HasSubstr("20"), HasSubstr("40")));
    EXPECT_FALSE(fs::exists(folder / "out"));
}

/// A map of which one texel in eight is not a number or infinite.
void write_broken_environment(const fs::path& file) {
    std::vector<Imf::Rgba> texels(32 * 16, Imf::Rgba(1, 1, 1));
    for (std::size_t i = 0; i < texels.size(); i += 16) {
        texels[i].r = std::numeric_limits<float>::quiet_NaN();
        texels[i + 8].b = std::numeric_limits<float>::infinity();
    }
    Imf::RgbaOutputFile exr(file.string().c_str(), 32, 16, Imf::WRITE_RGB);
    exr.setFrameBuffer(texels.data(), 1, 32);
    exr.writePixels(16);
}

/// Values of an OpenEXR file's channels that are not finite, and how many values there are.
std::pair<int, int> count_broken_values(const fs::path& file) {
    Imf::InputFile exr(file.string().c_str());
    const Imath::Box2i window = exr.header().dataWindow();
    const int width = window.max.x + 1, height = window.max.y + 1;
    int broken = 0, values = 0;
    const Imf::ChannelList& channels = exr.header().channels();
    for (auto channel = channels.begin(); channel != channels.end(); ++channel) {
        std::vector<float> pixels(std::size_t(width) * std::size_t(height));
        Imf::FrameBuffer buffer;
        buffer.insert(channel.name(),
                      Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(pixels.data()), sizeof(float),
                                 sizeof(float) * std::size_t(width)));
        exr.setFrameBuffer(buffer);
        exr.readPixels(0, height - 1);
        values += int(pixels.size());
        broken += int(std::count_if(pixels.begin(), pixels.end(),
                                    [](float value) { return !std::isfinite(value); }));
    }
    return {broken, values};
}

TEST(BadScenes, TexelsThatAreNoNumbersAreBlackAndNamed) {
    const TemporaryFolder folder;
    write_broken_environment(folder / "broken.exr");
    write_file(folder / "scene.json", scene_with(ball, R"({"file": "broken.exr"})"));
    const Outcome outcome =
        run_program("replay " + tiny_recording().string() + " --scene " +
                    (folder / "scene.json").string() + " --out " + (folder / "out").string() +
                    " --samples 4 --frames 0-1 --layers all --poses recorded"
                    " --set slam.fusion.voxel_size=0.02 --set slam.fusion.truncation=0.08");
    EXPECT_EQ(outcome.code, 0);
    EXPECT_THAT(outcome.err, HasSubstr("64 texels were not finite"));
    for (const char* name : {"exr/000000.exr", "exr/000001.exr"}) {
        const auto [broken, values] = count_broken_values(folder / "out" / name);
        EXPECT_EQ(broken, 0) << name;
        EXPECT_GE(values, 40 * 96 * 72) << name;  // all layers are there
    }
}

TEST(BadOptions, AreWrongUsage) {
    const TemporaryFolder folder;
    const std::vector<std::pair<std::string, std::string>> table = {
        {"--layers nonsense", "there is no layer 'nonsense'"},
        {"--layers E_R_dirct", "did you mean 'E_R_direct'"},
        {"--set nonsense=1", "there is no setting 'nonsense'"},
        {"--set slam.fusion.voxel_siz=1", "did you mean 'slam.fusion.voxel_size'"},
        {"--set slam.fusion.voxel_size=nan", "slam.fusion.voxel_size"},
        {"--shard 3/2", "--shard 3/2: expected I/N"},
        {"--frames 7", "0 to 5"},
    };
    for (const auto& [options, words] : table) {
        const Outcome outcome = replay(tiny_recording(), tiny_scene(), folder / "out", options);
        EXPECT_EQ(outcome.code, 2) << options;
        EXPECT_THAT(outcome.err, HasSubstr(words)) << options;
    }
    for (const char* samples : {"5", "0", "-4", "x"}) {
        const Outcome outcome = run_program("replay " + tiny_recording().string() + " --scene " +
                                            tiny_scene().string() + " --out " +
                                            (folder / "out").string() + " --samples " + samples);
        EXPECT_EQ(outcome.code, 2) << samples;
        EXPECT_THAT(outcome.err, HasSubstr("--samples")) << samples;
    }
    EXPECT_EQ(folder.entries(), 0);
}

TEST(BadOutput, APlaceThatCannotBeAFolder) {
    const TemporaryFolder folder;
    write_file(folder / "file", "kept");
    const Outcome outcome = replay(tiny_recording(), tiny_scene(), folder / "file" / "out");
    EXPECT_EQ(outcome.code, 73);
    EXPECT_THAT(outcome.err, AllOf(HasSubstr("file/out"), HasSubstr("Not a directory")));
    EXPECT_EQ(test::file_text(folder / "file"), "kept");
}

/// A limit of 32 KiB for a file plays the full disk: run.json and pictures are smaller, files with
/// all layers are not.
TEST(BadOutput, AFullDisk) {
    const TemporaryFolder folder;
    const std::string command = INLAY_PROGRAM " replay " + tiny_recording().string() + " --scene " +
                                tiny_scene().string() + " --out " + (folder / "out").string() +
                                test::coarse;
    const Outcome outcome =
        test::run_shell("trap '' XFSZ; ulimit -f 64; " + command + "--layers all");  // of 512 B
    EXPECT_EQ(outcome.code, 74);
    EXPECT_THAT(outcome.err, AllOf(HasSubstr("exr/000000.exr"), HasSubstr("free some space")));
    EXPECT_THAT(test::contents(folder / "out"), testing::ElementsAre(testing::Key("run.json")));
}

TEST(BadOutput, WithoutAnEncoderTheFramesStay) {
    const TemporaryFolder folder;
    const Outcome outcome = test::run_shell(
        "PATH= " INLAY_PROGRAM " replay " + tiny_recording().string() + " --scene " +
        tiny_scene().string() + " --out " + (folder / "out").string() + test::coarse +
        "--frames 0-1 --video " + (folder / "video.mp4").string());
    EXPECT_EQ(outcome.code, 73);
    EXPECT_THAT(outcome.err, AllOf(HasSubstr("video.mp4"), HasSubstr("install ffmpeg")));
    EXPECT_THAT(test::pictures(folder / "out"), SizeIs(4));
    EXPECT_FALSE(fs::exists(folder / "video.mp4"));
}

}  // namespace
}  // namespace inlay
