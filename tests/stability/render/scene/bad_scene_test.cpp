// Bad scene files: each refused with the right exit code and a message that names the place; random
// damage never does worse.
#include "recordings/base/check.h"
#include "recordings/base/random.h"
#include "render/scene/scene_file.h"
#include "tests/support/temporary_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

namespace inlay {
namespace {

namespace fs = std::filesystem;
using test::TemporaryFolder;
using testing::HasSubstr;

struct BadScene {
    std::string text;
    std::vector<std::string> words;  // all of which the message holds
    ExitCode code = ExitCode::bad_data;
};

const std::string light = R"("environment": {"constant": [1,1,1]})";
const std::string at = R"("transform": [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1])";

std::string scene(const std::string& members) { return R"({"version": 1, )" + members + "}"; }

std::string object(const std::string& members) {
    return scene(light + R"(, "objects": [{)" + members + "}]");
}

std::string sphere(const std::string& members) {
    return object(R"("name": "a", "sphere": {"radius": 0.1}, )" + members);
}

void expect_refused(const BadScene& bad) {
    const TemporaryFolder folder;
    std::ofstream(folder / "s.json") << bad.text;
    try {
        load_scene_file(folder / "s.json");
        ADD_FAILURE() << "accepted: " << bad.text;
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), bad.code) << error.what();
        EXPECT_THAT(error.what(), HasSubstr("s.json"));
        for (const std::string& word : bad.words)
            EXPECT_THAT(error.what(), HasSubstr(word));
    }
}

TEST(BadScene, SyntaxIsRefusedWithLineAndColumn) {
    for (const BadScene& bad :
         std::vector<BadScene>{{"", {"line 1"}},
                               {"{\n  \"version\": 1,\n  \"x\" 3 }", {"line 3, column 7"}},
                               {"{\"version\": 1", {"line 1"}},
                               {R"({"version": 1, "version": 1})", {"\"version\"", "twice"}},
                               {R"({"version": 1e999})", {"out of range"}},
                               {std::string(100000, '['), {"deeper"}},
                               {"{\"version\": NaN}", {"line 1"}},
                               {"\xff\xfe{}", {"line 1"}}})
        expect_refused(bad);
}

TEST(BadScene, KeysAndVersionsAreChecked) {
    for (const BadScene& bad : std::vector<BadScene>{
             {"[]", {"an array", "an object"}},
             {"{}", {"no \"version\""}},
             {R"({"version": 2})", {"version", "found 2"}},
             {R"({"version": "1"})", {"version", "a number"}},
             {scene(R"("enviroment": {})"), {"enviroment", "did you mean \"environment\""}},
             {scene(R"("objects": [])"), {"no \"environment\""}},
             {object(R"("name": "a", "spere": {"radius": 1})"), {"objects[0].spere", "\"sphere\""}},
             {sphere(at + R"(, "materal": {})"), {"objects[0].materal", "\"material\""}},
             {sphere(at + R"(, "material": {"type": "difuse"})"),
              {"objects[0].material.type", "\"diffuse\""}},
             {sphere(at + R"(, "material": {"type": "phong", "exponet": 3})"),
              {"objects[0].material.exponet", "\"exponent\""}},
             {scene(light + R"(, "objects": {})"), {"objects", "an array"}},
             {scene(light + R"(, "objects": [3])"), {"objects[0]", "an object"}}})
        expect_refused(bad);
}

const std::string polygon_light =
    R"({"polygon": [[0, 1, 0], [1, 1, 0], [0, 1, 1]], "radiance": [1, 1, 1]})";

TEST(BadScene, WhatAsksForNothingIsNoReasonToRefuse) {
    const TemporaryFolder folder;
    std::ofstream(folder / "s.json")
        << scene(light + R"(, "lights": [], "medium": {"scattering": [0, 0, 0], "g": 0.3},)" +
                 R"("camera": {"aperture_radius": 0, "shutter": 0})");
    const SceneRequests asked = load_scene_file(folder / "s.json").requests;
    EXPECT_EQ(asked.polygon_lights + asked.mesh_lights, 0);
    EXPECT_FALSE(asked.medium);
}

TEST(BadScene, WhatIsOnlyExplainedIsListed) {
    const TemporaryFolder folder;
    std::ofstream(folder / "s.json")
        << scene(light + R"(, "lights": [)" + polygon_light + R"(], "medium": {)" +
                 R"("absorption": [0, 0, 1]}, "camera": {"aperture_radius": 0.004,)" +
                 R"("focus_distance": 0.8, "shutter": 0.02})");
    const SceneRequests asked = load_scene_file(folder / "s.json", {}, SceneUse::explain).requests;
    EXPECT_EQ(asked.polygon_lights, 1);
    EXPECT_EQ(asked.mesh_lights, 0);
    EXPECT_TRUE(asked.medium);
    EXPECT_EQ(asked.aperture_radius, 0.004);
    EXPECT_EQ(asked.focus_distance, 0.8);
    EXPECT_EQ(asked.shutter, 0.02);
}

