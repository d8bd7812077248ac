#include "composite/accuracy/run_file.h"

#include "composite/accuracy/judged_frames.h"
#include "composite/accuracy/work_fingerprint.h"
#include "composite/write/atomic_file.h"
#include "recordings/base/check.h"

#include <nlohmann/json.hpp>

#include <fstream>

namespace inlay {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

/// What must be the same for a run to go on.
ordered_json identity(const std::vector<Work>& works, const BenchOptions& options,
                      const fs::path& folder) {
    ordered_json settings;
    for (const SettingRow& row : setting_rows())
        settings[row.name] = row.get(options.settings);
    ordered_json json{
        {"program", options.program},    {"settings", settings},
        {"repeats", options.repeats},    {"quick", options.quick},
        {"only", options.only},          {"converged_samples", options.converged_samples},
        {"names", ordered_json::array()}};
    for (const Work& work : works)
        json["names"].push_back(work.name);
    for (const Work& work : works) {
        ordered_json contents = ordered_json::object();
        for (const auto& [part, fingerprint] : fingerprints_of(work, folder))
            contents[part] = fingerprint;
        json["works"][work.name] = {{"source", fs::absolute(work.source).string()},
                                    {"frames", measured_frames(work, options.wanted_frame)},
                                    {"contents", contents}};
    }
    return json;
}

/// `place` is the name of the object that both are, with a space, or nothing.
void require_same(const ordered_json& kept, const ordered_json& now, const fs::path& file,
                  const std::string& place = "") {
    for (const auto& [key, value] : now.items()) {
        const ordered_json before = kept.is_object() ? kept.value(key, ordered_json()) : nullptr;
        if (value.is_object()) require_same(before, value, file, place + key + " ");
        require(before == value,
                file.string() + ": the run that this folder holds is another one: " + place + key +
                    " was " + before.dump() + " and is " + value.dump() +
                    "; repeat its command, or choose another --out",
                ExitCode::usage);
    }
}

}  // namespace

RunFacts open_run(const std::vector<Work>& works, const BenchOptions& options,
                  const fs::path& folder) {
    const fs::path file = folder / "run.json";
    const ordered_json now = identity(works, options, folder);
    if (!fs::exists(file)) {
        const RunFacts facts{utc_now(), this_machine()};
        ordered_json json{{"date", facts.date},
                          {"machine", ordered_json::parse(to_json_text(facts.machine))}};
        json["run"] = now;
        write_text(file, json.dump(1) + "\n");
        return facts;
    }
    require(options.resume,
            folder.string() + ": holds a run already; go on with --resume, or choose another --out",
            ExitCode::usage);
    std::ifstream stream(file);
    const ordered_json kept = ordered_json::parse(stream, nullptr, /*allow_exceptions=*/false);
    require(!kept.is_discarded() && kept.contains("run") && kept.contains("date") &&
                kept.contains("machine"),
            file.string() + ": damaged; expected what a run writes; choose another --out");
    require_same(kept.at("run"), now, file);
    return {kept.at("date"), machine_from_json(kept.at("machine").dump(), file.string())};
}

}  // namespace inlay
