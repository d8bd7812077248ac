// Filming a scene: frames do not depend on each other, and a request to stop is obeyed.
#include "composite/record/record_scene.h"

#include "tests/support/tabletop.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

namespace inlay {
namespace {

namespace fs = std::filesystem;
using test::TemporaryFolder;

FilmedScene small_film() {
    FilmedScene film;
    film.scene = test::tabletop();
    SceneObject roller = test::ball("roller", {0, 0.1, 0.2}, 0.1f, Diffuse{}, true);
    roller.motion.push_back({1.0, glm::translate(glm::dmat4(1), glm::dvec3(0.3, 0.1, 0.2))});
    film.scene.objects.push_back(roller);
    film.environment = test::soft_light();
    film.lens = {32, 24, 30, 30, 15.5, 11.5};
    film.camera = [](double time) { return test::camera_around(0.1 * time); };
    return film;
}

RecordSettings quick(int frames) {
    RecordSettings settings;
    settings.frames = frames;
    settings.samples = settings.truth_samples = 2;
    return settings;
}

TEST(FilmFrame, IsTheSameWhateverWasFilmedBefore) {
    const FilmedScene film = small_film();
    FilmSet used = prepare_film(film), fresh = prepare_film(film);
    film_frame(used, quick(30), 0);
    film_frame(used, quick(30), 7);
    const RecordedFrame after = film_frame(used, quick(30), 20);
    const RecordedFrame alone = film_frame(fresh, quick(30), 20);
    EXPECT_EQ(after.color.pixels, alone.color.pixels);
    EXPECT_EQ(after.depth.pixels, alone.depth.pixels);
    EXPECT_NE(after.depth.pixels, film_frame(used, quick(30), 0).depth.pixels);
}

TEST(RecordScene, FinishesWhatIsWanted) {
    const TemporaryFolder folder;
    RecordSettings settings = quick(4);
    settings.written_frames = {1, 3};
    std::vector<int> finished;
    EXPECT_EQ(record_scene(small_film(), settings, folder.path(),
                           {[&](int done) { finished.push_back(done); }, {}})
                  .finished,
              2);
    EXPECT_EQ(wanted_frames(settings), 2);
    EXPECT_EQ(finished, (std::vector<int>{1, 2}));
    EXPECT_FALSE(fs::exists(folder / "rgb/000000.png"));
    EXPECT_TRUE(fs::exists(folder / "rgb/000003.png"));
}

TEST(RecordScene, StopsBetweenFramesAndBetweenThePassesOfOne) {
    // asked before frame 0, before each of its two truth pictures, before frame 1, ...
    for (int answer = 1; answer <= 5; ++answer) {
        const TemporaryFolder folder;
        int asked = 0;
        const int finished = record_scene(small_film(), quick(3), folder.path(),
                                          {{}, [&] { return ++asked == answer; }})
                                 .finished;
        EXPECT_EQ(asked, answer);
        EXPECT_EQ(finished, std::max(0, answer - 3)) << answer;
        EXPECT_EQ(fs::exists(folder / "rgb/000000.png"), answer > 1);
        EXPECT_EQ(fs::exists(folder / "truth/recorded/000000.exr"), answer > 2);
        EXPECT_EQ(fs::exists(folder / "truth/composite/000000.exr"), answer > 3);
        EXPECT_EQ(fs::exists(folder / "rgb/000001.png"), answer > 4);
    }
}

TEST(RecordScene, CountsSamplesThatAreNotFinite) {
    const TemporaryFolder folder, other;
    FilmedScene film = small_film();
    EXPECT_EQ(record_scene(film, quick(1), folder.path()).dropped_samples, 0u);
    // a bright surface under the brightest light there is sends back more than a float holds
    film.environment.radiance.pixels.assign(film.environment.radiance.pixels.size(), Rgb(1e38f));
    EXPECT_GT(record_scene(film, quick(1), other.path()).dropped_samples, 0u);
}

}  // namespace
}  // namespace inlay