TEST(BadScene, LightsMediaAndCamerasAreChecked) {
    for (const BadScene& bad : std::vector<BadScene>{
             {scene(light + R"(, "lights": {})"), {"lights", "an array"}},
             {scene(light + R"(, "lights": [{"radiance": [1, 1, 1]}])"), {"lights[0]", "no shape"}},
             {scene(light + R"(, "lights": [{"polygon": [[0, 0, 0]], "radiance": [1, 1, 1]}])"),
              {"lights[0].polygon", "three corners"}},
             {scene(light + R"(, "lights": [{"mesh": "../a.obj", "radiance": [1, 1, 1]}])"),
              {"lights[0].mesh", ".."}},
             {scene(light + R"(, "medium": {"scatering": [1, 1, 1]})"),
              {"medium.scatering", "\"scattering\""}},
             {scene(light + R"(, "medium": {"scattering": [1, -1, 1]})"),
              {"medium.scattering[1]", "-1"}},
             {scene(light + R"(, "camera": {"shutter": -1})"), {"camera.shutter", "-1"}},
             {scene(light + R"(, "camera": {"aperture_radius": 0.1})"),
              {"camera", "\"focus_distance\""}}})
        expect_refused(bad);
}

TEST(BadScene, WhatCannotBeDoneYetIsSaid) {
    for (const BadScene& bad : std::vector<BadScene>{
             {scene(light + R"(, "lights": [)" + polygon_light + "]"),
              {"s.json: lights", "(polygon_light) cannot be done by this version"}},
             {scene(light + R"(, "medium": {"scattering": [1, 1, 1]})"),
              {"s.json: medium", "(medium) cannot be done by this version"}},
             {scene(light + R"(, "camera": {"aperture_radius": 0.01, "focus_distance": 1})"),
              {"s.json: camera", "(defocus) cannot be done by this version"}},
             {scene(light + R"(, "camera": {"shutter": 0.02})"),
              {"s.json: camera", "(motion_blur) cannot be done by this version"}},
             {scene(R"("environment": {"estimate": true})"),
              {"environment.estimate", "this version"}},
             {scene(R"("environment": {"mirrored_ball": "b.png"})"),
              {"environment.mirrored_ball", "this version"}}})
        expect_refused(bad);
}

TEST(BadScene, NumbersAreChecked) {
    for (
        const BadScene& bad : std::vector<BadScene>{
            {object(R"("name": "a", "sphere": {"radius": -0.1}, )" + at),
             {"objects[0].sphere.radius", "-0.1"}},
            {object(R"("name": "a", "sphere": {"radius": "big"}, )" + at),
             {"objects[0].sphere.radius", "a number"}},
            {sphere(at + R"(, "material": {"type": "diffuse", "reflectance": [0.1, 1.5, 0]})"),
             {"objects[0].material.reflectance[1]", "1.5", "0 to 1"}},
            {sphere(at + R"(, "material": {"type": "diffuse", "reflectance": [0.1, 0.5]})"),
             {"objects[0].material.reflectance", "an array of 2", "3 numbers"}},
            {sphere(at + R"(, "material": {"type": "phong", "exponent": 0})"),
             {"objects[0].material.exponent", "1 to 10000"}},
            {sphere(
                 at +
                 R"(, "material": {"type": "phong", "diffuse": [0.6,0,0], "specular": [0.6,0,0]})"),
             {"objects[0].material", "diffuse + specular"}},
            {sphere(at + R"(, "material": {"type": "ggx", "roughness": [0.1, 0.2, 0.3]})"),
             {"objects[0].material.roughness", "2 numbers"}},
            {scene(R"("environment": {"constant": [1, -1, 1]})"), {"environment.constant[1]"}},
            {scene(R"("environment": {})"), {"environment", "\"constant\""}},
            {scene(R"("environment": {"constant": [1,1,1], "ambient": [1,1,1]})"),
             {"environment", "one of"}},
            {scene(
                 R"("environment": {"lobes": [{"direction": [0,0,0], "sharpness": 1, "radiance": [1,1,1]}]})"),
             {"environment.lobes[0].direction", "length 0"}},
            {scene(
                 R"("environment": {"constant": [1,1,1], "world_from_environment": [1,0,0, 0,1,0, 0,0,-1]})"),
             {"environment.world_from_environment", "rotation"}}})
        expect_refused(bad);
}

