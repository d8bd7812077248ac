// Rays per second into the hemisphere over one surface map: the screen tracer, its exhaustive
// reference, and Embree's packets on the triangulated map.
#include "render/trace/screen_real_geometry.h"
#include "render/trace/screen_tracer.h"
#include "tests/support/screen_scenes.h"

#include <benchmark/benchmark.h>

#include <memory>
#include <vector>

namespace {

using namespace inlay;

constexpr float off_surface = 0.01f;  // m
constexpr int packets = 1 << 13;

/// The map, and packets of rays from 16 neighbouring pixels each, as the sampler sends them.
struct Setup {
    SurfaceMap map = test::map_of(test::table_room(), test::room_lens(640, 480));
    Image<Rgb> photo{640, 480, Rgb(1)};
    std::shared_ptr<const DepthPyramid> pyramid =
        std::make_shared<DepthPyramid>(make_depth_pyramid(map, {}));
    EmbreeSceneCache cache;
    EmbreeScene mesh =
        cache.place(std::make_shared<TriangleMesh>(triangulate({map, photo}, 0.05f)));
    std::vector<RayPacket> rays;

    Setup() {
        for (std::uint32_t p = 0; p < packets; ++p) {
            const SampleKey key{51, 0, p, 0};
            const int x0 = 4 * int(uniform(key, 0) * 160), y0 = 4 * int(uniform(key, 1) * 120);
            RayPacket packet;
            for (int lane = 0; lane < packet_width; ++lane) {
                const int x = x0 + lane % 4, y = y0 + lane / 4;
                if (!map.has_surface(x, y)) continue;
                const glm::vec3 n = map.normal(x, y);
                const SampleKey lane_key{52, 0, p, std::uint32_t(lane)};
                const glm::vec2 u{uniform(lane_key, 0), uniform(lane_key, 1)};
                packet.set(lane, map.position(x, y) + off_surface * n,
                           basis_about(n) * sample_cosine_hemisphere(u).direction);
            }
            rays.push_back(packet);
        }
    }
};

const Setup& setup() {
    static const Setup once;
    return once;
}

/// Calls `trace(packet)` for packet after packet.
template <class Trace>
void run(benchmark::State& state, const Trace& trace) {
    const Setup& s = setup();
    std::size_t next = 0;
    std::int64_t rays = 0;
    for (auto _ : state) {
        const RayPacket& packet = s.rays[next++ % packets];
        benchmark::DoNotOptimize(trace(packet));
        rays += __builtin_popcount(packet.active);
    }
    state.SetItemsProcessed(rays);
}

void screen_distances(benchmark::State& state) {
    const Setup& s = setup();
    const RealGeometry real = screen_real_geometry({s.map, s.photo}, s.pyramid, {});
    run(state, real.distances);
}

void embree_distances(benchmark::State& state) {
    const Setup& s = setup();
    const RealGeometry real = mesh_real_geometry({s.map, s.photo}, s.mesh, off_surface, 0.02f);
    run(state, real.distances);
}

void embree_occluded(benchmark::State& state) {
    run(state, [&](const RayPacket& packet) { return setup().mesh.occluded(packet); });
}

void screen_exhaustive(benchmark::State& state) {
    const Setup& s = setup();
    run(state, [&](const RayPacket& packet) {
        double sum = 0;
        for (int lane = 0; lane < packet_width; ++lane) {
            if (!packet.has(lane)) continue;
            const auto i = std::size_t(lane);
            sum += trace_screen_exhaustively(
                       *s.pyramid, {glm::dvec3(packet.origin[i]), glm::dvec3(packet.direction[i])})
                       .distance;
        }
        return sum;
    });
}

void build_pyramid(benchmark::State& state) {
    for (auto _ : state)
        benchmark::DoNotOptimize(make_depth_pyramid(setup().map, {}));
}

void build_mesh(benchmark::State& state) {
    const Setup& s = setup();
    EmbreeSceneCache cache;
    for (auto _ : state) {
        const auto mesh = std::make_shared<TriangleMesh>(triangulate({s.map, s.photo}, 0.05f));
        benchmark::DoNotOptimize(cache.place(mesh));
    }
}

BENCHMARK(screen_distances);
BENCHMARK(embree_distances);
BENCHMARK(embree_occluded);
BENCHMARK(screen_exhaustive);
BENCHMARK(build_pyramid)->Unit(benchmark::kMillisecond);
BENCHMARK(build_mesh)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
