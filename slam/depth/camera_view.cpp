#include "slam/depth/camera_view.h"

#include "recordings/base/parallel.h"

#include <array>
#include <deque>
#include <mutex>

namespace inlay {
namespace {

constexpr std::size_t tables_kept = 24;  // a few lenses, each with its pyramid

using Numbers = std::array<double, 11>;

Numbers numbers_of(const Lens& l) {
    return {
        double(l.width), double(l.height), l.fx, l.fy, l.cx, l.cy, l.k1, l.k2, l.k3, l.p1, l.p2};
}

CameraView make_view(const Lens& lens) {
    auto rays = std::make_shared<Image<glm::vec3>>(lens.width, lens.height);
    parallel_rows(lens.height, [&](int y) {
        for (int x = 0; x < lens.width; ++x)
            (*rays)(x, y) = glm::vec3(unproject(lens, {x, y}));
    });
    CameraView view{lens, distorted(lens), rays, glm::vec2(0), glm::vec2(0)};
    const float half_x = float(std::abs(0.5 / lens.fx)), half_y = float(std::abs(0.5 / lens.fy));
    for (const glm::vec3& ray : rays->pixels) {
        view.lowest = glm::min(view.lowest, glm::vec2(ray.x - half_x, ray.y - half_y));
        view.highest = glm::max(view.highest, glm::vec2(ray.x + half_x, ray.y + half_y));
    }
    return view;
}

}  // namespace

SeenAt CameraView::pixels_of(const Vectors& p) const {
    Lanes seen = p.z > 0;
    const Floats z = choose(seen, p.z, 1), x = p.x / z, y = p.y / z;
    seen = seen && x >= lowest.x && x <= highest.x && y >= lowest.y && y <= highest.y;
    Floats column = float(lens.fx) * x + float(lens.cx), row = float(lens.fy) * y + float(lens.cy);
    for (std::size_t lane = 0; bent && lane < lane_count; ++lane) {
        if (!seen[lane]) continue;
        const glm::vec2 at(project(lens, {x[lane], y[lane], 1.0}));
        column[lane] = at.x;
        row[lane] = at.y;
    }
    column = stdx::floor(column + 0.5f);
    row = stdx::floor(row + 0.5f);
    seen =
        seen && column >= 0 && row >= 0 && column < float(lens.width) && row < float(lens.height);
    const Ints pixel = stdx::static_simd_cast<Ints>(choose(seen, row, 0)) * lens.width +
                       stdx::static_simd_cast<Ints>(choose(seen, column, 0));
    return {seen, numbers_of(pixel)};
}

CameraView camera_view(const Lens& lens) {
    static std::mutex mutex;
    static std::deque<std::pair<Numbers, CameraView>> kept;
    const Numbers key = numbers_of(lens);
    {
        const std::lock_guard lock(mutex);
        for (const auto& [numbers, view] : kept) {
            if (numbers == key) return view;
        }
    }
    CameraView view = make_view(lens);  // outside the lock: it uses threads itself
    const std::lock_guard lock(mutex);
    kept.emplace_front(key, view);
    if (kept.size() > tables_kept) kept.pop_back();
    return view;
}

}  // namespace inlay