TEST(BadScene, PositionsAreChecked) {
    const std::string shear = R"("transform": [1,0.5,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1])";
    const std::string mirror = R"("transform": [1,0,0,0, 0,1,0,0, 0,0,-1,0, 0,0,0,1])";
    const std::string flat = R"("transform": [1,0,0,0, 0,1,0,0, 0,0,0,0, 0,0,0,1])";
    const std::string row = R"("transform": [1,0,0,0, 0,1,0,0, 0,0,1,0, 1,0,0,1])";
    const std::string uneven = R"("transform": [2,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1])";
    const std::string back = R"("motion": [{"time": 1, )" + at + R"(}, {"time": 1, )" + at + "}]";
    for (const BadScene& bad : std::vector<BadScene>{
             {sphere(shear), {"objects[0].transform", "shear"}},
             {sphere(mirror), {"objects[0].transform", "mirroring"}},
             {sphere(flat), {"objects[0].transform", "flattens"}},
             {sphere(row), {"objects[0].transform", "last row"}},
             {sphere(uneven), {"objects[0]", "unevenly"}},
             {sphere(R"("transform": [1,2])"), {"objects[0].transform", "16 numbers"}},
             {sphere(back), {"objects[0].motion[1].time", "after"}},
             {sphere(R"("motion": [])"), {"objects[0].motion", "at least one"}},
             {sphere(R"("real": true)"), {"objects[0]", "\"place\", \"transform\" or \"motion\""}},
             {sphere(R"("place": {"pixel": [1, 2]}, )" + at), {"objects[0].transform", "place"}},
             {sphere(R"("place": {"pixel": [1, 2]}, "motion": [{"time": 0, )" + at + "}]"),
              {"objects[0].motion", "relative_to"}},
             {sphere(R"("motion": {"relative_to": "place", "keyframes": []})"),
              {"objects[0].motion", "\"place\""}},
             {sphere(R"("place": {"pixel": [1.5, 2]})"), {"objects[0].place.pixel[0]", "whole"}},
             {sphere(R"("place": {"pixel": [-1, 2]})"), {"objects[0].place.pixel[0]"}},
             {sphere(R"("place": {"pixel": [1, 2], "align": "norml"})"),
              {"objects[0].place.align", "\"normal\""}},
             {sphere(R"("place": {"frame": -1, "pixel": [1, 2]})"), {"objects[0].place.frame"}},
             {sphere(at + R"(, "scale": 2)"), {"objects[0].scale", "radius"}},
             {object(R"("name": "a", )" + at), {"objects[0]", "no shape"}},
             {object(R"("sphere": {"radius": 1}, )" + at), {"objects[0]", "no \"name\""}},
             {scene(light + R"(, "objects": [{"name": "a", "sphere": {"radius": 1}, )" + at +
                    R"(}, {"name": "a", "sphere": {"radius": 1}, )" + at + "}]"),
              {"objects[1].name", "second \"a\""}}})
        expect_refused(bad);
}

TEST(BadScene, ViewsAreChecked) {
    const std::string camera = R"("world_from_camera": [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1])";
    const std::string scaled = R"("world_from_camera": [2,0,0,0, 0,2,0,0, 0,0,2,0, 0,0,0,1])";
    const auto view = [&](const std::string& lens, const std::string& pose) {
        return scene(light + R"(, "view": {"width": 4, "height": 4, "lens": )" + lens + ", " +
                     pose + "}");
    };
    for (const BadScene& bad : std::vector<BadScene>{
             {view("[0, 1, 1, 1]", camera), {"view.lens", "focal length"}},
             {view("[1, 1, 1]", camera), {"view.lens", "4 numbers"}},
             {view("[1, 1, 1, 1]", scaled), {"view.world_from_camera", "rotation"}},
             {view("[1, 1, 1, 1]", R"("up": [0,0,1])"), {"view", "no \"world_from_camera\""}},
             {scene(light + R"(, "path": [{"time": 1, )" + camera + R"(}, {"time": 0, )" + camera +
                    "}]"),
              {"path[1].time", "after"}}})
        expect_refused(bad);
}

