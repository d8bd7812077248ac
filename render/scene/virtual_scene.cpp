#include "render/scene/virtual_scene.h"

#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cassert>

namespace inlay {

namespace {

struct RotationScale {
    glm::dquat rotation;
    glm::dvec3 scale;
};

RotationScale split(const glm::dmat4& m) {
    const glm::dmat3 linear(m);
    const glm::dvec3 scale{glm::length(linear[0]), glm::length(linear[1]), glm::length(linear[2])};
    const glm::dmat3 rotation{linear[0] / scale.x, linear[1] / scale.y, linear[2] / scale.z};
    return {glm::normalize(glm::quat_cast(rotation)), scale};
}

glm::dmat4 between(const glm::dmat4& a, const glm::dmat4& b, double t) {
    const RotationScale from = split(a), to = split(b);
    const glm::dmat3 rotation =
        glm::mat3_cast(glm::normalize(glm::slerp(from.rotation, to.rotation, t)));
    const glm::dvec3 scale = glm::mix(from.scale, to.scale, t);
    glm::dmat4 result(
        glm::dmat3{rotation[0] * scale.x, rotation[1] * scale.y, rotation[2] * scale.z});
    result[3] = glm::mix(a[3], b[3], t);
    return result;
}

}  // namespace

glm::dmat4 transform_at(const SceneObject& object, double time) {
    const std::vector<MotionKey>& keys = object.motion;
    assert(!keys.empty());
    const auto after = std::upper_bound(keys.begin(), keys.end(), time,
                                        [](double t, const MotionKey& k) { return t < k.time; });
    if (after == keys.begin()) return keys.front().world_from_object;
    if (after == keys.end()) return keys.back().world_from_object;
    const MotionKey& from = *(after - 1);
    if (time == from.time) return from.world_from_object;
    return between(from.world_from_object, after->world_from_object,
                   (time - from.time) / (after->time - from.time));
}

}  // namespace inlay
