// `inlay render` and `inlay record` as their user meets them.
#include "tests/support/program_runs.h"

#include <nlohmann/json.hpp>
#include <signal.h>

#include <chrono>
#include <functional>
#include <thread>

namespace inlay {
namespace {

namespace fs = std::filesystem;
using test::file_text;
using test::Outcome;
using test::run_program;
using test::TemporaryFolder;
using test::write_file;
using testing::AllOf;
using testing::HasSubstr;

/// A virtual ball on a real one under even light, seen at 48 x 36 px.
const std::string small_scene = R"({"version": 1, "environment": {"constant": [1, 1, 1]},
  "view": {"width": 48, "height": 36, "lens": [40, 40, 23.5, 17.5],
           "world_from_camera": [1,0,0,0, 0,-1,0,0, 0,0,-1,1, 0,0,0,1]},
  "objects": [
    {"name": "stone", "sphere": {"radius": 0.2}, "real": true,
     "transform": [1,0,0,0, 0,1,0,-0.2, 0,0,1,0, 0,0,0,1],
     "material": {"type": "diffuse", "reflectance": [0.5, 0.5, 0.5]}},
    {"name": "ball", "sphere": {"radius": 0.1},
     "transform": [1,0,0,0, 0,1,0,0.1, 0,0,1,0, 0,0,0,1],
     "material": {"type": "diffuse", "reflectance": [0.8, 0.2, 0.2]}}]})";

std::string without_view() {
    nlohmann::json scene = nlohmann::json::parse(small_scene);
    scene.erase("view");
    return scene.dump();
}

Outcome render(const fs::path& scene, const fs::path& out) {
    return run_program("render " + scene.string() + " --out " + out.string() +
                       " --samples 4 --photo-samples 4 --quiet --layers all");
}

Outcome record(const fs::path& scene, const fs::path& out, const std::string& options = "") {
    return run_program("record " + scene.string() + " --out " + out.string() +
                       " --length 2 --samples 4 --truth none --quiet " + options);
}

