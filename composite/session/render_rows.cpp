// The settings of real geometry, tracing, filter and blend by name.
#include "composite/session/setting_rows.h"

namespace inlay {

std::vector<SettingRow> render_rows() {
    return {
        choice<RealGeometryKind>("geometry.kind",
                                 {{"screen", RealGeometryKind::screen},
                                  {"map", RealGeometryKind::map},
                                  {"model", RealGeometryKind::model}},
                                 INLAY_MEMBER(geometry.kind)),
        row("geometry.offset", "m", INLAY_MEMBER(geometry.offset)),
        row("geometry.visibility_tolerance", "m", INLAY_MEMBER(geometry.visibility_tolerance)),
        row("geometry.max_step", "share of depth", INLAY_MEMBER(geometry.max_step)),
        row("geometry.model_interval", "frames", INLAY_MEMBER(geometry.model_interval)),
        row("geometry.screen.thickness", "m", INLAY_MEMBER(geometry.screen.thickness)),
        row("geometry.screen.thickness_per_depth", "1",
            INLAY_MEMBER(geometry.screen.thickness_per_depth)),
        row("geometry.screen.largest_tilt", "share of depth",
            INLAY_MEMBER(geometry.screen.largest_tilt)),
        choice<Estimator>(
            "render.estimator",
            {{"two_mode", Estimator::two_mode}, {"difference", Estimator::difference}},
            INLAY_MEMBER(trace.estimator)),
        row("trace.primary", "rays per pixel", INLAY_MEMBER(trace.primary)),
        row("trace.secondary", "samples per primary ray", INLAY_MEMBER(trace.secondary)),
        row("trace.virtual_repeats", "per sample", INLAY_MEMBER(trace.virtual_repeats)),
        row("trace.light_tries", "per sample", INLAY_MEMBER(trace.light_tries)),
        row("trace.spread", "on|off", INLAY_MEMBER(trace.spread)),
        row("trace.gathered", "samples of E_R per vertex of the model",
            INLAY_MEMBER(trace.gathered)),
        row("trace.coverage", "rays per pixel", INLAY_MEMBER(trace.coverage)),
        row("trace.skip", "on|off", INLAY_MEMBER(skip)),
        row("trace.seed", "", INLAY_MEMBER(trace.seed)),
        row("trace.depth_tolerance", "share of depth", INLAY_MEMBER(trace.depth_tolerance)),
        row("trace.occluder_floor", "share of depth", INLAY_MEMBER(trace.occluder_floor)),
        row("trace.ignored_luminance", "share of the mean", INLAY_MEMBER(trace.ignored_luminance)),
        row("filter.enabled", "on|off", INLAY_MEMBER(filter.enabled)),
        choice<FilterConstants>("filter.constants",
                                {{"corrected", FilterConstants::corrected},
                                 {"thesis", FilterConstants::thesis},
                                 {"durand", FilterConstants::durand}},
                                INLAY_MEMBER(filter.constants)),
        row("filter.real_curvature", "on|off", INLAY_MEMBER(filter.real_curvature)),
        row("filter.rate_reach", "px", INLAY_MEMBER(filter.rate_reach)),
        row("filter.curvature_safety", "s_k", INLAY_MEMBER(filter.curvature_safety)),
        row("filter.visibility_safety", "s_v", INLAY_MEMBER(filter.visibility_safety)),
        row("filter.kernel_radius", "px", INLAY_MEMBER(filter.kernel_radius)),
        row("filter.narrowest_width", "px", INLAY_MEMBER(filter.narrowest_width)),
        row("filter.narrowest_change", "px", INLAY_MEMBER(filter.narrowest_change)),
        row("filter.normal_stop_deg", "degrees", INLAY_MEMBER(filter.normal_stop_deg)),
        row("filter.temporal", "on|off", INLAY_MEMBER(filter.temporal)),
        row("filter.rejection_distance", "px", INLAY_MEMBER(filter.rejection_distance)),
        choice<BlendForm>("blend.form",
                          {{"ratio", BlendForm::ratio}, {"additive", BlendForm::additive}},
                          INLAY_MEMBER(blend.form)),
        row("blend.epsilon_share", "of the mean E_R", INLAY_MEMBER(blend.epsilon_share)),
        row("blend.max_ratio", "1", INLAY_MEMBER(blend.max_ratio)),
    };
}

}  // namespace inlay