TEST(BadScene, FilesOutsideTheFoldersAreRefused) {
    const auto mesh = [](const std::string& name) {
        return object(R"("name": "a", "mesh": ")" + name + R"(", )" + at);
    };
    for (const BadScene& bad : std::vector<BadScene>{
             {mesh("/etc/hostname"), {"objects[0].mesh", "absolute"}},
             {mesh("../a.obj"), {"objects[0].mesh", ".."}},
             {mesh("x/../../a.obj"), {"objects[0].mesh", ".."}},
             {mesh(""), {"objects[0].mesh", "empty"}},
             {mesh("none.obj"),
              {"objects[0].mesh", "none.obj", "--assets"},
              ExitCode::input_missing},
             {scene(R"("environment": {"file": "/dev/zero"})"), {"environment.file", "absolute"}},
             {sphere(at + R"(, "material": {"type": "diffuse", "texture": "../t.png"})"),
              {"objects[0].material.texture", ".."}}})
        expect_refused(bad);
}

TEST(BadScene, ALinkThatLeadsOutIsRefused) {
    const TemporaryFolder outside, folder;
    std::ofstream(outside / "t.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    fs::create_symlink(outside / "t.obj", folder / "t.obj");
    std::ofstream(folder / "s.json") << object(R"("name": "a", "mesh": "t.obj", )" + at);
    EXPECT_THROW(load_scene_file(folder / "s.json"), Error);
    const SceneFile allowed = load_scene_file(folder / "s.json", {outside.path()});
    EXPECT_EQ(allowed.entries.size(), 1u);
    EXPECT_THROW(load_scene_file(folder / "s.json", {folder / "none"}), Error);
    EXPECT_THROW(load_scene_file(folder / "none.json"), Error);
}

const std::string valid = R"({ "version": 1,
  "environment": {"ambient": [0.1, 0.2, 0.3], "lobes": [{"direction": [1,2,3], "sharpness": 40, "radiance": [4,5,6]}],
                  "rotate_deg": 30, "scale": 1.5},
  "objects": [
    {"name": "cow", "mesh": "m.obj", "scale": 0.2, "up_axis": "z", "place": {"frame": 0, "pixel": [310, 290],
     "turn_deg": 40, "align": "normal"}, "material": {"type": "ggx", "base_color": [0.1,0.2,0.3], "roughness": 0.5}},
    {"name": "ball", "sphere": {"radius": 0.05}, "real": true,
     "motion": [{"time": 0.0, "transform": [1,0,0,0.2, 0,1,0,0.1, 0,0,1,1.2, 0,0,0,1]},
                {"time": 2.0, "transform": [1,0,0,0.2, 0,1,0,0.1, 0,0,1,1.2, 0,0,0,1]}],
     "material": {"type": "phong", "diffuse": [0.1,0.1,0.1], "specular": [0.8,0.8,0.8], "exponent": 64}}],
  "view": {"width": 640, "height": 480, "lens": [500, 500, 320, 240], "up": [0,0,1],
           "world_from_camera": [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]} })";

/// One to four random edits: a byte replaced, removed, doubled, or a piece copied elsewhere.
std::string damaged(std::string text, std::uint32_t seed) {
    const auto number = [&](std::uint32_t dimension, std::size_t bound) {
        return std::size_t(uniform({seed, 0, 0, 0}, dimension) * float(bound));
    };
    const std::string letters = "{}[]\",:0123456789-+.eEnatrufls\\ \x80";
    const std::size_t edits = 1 + number(0, 4);
    for (std::size_t e = 0; e < edits; ++e) {
        const auto base = std::uint32_t(10 * e);
        const std::size_t where = number(base + 1, text.size());
        switch (number(base + 2, 4)) {
            case 0:
                text[where] = letters[number(base + 3, letters.size())];
                break;
            case 1:
                text.erase(where, 1 + number(base + 3, 8));
                break;
            case 2:
                text.insert(where, 1, letters[number(base + 3, letters.size())]);
                break;
            default:
                text.insert(where,
                            text.substr(number(base + 3, text.size()), number(base + 4, 40)));
        }
    }
    return text;
}

TEST(BadScene, RandomDamageIsReadOrRefusedAndNothingElse) {
    const TemporaryFolder folder;
    std::ofstream(folder / "m.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0.5\nf 1 2 3\n";
    std::ofstream(folder / "s.json") << valid;
    ASSERT_EQ(load_scene_file(folder / "s.json").entries.size(), 2u);
    int read = 0, refused = 0;
    for (std::uint32_t seed = 0; seed < 1500; ++seed) {
        std::ofstream(folder / "s.json", std::ios::binary) << damaged(valid, seed);
        try {
            load_scene_file(folder / "s.json");
            ++read;
        } catch (const Error& error) {
            ++refused;
            EXPECT_THAT(error.what(), HasSubstr(folder.path().string()));
        }  // anything else fails the test
    }
    EXPECT_GT(read, 10);
    EXPECT_GT(refused, 500);
}

}  // namespace
}  // namespace inlay