/// Interrupts the program as soon as `begun` says so; returns its exit code, -1 if a signal ended
/// it.
int interrupt_when(const std::vector<std::string>& arguments,
                   const std::function<bool(pid_t)>& begun) {
    const pid_t process = test::start_program(arguments);
    int status = 0;
    while (!begun(process) && ::waitpid(process, &status, WNOHANG) == 0)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    ::kill(process, SIGINT);
    ::waitpid(process, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/// Whether a process has a handler for SIGINT, as the kernel tells.
bool listens(pid_t process) {
    const std::string status = file_text("/proc/" + std::to_string(process) + "/status");
    const std::size_t at = status.find("SigCgt:");
    if (at == std::string::npos) return false;
    return (std::stoull(status.substr(at + 7), nullptr, 16) >> (SIGINT - 1)) & 1;
}

TEST(Render, GivesTheSameBytesTwice) {
    const TemporaryFolder folder;
    write_file(folder / "scene.json", small_scene);
    for (const char* name : {"a.exr", "b.exr", "a.png", "b.png"}) {
        const Outcome outcome = render(folder / "scene.json", folder / name);
        ASSERT_EQ(outcome.code, 0) << outcome.err;
    }
    EXPECT_GT(file_text(folder / "a.exr").size(), 1000u);
    EXPECT_TRUE(file_text(folder / "a.exr") == file_text(folder / "b.exr"));
    EXPECT_TRUE(file_text(folder / "a.png") == file_text(folder / "b.png"));
    EXPECT_EQ(folder.entries(), 5);
}

TEST(Render, RefusesWhatItCannotSeeOrWrite) {
    const TemporaryFolder folder;
    write_file(folder / "scene.json", small_scene);
    write_file(folder / "blind.json", without_view());
    const Outcome blind = render(folder / "blind.json", folder / "a.exr");
    EXPECT_EQ(blind.code, 65);
    EXPECT_THAT(blind.err, AllOf(HasSubstr("blind.json"), HasSubstr("add a 'view'")));
    const Outcome kind = render(folder / "scene.json", folder / "a.jpg");
    EXPECT_EQ(kind.code, 2);
    EXPECT_THAT(kind.err, AllOf(HasSubstr("a.jpg"), HasSubstr(".exr or .png")));
    EXPECT_EQ(render(folder / "none.json", folder / "a.exr").code, 66);
    EXPECT_EQ(render(folder / "scene.json", folder / "scene.json" / "a.exr").code, 73);
    EXPECT_EQ(folder.entries(), 2);
}

TEST(Render, SaysWhenItIsInterruptedAndWritesNothing) {
    const TemporaryFolder folder;
    write_file(folder / "scene.json", small_scene);
    const fs::path out = folder / "a.png";
    EXPECT_EQ(interrupt_when({"render", (folder / "scene.json").string(), "--out", out.string(),
                              "--samples", "4", "--photo-samples", "2000"},
                             listens),
              130);
    EXPECT_EQ(folder.entries(), 1);
}

TEST(Record, RefusesAFolderThatIsComplete) {
    const TemporaryFolder folder;
    write_file(folder / "scene.json", small_scene);
    ASSERT_EQ(record(folder / "scene.json", folder / "out").code, 0);
    const auto before = test::contents(folder / "out");
    EXPECT_TRUE(before.contains("record.json"));
    const Outcome again = record(folder / "scene.json", folder / "out", "--seed 2");
    EXPECT_EQ(again.code, 73);
    EXPECT_THAT(again.err, AllOf(HasSubstr("out"), HasSubstr("choose another --out")));
    EXPECT_TRUE(test::contents(folder / "out") == before);
}

TEST(Record, CompletesAFolderThatIsNot) {
    const TemporaryFolder folder;
    write_file(folder / "scene.json", small_scene);
    ASSERT_EQ(record(folder / "scene.json", folder / "out").code, 0);
    const auto before = test::contents(folder / "out");
    fs::remove(folder / "out/record.json");
    fs::remove(folder / "out/depth/000001.png");
    const Outcome again = record(folder / "scene.json", folder / "out");
    EXPECT_EQ(again.code, 0) << again.err;
    EXPECT_TRUE(test::contents(folder / "out") == before);
    EXPECT_EQ(run_program("info " + (folder / "out").string()).code, 0);
}

TEST(Record, StopsWhenInterruptedAndLeavesTheFolderIncomplete) {
    const TemporaryFolder folder;
    write_file(folder / "scene.json", small_scene);
    const fs::path out = folder / "out";
    const int code =
        interrupt_when({"record", (folder / "scene.json").string(), "--out", out.string(),
                        "--length", "400", "--samples", "16", "--truth", "none"},
                       [&](pid_t) { return fs::exists(out / "rgb/000001.png"); });
    EXPECT_EQ(code, 130);
    EXPECT_FALSE(fs::exists(out / "record.json"));
    EXPECT_TRUE(fs::exists(out / "rgb/000001.png"));
    EXPECT_FALSE(fs::exists(out / "rgb/000399.png"));
    for (const auto& [name, bytes] : test::contents(out))  // nothing is left in the making
        EXPECT_FALSE(fs::path(name).filename().string().starts_with(".")) << name;
}

TEST(Record, CopiesExactlyTheFilesOfTheScene) {
    const TemporaryFolder folder;
    const fs::path assets = folder / "assets", out = folder / "out";
    write_file(assets / "plate/plate.obj",
               "mtllib parts/plate.mtl\nv -0.3 0 0\nv 0.3 0 0\nv 0 0.3 0\nvt 0 0\nvt 1 0\nvt 0 1\n"
               "usemtl m\nf 1/1 2/2 3/3\n");
    write_file(assets / "plate/parts/plate.mtl",
               "newmtl m\nKd 1 1 1\nmap_Kd parts/pictures/plate.png\n");
    test::write_color(assets / "plate/parts/pictures/plate.png", 8, 8);
    test::write_color(assets / "plate/other.png", 8, 8);
    write_file(folder / "elsewhere/mesh.txt", "not of the scene");
    fs::create_symlink(folder / "elsewhere/mesh.txt", assets / "plate/parts/mesh.txt");
    fs::create_directory_symlink(assets / "plate", assets / "link");
    nlohmann::json scene = nlohmann::json::parse(small_scene);
    scene["objects"][0].erase("sphere");
    scene["objects"][0].erase("material");
    scene["objects"][0]["mesh"] = "link/plate.obj";
    write_file(folder / "scene.json", scene.dump());
    const Outcome first = record(folder / "scene.json", out, "--assets " + assets.string());
    ASSERT_EQ(first.code, 0) << first.err;
    const auto copied = test::contents(out);
    for (const char* name : {"plate.obj", "parts/plate.mtl", "parts/pictures/plate.png"}) {
        EXPECT_EQ(copied.at(std::string("link/") + name), file_text(assets / "plate" / name));
        EXPECT_FALSE(fs::is_symlink(out / "link" / name));
    }
    EXPECT_FALSE(copied.contains("link/other.png"));
    EXPECT_FALSE(copied.contains("link/parts/mesh.txt"));
    EXPECT_FALSE(fs::is_symlink(out / "link"));
    fs::remove_all(assets);  // the copy stands for itself
    const Outcome again = record(out / "scene.json", folder / "again");
    ASSERT_EQ(again.code, 0) << again.err;
    EXPECT_TRUE(file_text(folder / "again/rgb/000000.png") == copied.at("rgb/000000.png"));
}

TEST(Record, RefusesWhatItCannotFilm) {
    const TemporaryFolder folder;
    write_file(folder / "scene.json", small_scene);
    write_file(folder / "blind.json", without_view());
    const Outcome blind = record(folder / "blind.json", folder / "out");
    EXPECT_EQ(blind.code, 65);
    EXPECT_THAT(blind.err, AllOf(HasSubstr("blind.json"), HasSubstr("'view'")));
    EXPECT_EQ(record("nowhere", folder / "out").code, 66);
    for (const char* options : {"--length 0", "--size 0x5", "--size wide", "--truth 9"})
        EXPECT_EQ(record(folder / "scene.json", folder / "out", options).code, 2) << options;
    EXPECT_EQ(folder.entries(), 2);
}

TEST(Record, RefusesFramesThatDoNotExist) {
    const TemporaryFolder folder;
    const std::string out = " --length 1 --size 16x12 --samples 2 --out " + (folder / "r").string();
    EXPECT_EQ(run_program("record desk --frames 5" + out).code, 2);
    EXPECT_EQ(run_program("record desk --truth 7" + out).code, 2);
    EXPECT_EQ(folder.entries(), 0);
}

}  // namespace
}  // namespace inlay
