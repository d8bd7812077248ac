// Runs of `inlay accuracy` that are interrupted, repeated or damaged: what was measured stays, and
// only the same run goes on.
#include "tests/support/accuracy_runs.h"

#include <signal.h>

#include <chrono>
#include <functional>
#include <set>
#include <thread>

namespace inlay {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::accuracy;
using test::ball;
using test::contents;
using test::file_text;
using test::Outcome;
using test::TemporaryFolder;
using testing::AllOf;
using testing::HasSubstr;
using testing::SizeIs;

/// A run from its start to its end; made once.
const fs::path& whole_run() {
    static const TemporaryFolder folder;
    static const fs::path out = [] {
        const Outcome outcome = accuracy(ball(), folder / "out", "--quiet --repeat 3");
        if (outcome.code != 0) throw std::runtime_error("cannot measure: " + outcome.err);
        return folder / "out";
    }();
    return out;
}

/// Removes what times decide, and the date, at every depth.
void remove_times(json& value) {
    static const std::set<std::string> of_time{"date",    "ms",     "wall_ms",     "cpu_ms",
                                               "peak_mb", "fronts", "equal_error", "equal_time"};
    if (value.is_object())
        for (const std::string& key : of_time)
            value.erase(key);
    for (json& child : value)
        if (child.is_structured()) remove_times(child);
}

json timeless(const fs::path& out) {
    json report = test::report_of(out);
    remove_times(report);
    return report;
}

TEST(AccuracyResume, RefusesAFolderThatHoldsARun) {
    const auto before = contents(whole_run());
    const Outcome again = accuracy(ball(), whole_run(), "--quiet --repeat 3");
    EXPECT_EQ(again.code, 2);
    EXPECT_THAT(again.err, HasSubstr("--resume"));
    const Outcome other =
        accuracy(ball(), whole_run(), "--quiet --repeat 3 --resume --set filter.kernel_radius=4");
    EXPECT_EQ(other.code, 2);
    EXPECT_THAT(other.err, AllOf(HasSubstr("run.json"),
                                 HasSubstr("filter.kernel_radius was \"15\" and is \"4\"")));
    const Outcome fewer = accuracy(ball(), whole_run(), "--quiet --repeat 2 --resume");
    EXPECT_EQ(fewer.code, 2);
    EXPECT_THAT(fewer.err, HasSubstr("repeats was 3 and is 2"));
    EXPECT_TRUE(contents(whole_run()) == before);
}

/// Interrupts a run as soon as its first measurement is kept; returns the exit code.
int interrupt_after_first_unit(const fs::path& out) {
    std::vector<std::string> arguments = test::arguments_for(ball(), out);
    for (const char* more : {"--quiet", "--repeat", "3"})
        arguments.emplace_back(more);
    const pid_t process = test::start_program(std::move(arguments));
    int status = 0;
    while (!fs::exists(out / "units/ball.samples=4.0.json") &&
           ::waitpid(process, &status, WNOHANG) == 0)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    ::kill(process, SIGINT);
    ::waitpid(process, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(AccuracyResume, GoesOnAfterAnInterrupt) {
    const TemporaryFolder folder;
    const fs::path out = folder / "out";
    EXPECT_EQ(interrupt_after_first_unit(out), 130);
    EXPECT_FALSE(fs::exists(out / "accuracy.json"));
    const auto kept = contents(out / "units");
    EXPECT_THAT(kept, AllOf(SizeIs(testing::Ge(1u)), SizeIs(testing::Lt(9u))));
    const Outcome resumed = accuracy(ball(), out, "--quiet --repeat 3 --resume");
    ASSERT_EQ(resumed.code, 0) << resumed.err;
    const auto all = contents(out / "units");
    EXPECT_THAT(all, SizeIs(9));
    for (const auto& [name, bytes] : kept)
        EXPECT_TRUE(all.at(name) == bytes) << name;
    EXPECT_EQ(timeless(out), timeless(whole_run()));
}

/// The message that refuses to go on with the run after `change`.
std::string refusal_after(const std::function<void(const fs::path& work)>& change) {
    const TemporaryFolder folder;
    const fs::path work = folder / "ball";
    fs::copy(ball(), work, fs::copy_options::recursive);
    const std::string options = "--quiet --only split";
    const Outcome first = accuracy(work, folder / "out", options);
    EXPECT_EQ(first.code, 0) << first.err;
    EXPECT_EQ(accuracy(work, folder / "out", options + " --resume").code, 0);
    change(work);
    const Outcome again = accuracy(work, folder / "out", options + " --resume");
    EXPECT_EQ(again.code, 2);
    return again.err;
}

TEST(AccuracyResume, RefusesAWorkWhoseContentsHaveChanged) {
    const std::string truth = refusal_after([](const fs::path& work) {
        const fs::path file = work / "truth/composite/000001.exr";
        std::string bytes = file_text(file);
        bytes.back() = char(bytes.back() ^ 1);  // the size stays
        test::write_file(file, bytes);
    });
    EXPECT_THAT(truth, AllOf(HasSubstr("works ball contents truth was"), HasSubstr("--out")));
    const std::string scene = refusal_after([](const fs::path& work) {
        std::string text = file_text(work / "scene.json");
        text.replace(text.find("0.9"), 3, "0.8");
        test::write_file(work / "scene.json", text);
    });
    EXPECT_THAT(scene, HasSubstr("works ball contents"));
    const std::string files = refusal_after(
        [](const fs::path& work) { test::write_file(work / "rgb/notes.txt", "new"); });
    EXPECT_THAT(files, HasSubstr("works ball contents files was"));
}

TEST(AccuracyResume, NamesADamagedMeasurement) {
    const TemporaryFolder folder;
    fs::copy(whole_run(), folder / "out", fs::copy_options::recursive);
    const std::string name = "units/ball.samples=16.1.json";
    test::write_file((folder / "out") / name, file_text(folder / "out" / name).substr(0, 100));
    const Outcome outcome = accuracy(ball(), folder / "out", "--quiet --repeat 3 --resume");
    EXPECT_EQ(outcome.code, 65);
    EXPECT_THAT(outcome.err, AllOf(HasSubstr(name), HasSubstr("delete the file")));
    fs::remove((folder / "out") / name);
    EXPECT_EQ(accuracy(ball(), folder / "out", "--quiet --repeat 3 --resume").code, 0);
    EXPECT_EQ(timeless(folder / "out"), timeless(whole_run()));
}

}  // namespace
}  // namespace inlay
