#include "composite/govern/front_cache.h"

#include "composite/write/atomic_file.h"
#include "composite/write/file_content.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <exception>
#include <system_error>
#include <utility>

namespace inlay {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

fs::path file_of(const fs::path& folder, const std::string& key) {
    return folder / ("front-" + fingerprint_of(key) + ".json");
}

/// Whether a governor can choose by it, whatever a file says.
bool usable(const PriceFront& front) {
    if (!(front.other_ms >= 0) || front.points.empty()) return false;
    for (const PricePoint& p : front.points)
        if (p.samples < 1 || !(p.ms >= 0) || !(p.error >= 0) || !std::isfinite(p.ms + p.error))
            return false;
    for (std::size_t i = 1; i < front.points.size(); ++i) {
        const PricePoint &a = front.points[i - 1], &b = front.points[i];
        if (!(a.samples < b.samples && a.ms < b.ms && a.error > b.error)) return false;
    }
    return std::isfinite(front.other_ms);
}

}  // namespace

std::optional<PriceFront> kept_front(const fs::path& folder, const std::string& key) {
    const fs::path file = file_of(folder, key);
    std::error_code unreadable;
    if (!fs::exists(file, unreadable)) return std::nullopt;
    try {
        const Json json = Json::parse(content_of(file));
        if (json.at("key").get<std::string>() != key) return std::nullopt;
        PriceFront front;
        front.other_ms = json.at("other_ms").get<double>();
        for (const Json& point : json.at("points"))
            front.points.push_back({point.at("samples").get<int>(), point.at("ms").get<double>(),
                                    point.at("error").get<double>()});
        return usable(front) ? std::optional(std::move(front)) : std::nullopt;
    } catch (const std::exception&) {  // damaged, unreadable: it is measured again
        return std::nullopt;
    }
}

void keep_front(const fs::path& folder, const std::string& key, const PriceFront& front) {
    Json points = Json::array();
    for (const PricePoint& p : front.points)
        points.push_back({{"samples", p.samples}, {"ms", p.ms}, {"error", p.error}});
    const Json json{{"key", key}, {"other_ms", front.other_ms}, {"points", points}};
    make_folder(folder);
    write_text(file_of(folder, key),
               json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

}  // namespace inlay
