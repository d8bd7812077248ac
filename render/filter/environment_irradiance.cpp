// The table is summed once per map, from texels gathered into parcels of one direction each.
#include "render/filter/environment_irradiance.h"

#include "recordings/base/check.h"
#include "recordings/base/parallel.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace inlay {
namespace {

constexpr int columns = 128, rows = 65;  // of the table
constexpr double pi = std::numbers::pi;

/// Light from a part of the sphere.
struct Parcel {
    glm::dvec3 power{0.0};      // radiance times solid angle
    glm::dvec3 direction{0.0};  // mean over its solid angle, so shorter than 1
    double solid_angle = 0;
};

/// The map in pieces, each a texel or a part of one, at least as many as the parcels.
struct Pieces {
    const Image<Rgb>& map;
    int per_column, per_row;  // within a texel
    int width, height;

    explicit Pieces(const Image<Rgb>& m)
        : map(m),
          per_column((columns + m.width - 1) / m.width),
          per_row((rows - 1 + m.height - 1) / m.height),
          width(m.width * per_column),
          height(m.height * per_row) {}

    void add(Parcel& parcel, int x, int y) const {
        const double solid_angle =
            2 * pi / width * (std::cos(pi * y / height) - std::cos(pi * (y + 1) / height));
        const glm::dvec2 centre{(x + 0.5) / per_column, (y + 0.5) / per_row};
        parcel.direction += solid_angle * direction_from_texel(map, centre);
        parcel.solid_angle += solid_angle;
        const Rgb& radiance = map(x / per_column, y / per_row);
        if (std::isfinite(radiance.r + radiance.g + radiance.b))
            parcel.power += solid_angle * glm::dvec3(radiance);
    }
};

std::vector<Parcel> parcels_of(const Image<Rgb>& map) {
    const Pieces pieces(map);
    Image<Parcel> parcels(columns, rows - 1);
    parallel_rows(parcels.height, [&](int row) {
        const int end = pieces.height * (row + 1) / parcels.height;
        for (int y = pieces.height * row / parcels.height; y < end; ++y) {
            for (int x = 0; x < pieces.width; ++x)
                pieces.add(parcels(x * columns / pieces.width, row), x, y);
        }
        for (Parcel& parcel : parcels.row(row))
            parcel.direction /= parcel.solid_angle;
    });
    return std::move(parcels.pixels);
}

Rgb irradiance_from(const std::vector<Parcel>& parcels, const glm::dvec3& normal) {
    glm::dvec3 sum(0.0);
    for (const Parcel& parcel : parcels)
        sum += std::max(0.0, glm::dot(normal, parcel.direction)) * parcel.power;
    return Rgb(sum);
}

}  // namespace

EnvironmentIrradiance make_environment_irradiance(const EnvironmentMap& environment) {
    require(!environment.radiance.empty(), "the environment map has no pixels");
    const std::vector<Parcel> parcels = parcels_of(environment.radiance);
    EnvironmentIrradiance result{Image<Rgb>(columns, rows, Rgb(0)),
                                 environment.world_from_environment};
    parallel_rows(rows, [&](int y) {
        const double polar = pi * y / (rows - 1);
        for (int x = 0; x < columns; ++x) {
            const double longitude = 2 * pi * (0.5 - double(x) / columns);
            const glm::dvec3 normal{std::sin(polar) * std::sin(longitude), std::cos(polar),
                                    std::sin(polar) * std::cos(longitude)};
            result.by_normal(x, y) = irradiance_from(parcels, normal);
        }
    });
    return result;
}

Rgb irradiance_on(const EnvironmentIrradiance& irradiance, const glm::vec3& normal_world) {
    const Image<Rgb>& table = irradiance.by_normal;
    const glm::dvec3 n =
        glm::transpose(irradiance.world_from_environment) * glm::dvec3(normal_world);
    const double row =
        std::atan2(std::hypot(n.x, n.z), n.y) / pi * (table.height - 1);  // 0 .. height - 1
    const double column = (0.5 - std::atan2(n.x, n.z) / (2 * pi)) * table.width;
    const int y = std::min(int(row), table.height - 2);
    const int left = int(column) % table.width, right = (left + 1) % table.width;
    const auto fx = float(column - std::floor(column)), fy = float(row - y);
    return glm::mix(glm::mix(table(left, y), table(right, y), fx),
                    glm::mix(table(left, y + 1), table(right, y + 1), fx), fy);
}

}  // namespace inlay
