// Eight numbers at a time, for hot loops: a register of the instruction set that we build for.
#pragma once

#include <experimental/simd>  // the language's own SIMD types (Parallelism TS 2)
#include <glm/glm.hpp>

#include <array>

namespace inlay {

namespace stdx = std::experimental;

constexpr int lane_count = 8;
using Floats = stdx::simd<float, stdx::simd_abi::deduce_t<float, lane_count>>;
using Ints = stdx::rebind_simd_t<int, Floats>;
using Lanes = Floats::mask_type;  // which of the eight

/// Eight vectors.
struct Vectors {
    Floats x = 0, y = 0, z = 0;
};

inline Floats dot(const Vectors& a, const Vectors& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

inline Vectors cross(const Vectors& a, const Vectors& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// rotation * p + translation.
inline Vectors transformed(const glm::mat3& rotation, const Vectors& p,
                           const glm::vec3& translation = glm::vec3(0)) {
    const auto row = [&](int i) {
        return rotation[0][i] * p.x + rotation[1][i] * p.y + rotation[2][i] * p.z + translation[i];
    };
    return {row(0), row(1), row(2)};
}

/// The vectors that vector_of(lane) gives.
template <class VectorOf>
Vectors gathered(const VectorOf& vector_of) {
    return {Floats([&](auto lane) { return vector_of(lane).x; }),
            Floats([&](auto lane) { return vector_of(lane).y; }),
            Floats([&](auto lane) { return vector_of(lane).z; })};
}

/// 0, 1, ... 7.
inline Floats lane_numbers() {
    return Floats([](auto lane) { return float(lane); });
}

/// `yes` in the lanes that are set, `no` in the others.
inline Floats choose(const Lanes& set, const Floats& yes, const Floats& no) {
    Floats result = no;
    where(set, result) = yes;
    return result;
}

/// The numbers of a register as an array, to go on with one by one.
inline std::array<int, lane_count> numbers_of(const Ints& lanes) {
    alignas(stdx::memory_alignment_v<Ints>) std::array<int, lane_count> numbers;
    lanes.copy_to(numbers.data(), stdx::vector_aligned);
    return numbers;
}

inline std::array<float, lane_count> numbers_of(const Floats& lanes) {
    alignas(stdx::memory_alignment_v<Floats>) std::array<float, lane_count> numbers;
    lanes.copy_to(numbers.data(), stdx::vector_aligned);
    return numbers;
}

}  // namespace inlay
