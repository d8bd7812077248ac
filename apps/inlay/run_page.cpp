#include "apps/inlay/run_page.h"

#include "composite/accuracy/machine.h"
#include "composite/accuracy/report_pictures.h"
#include "composite/plan/explain.h"
#include "composite/write/atomic_file.h"
#include "composite/write/write_png.h"
#include "recordings/base/check.h"

#include "apps/report/report_page.h"
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdlib>

namespace inlay {
namespace {

using Json = nlohmann::ordered_json;

constexpr int enlargement = 4;

Json pictures_json(const std::vector<PicturePair>& pairs) {
    Json list = Json::array();
    const auto add = [&](int frame, const char* title, const Image<EncodedRgb>& picture) {
        list.push_back(
            {{"frame", frame}, {"title", title}, {"png", data_url(encode_png(picture))}});
    };
    for (const PicturePair& pair : pairs) {
        add(pair.frame, "photograph", pair.photograph);
        add(pair.frame, "composite", pair.composite);
        add(pair.frame, "difference", enlarged_difference(pair.photograph, pair.composite));
    }
    return list;
}

/// The form stands in apps/report/README.md.
Json json_of(const RunPage& page) {
    Json settings = Json::object(), frames = Json::array();
    for (const SettingRow& row : setting_rows())
        settings[row.name] = row.get(page.settings);
    for (const FrameReport& frame : page.frames)
        frames.push_back(Json::parse(to_json_line(frame)));
    return {{"version", 1},
            {"kind", "replay"},
            {"command", page.command},
            {"program", INLAY_VERSION},
            {"date", utc_now()},
            {"machine", Json::parse(to_json_text(this_machine()))},
            {"settings", settings},
            {"recording", page.recording},
            {"scene", page.scene},
            {"frames", frames},
            {"pictures", pictures_json(page.pictures)},
            {"plan", Json::parse(to_json_text(page.plan))}};
}

}  // namespace

Image<EncodedRgb> enlarged_difference(const Image<EncodedRgb>& a, const Image<EncodedRgb>& b) {
    require(same_size(a, b), "difference: the two pictures have different sizes");
    const auto distance = [](int x, int y) {
        return std::uint8_t(std::min(255, enlargement * std::abs(x - y)));
    };
    Image<EncodedRgb> result(a.width, a.height);
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        const EncodedRgb &p = a.pixels[i], &q = b.pixels[i];
        result.pixels[i] = {distance(p.r, q.r), distance(p.g, q.g), distance(p.b, q.b)};
    }
    return result;
}

void write_run_page(const std::filesystem::path& file, const RunPage& page) {
    const std::string json = json_of(page).dump(-1, ' ', false, Json::error_handler_t::replace);
    write_text(file, report_page(json));
}

}  // namespace inlay
