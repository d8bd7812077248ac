// Which frames a shard holds, and what is done with each frame on the way.
#include "apps/inlay/frame_selection.h"

#include "recordings/base/check.h"

#include <gmock/gmock.h>

#include <numeric>

namespace inlay {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

std::vector<int> numbers(int count) {
    std::vector<int> frames(std::size_t(count), 0);
    std::iota(frames.begin(), frames.end(), 10);
    return frames;
}

std::vector<FrameWork> work_of(const std::vector<FrameTask>& tasks) {
    std::vector<FrameWork> work;
    for (const FrameTask& task : tasks)
        work.push_back(task.work);
    return work;
}

constexpr FrameWork track = FrameWork::track, sample = FrameWork::sample,
                    compose = FrameWork::compose;

TEST(ShardOf, WithoutAShardIsEverything) {
    EXPECT_EQ(shard_of(numbers(5), ""), numbers(5));
    EXPECT_EQ(shard_of(numbers(5), "1/1"), numbers(5));
}

TEST(ShardOf, CutsIntoRunsThatTogetherAreTheWhole) {
    for (const int frames : {0, 1, 5, 7, 100}) {
        for (const int shards : {1, 2, 3, 7, 11}) {
            std::vector<int> together;
            for (int i = 1; i <= shards; ++i) {
                const auto part =
                    shard_of(numbers(frames), std::to_string(i) + "/" + std::to_string(shards));
                // as equal as can be: their lengths differ by 1 at most
                EXPECT_GE(int(part.size()), frames / shards);
                EXPECT_LE(int(part.size()), (frames + shards - 1) / shards);
                together.insert(together.end(), part.begin(), part.end());
            }
            EXPECT_EQ(together, numbers(frames)) << frames << " in " << shards;
        }
    }
}

TEST(ShardOf, RefusesWhatIsNoShare) {
    for (const char* text : {"3/2", "0/2", "-1/2", "1/0", "1", "1/", "/2", "1/2x", "1/2/3", "a/b",
                             "1.5/2", "4294967297/4294967298"}) {
        try {
            shard_of(numbers(5), text);
            ADD_FAILURE() << text;
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), ExitCode::usage) << text;
            EXPECT_THAT(error.what(), testing::HasSubstr(text));
        }
    }
}

TEST(PlanFrames, TracksUpToTheLastFrameAndNoFarther) {
    const auto tasks = plan_frames({0, 1, 2, 3, 4}, {2}, false);
    EXPECT_THAT(work_of(tasks), ElementsAre(track, track, compose));
    EXPECT_EQ(tasks[2].frame, 2);
}

TEST(PlanFrames, SamplesTheFrameBeforeForTheTemporalFilter) {
    EXPECT_THAT(work_of(plan_frames({0, 1, 2, 3, 4}, {2, 4}, true)),
                ElementsAre(track, sample, compose, sample, compose));
    EXPECT_THAT(work_of(plan_frames({0, 1, 2}, {0, 1, 2}, true)),
                ElementsAre(compose, compose, compose));
    EXPECT_THAT(work_of(plan_frames({0, 1}, {0}, true)), ElementsAre(compose));
}

TEST(PlanFrames, TheFrameBeforeIsTheRecordingsOwn) {  // numbers may have gaps
    const auto tasks = plan_frames({3, 10, 12, 40}, {12}, true);
    EXPECT_THAT(work_of(tasks), ElementsAre(track, sample, compose));
    EXPECT_EQ(tasks[1].frame, 10);
}

TEST(PlanFrames, DoesNotDependOnTheOrderOfTheChosen) {
    EXPECT_THAT(work_of(plan_frames({0, 1, 2}, {2, 0}, false)),
                ElementsAre(compose, track, compose));
}

TEST(PlanFrames, NothingChosenIsNothingToDo) {
    EXPECT_THAT(plan_frames({0, 1, 2}, {}, true), IsEmpty());
}

}  // namespace
}  // namespace inlay
