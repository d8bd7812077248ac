#include "composite/plan/scene_facts.h"

#include <algorithm>

namespace inlay {
namespace {

bool is_textured(const Material& material) {
    return std::visit([](const auto& m) { return m.texture != nullptr; }, material);
}

bool large_enough(const ObjectInView& cover) {
    return !(cover.size_px.x * cover.size_px.y < least_visible_px * least_visible_px);
}

ObjectFacts facts_of(const SceneObject& object) {
    ObjectFacts facts;
    facts.name = object.name;
    for (const ObjectPart& part : object.parts) {
        facts.glossy = facts.glossy || is_glossy(part.material);
        facts.textured = facts.textured || is_textured(part.material);
    }
    return facts;
}

template <class Test>
int count(const SceneFacts& facts, const Test& test) {
    return int(std::count_if(facts.objects.begin(), facts.objects.end(), test));
}

}  // namespace

bool is_glossy(const Material& material) {
    if (std::holds_alternative<Ggx>(material)) return true;
    const auto* phong = std::get_if<Phong>(&material);
    return phong != nullptr && phong->specular != Rgb(0);
}

bool virtual_objects_moved(const VirtualScene& scene, double time, double time_before) {
    return std::any_of(scene.objects.begin(), scene.objects.end(), [&](const SceneObject& o) {
        return !o.real && transform_at(o, time) != transform_at(o, time_before);
    });
}

SceneFacts gather_facts(const SceneInFrame& frame) {
    const ViewWindow window = view_window(frame.lens);
    const glm::dmat4 camera_from_world = to_matrix(inverse(frame.world_from_camera));
    const SeenSpace seen{window, frame.farthest, frame.offset};
    const double brightest = contrast(frame.light, frame.exposure);
    SceneFacts facts;
    facts.lit = frame.lit;
    facts.moving = virtual_objects_moved(frame.scene, frame.time, frame.time_before);
    for (std::size_t i = 0; i < frame.scene.objects.size(); ++i) {
        const SceneObject& object = frame.scene.objects[i];
        if (object.real || frame.bounds[i].empty()) continue;
        ObjectFacts measured = facts_of(object);
        const glm::dmat4 camera_from_object = camera_from_world * transform_at(object, frame.time);
        measured.cover = object_in_view(frame.bounds[i], camera_from_object, window);
        measured.in_view = measured.cover.possible && large_enough(measured.cover);
        measured.light_change =
            light_change(ball_of(frame.bounds[i], camera_from_object), seen, brightest);
        facts.objects.push_back(std::move(measured));
    }
    return facts;
}

int objects_in_view(const SceneFacts& facts) {
    return count(facts, [](const ObjectFacts& o) { return o.in_view; });
}

int glossy_objects(const SceneFacts& facts) {
    return count(facts, [](const ObjectFacts& o) { return o.glossy; });
}

int glossy_objects_in_view(const SceneFacts& facts) {
    return count(facts, [](const ObjectFacts& o) { return o.glossy && o.in_view; });
}

double light_change(const SceneFacts& facts) {
    double sum = 0;
    for (const ObjectFacts& o : facts.objects)
        sum += o.light_change;
    return sum;
}

bool out_of_reach(const SceneFacts& facts) {
    return !facts.objects.empty() && objects_in_view(facts) == 0 &&
           light_change(facts) < unseen_change;
}

}  // namespace inlay
