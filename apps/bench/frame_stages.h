// The stages of one frame of a recording, each with the least that it has to do.
#pragma once

#include "composite/accuracy/work.h"
#include "composite/session/session.h"

#include "apps/bench/best_times.h"
#include "apps/bench/streaming.h"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace inlay {

/// One frame, composited, and what that took.
struct Subject {
    Work work;
    Session session;
    RgbdFrame frame;
    OutputFrame out;
    SurfaceMap seen;               // before its edges follow the photograph
    std::filesystem::path folder;  // for files that are written

    const Settings& settings() const { return session.settings; }
    const VoxelVolume& volume() const { return session.known->volume; }
    const EmbreeScene& model() const { return *session.model.mesh; }
    const EnvironmentMap& environment() const { return session.environment.map; }
};

struct Limit {
    std::string name;
    Amount amount;
    std::function<void()> body;
};

/// A serial stage has but one thread to run on.
struct Stage {
    std::string name;
    std::function<void()> body;
    std::vector<Limit> limits;
    bool serial = false;
};

/// All that a stage reads and writes, gone through once.
Limit bytes_once(const Traffic& traffic);

/// A subject must outlive its stages.
std::vector<Stage> input_stages(const Subject& subject);    // files, plan, environment
std::vector<Stage> surface_stages(const Subject& subject);  // model, surface map
std::vector<Stage> output_stages(const Subject& subject);   // composite, files

}  // namespace inlay
