// The program run as a child, and a tiny recording that it made itself.
#pragma once

#include "tests/support/recording_folders.h"
#include "tests/support/temporary_folder.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

namespace inlay::test {

struct Outcome {
    int code = 0;  // of the exit; -1 where a signal ended the program
    std::string out, err;
};

/// Runs a line of shell, whose standard streams are taken.
inline Outcome run_shell(const std::string& line) {
    const TemporaryFolder folder;
    const std::string whole = "{ " + line + "; } >" + (folder / "out").string() + " 2>" +
                              (folder / "err").string() + " </dev/null";
    const int status = std::system(whole.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, file_text(folder / "out"),
            file_text(folder / "err")};
}

inline Outcome run_program(const std::string& arguments) {
    return run_shell(INLAY_PROGRAM " " + arguments);
}

/// Starts the program without waiting for it, at low priority, so that a test that watches it gets
/// its turn first. Returns the process, which the caller must wait for.
inline pid_t start_program(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), INLAY_PROGRAM);
    std::vector<char*> pointers;
    for (std::string& argument : arguments)
        pointers.push_back(argument.data());
    pointers.push_back(nullptr);
    const pid_t process = ::fork();
    if (process < 0) throw std::runtime_error("cannot fork");
    if (process > 0) return process;
    if (::nice(19) == -1) ::_exit(126);
    const int nowhere = ::open("/dev/null", O_RDWR);
    for (int stream = 0; stream < 3; ++stream)
        ::dup2(nowhere, stream);
    ::execv(pointers[0], pointers.data());
    ::_exit(127);
}

/// How every small run is made: few samples, voxels that suit few pixels.
inline const std::string coarse =
    " --quiet --samples 4 --set slam.fusion.voxel_size=0.02 --set slam.fusion.truncation=0.08 ";

/// Six frames of the desk at 96 x 72 px, recorded once per test program, at first use.
inline const std::filesystem::path& tiny_recording() {
    static const TemporaryFolder folder;
    static const std::filesystem::path recording = [] {
        const std::filesystem::path out = folder / "desk";
        const Outcome outcome =
            run_program("record desk --out " + out.string() +
                        " --length 6 --size 96x72 --samples 4 --truth none --quiet");
        if (outcome.code != 0) throw std::runtime_error("cannot record: " + outcome.err);
        return out;
    }();
    return recording;
}

inline std::filesystem::path tiny_scene() { return tiny_recording() / "scene.json"; }

/// A copy of the tiny recording, to be damaged.
inline std::filesystem::path copy_of_recording(const TemporaryFolder& folder) {
    const std::filesystem::path copy = folder / "recording";
    std::filesystem::copy(tiny_recording(), copy, std::filesystem::copy_options::recursive);
    return copy;
}

/// `replay` of a recording with a scene, coarsely.
inline Outcome replay(const std::filesystem::path& recording, const std::filesystem::path& scene,
                      const std::filesystem::path& out, const std::string& options = "") {
    return run_program("replay " + recording.string() + " --scene " + scene.string() + " --out " +
                       out.string() + coarse + options);
}

/// All files below a folder by their relative names; of a replay, those that must not vary.
inline std::map<std::string, std::string> contents(const std::filesystem::path& folder) {
    std::map<std::string, std::string> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
        if (entry.is_regular_file())
            files[entry.path().lexically_relative(folder).string()] = file_text(entry.path());
    return files;
}

inline std::map<std::string, std::string> pictures(const std::filesystem::path& replayed) {
    std::map<std::string, std::string> files = contents(replayed);
    std::erase_if(files, [](const auto& file) {
        return !file.first.starts_with("frames/") && !file.first.starts_with("exr/");
    });
    return files;
}

}  // namespace inlay::test
