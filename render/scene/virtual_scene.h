// VirtualScene: objects with shape, material and motion, as plain values.
#pragma once

#include "recordings/base/triangle_mesh.h"
#include "render/scene/material.h"

#include <glm/glm.hpp>

#include <memory>
#include <string>
#include <variant>
#include <vector>

namespace inlay {

struct MeshShape {
    std::shared_ptr<const TriangleMesh> mesh;  // object frame, m
};

/// A sphere about the object's origin.
struct SphereShape {
    float radius = 1.0f;  // m
};

struct ObjectPart {
    std::variant<MeshShape, SphereShape> shape;
    Material material;
};

/// Where an object is at a time (s): an affine world_from_object without shear or mirroring.
struct MotionKey {
    double time = 0;  // s
    glm::dmat4 world_from_object{1.0};
};

struct SceneObject {
    std::string name;
    std::vector<ObjectPart> parts;
    std::vector<MotionKey> motion;  // at least one; times increase strictly
    bool real = false;              // counts as real in `render` and `record`
};

struct VirtualScene {
    std::vector<SceneObject> objects;
};

/// world_from_object at `time`: constant before the first and after the last keyframe; in between
/// translation and scale run linearly and rotation along the shortest arc.
glm::dmat4 transform_at(const SceneObject& object, double time);

}  // namespace inlay
