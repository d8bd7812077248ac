// A small work for the bench: a still view of a table.
#pragma once

#include "composite/accuracy/work.h"
#include "tests/support/tabletop.h"

namespace inlay::test {

/// A still view of a table with two virtual balls.
inline Work tabletop_work() {
    Work work;
    work.name = "tabletop";
    work.scene = tabletop();
    const VirtualScene balls = two_virtual_balls();
    work.scene.objects.insert(work.scene.objects.end(), balls.objects.begin(), balls.objects.end());
    work.knows_room = true;
    work.environment = make_environment_sampler(soft_light());
    work.view = View{{24, 18, 22, 22, 11.5, 8.5}, camera_around(0.0), {0, 1, 0}};
    return work;
}

}  // namespace inlay::test
