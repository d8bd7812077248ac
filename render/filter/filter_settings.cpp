// The valid range of every setting of the environment filter.
#include "render/filter/filter_settings.h"

#include "recordings/base/check.h"

#include <cmath>

namespace inlay {
namespace {

void require_setting(bool condition, const char* name, double found, const char* expected) {
    require(
        condition,
        "filter." + std::string(name) + " is " + std::to_string(found) + ", expected " + expected,
        ExitCode::usage);
}

}  // namespace

void validate(const FilterSettings& s) {
    const auto positive = [](double v) { return std::isfinite(v) && v > 0; };
    require_setting(positive(s.curvature_safety), "curvature_safety", s.curvature_safety,
                    "a positive number");
    require_setting(positive(s.visibility_safety), "visibility_safety", s.visibility_safety,
                    "a positive number");
    require_setting(s.rate_reach >= 0 && s.rate_reach <= 100, "rate_reach", s.rate_reach,
                    "0 to 100 px");
    require_setting(s.kernel_radius >= 0 && s.kernel_radius <= 1000, "kernel_radius",
                    s.kernel_radius, "0 to 1000 px");
    require_setting(std::isfinite(s.narrowest_width) && s.narrowest_width >= 0, "narrowest_width",
                    s.narrowest_width, "0 px or more");
    require_setting(std::isfinite(s.narrowest_change) && s.narrowest_change >= 0,
                    "narrowest_change", s.narrowest_change, "0 px or more");
    require_setting(positive(s.normal_stop_deg) && s.normal_stop_deg < 90, "normal_stop_deg",
                    s.normal_stop_deg, "an angle between 0 and 90 degrees");
    require_setting(positive(s.rejection_distance), "rejection_distance", s.rejection_distance,
                    "a positive number of pixels");
}

}  // namespace inlay
