#include "composite/session/reconstruction_json.h"

#include "composite/write/frame_report.h"
#include "recordings/base/check.h"

#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace inlay {
namespace {

using Json = nlohmann::ordered_json;

Json rows_of(const Pose& pose) {
    Json numbers = Json::array();
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column)
            numbers.push_back(pose.rotation[column][row]);
        numbers.push_back(pose.translation[row]);
    }
    return numbers;
}

Pose pose_from(const Json& numbers) {
    const auto n = numbers.get<std::vector<double>>();
    require(n.size() == 12, "a pose has 12 numbers");
    Pose pose;
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column)
            pose.rotation[column][row] = n[std::size_t(4 * row + column)];
        pose.translation[row] = n[std::size_t(4 * row + 3)];
    }
    for (const double number : n)
        require(std::isfinite(number), "a pose is finite");
    return pose;
}

Json numbers_of(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

glm::dvec3 vector_from(const Json& json) {
    const auto n = json.get<std::array<double, 3>>();
    return {n[0], n[1], n[2]};
}

ColorRegistration registration_from(const Json& json) {
    ColorRegistration r;
    r.needed = json.at("needed").get<bool>();
    r.delay_needed = json.at("delay_needed").get<bool>();
    r.color_from_depth = pose_from(json.at("color_from_depth"));
    r.rotation_sd = vector_from(json.at("rotation_sd_rad"));
    r.translation_sd = vector_from(json.at("translation_sd_m"));
    const auto l = json.at("color_lens").get<std::array<double, 11>>();
    r.color_lens = {int(l[0]), int(l[1]), l[2], l[3], l[4], l[5], l[6], l[7], l[8], l[9], l[10]};
    r.focal_sd = json.at("focal_sd_px").get<double>();
    r.delay = json.at("delay_s").get<double>();
    r.delay_sd = json.at("delay_sd_s").get<double>();
    r.shift_px = json.at("shift_px").get<double>();
    r.sd_px = json.at("shift_sd_px").get<double>();
    r.delay_px = json.at("delay_px").get<double>();
    r.distance_before = json.at("edge_distance_px").at("before").get<double>();
    r.distance_after = json.at("edge_distance_px").at("after").get<double>();
    r.near_before = json.at("share_within_2_px").at("before").get<double>();
    r.near_after = json.at("share_within_2_px").at("after").get<double>();
    r.points = json.at("points").get<int>();
    return r;
}

void require_place(int place, std::size_t count) {
    require(place >= 0 && std::size_t(place) < count, "a place in a list that is shorter");
}

TrackingStatus status_from(const std::string& name) {
    for (const TrackingStatus status :
         {TrackingStatus::tracked, TrackingStatus::weak, TrackingStatus::lost})
        if (name == name_of(status)) return status;
    throw Error(ExitCode::bad_data, name + ": not a status");
}

}  // namespace

Json to_json(const Reconstruction& r) {
    Json frames = Json::array();
    for (const ReconstructedFrame& f : r.frames) {
        const TrackResult& t = f.tracking;
        frames.push_back({{"frame", f.number},
                          {"time_s", f.time},
                          {"status", name_of(t.status)},
                          {"world_from_camera", rows_of(t.world_from_camera)},
                          {"inlier_share", t.inlier_share},
                          {"rms_residual_m", t.rms_residual},
                          {"iterations", t.iterations},
                          {"overlap", t.overlap},
                          {"why", t.why},
                          {"exposure", {f.gain.r, f.gain.g, f.gain.b}},
                          {"readable", f.readable}});
        if (f.fused_at) frames.back()["fused_at"] = rows_of(*f.fused_at);
    }
    Json loops = Json::array();
    for (const PoseEdge& loop : r.loops)
        loops.push_back({{"from", loop.from},
                         {"to", loop.to},
                         {"motion", rows_of(loop.motion)},
                         {"information", loop.information}});
    Json json{{"frames", frames}, {"keyframes", r.keyframes}, {"loops", loops}};
    if (r.registration) json["registration"] = registration_json(*r.registration);
    return json;
}

Reconstruction reconstruction_from(const Json& json) {
    Reconstruction r;
    for (const Json& f : json.at("frames")) {
        ReconstructedFrame frame;
        frame.number = f.at("frame").get<int>();
        frame.time = f.at("time_s").get<double>();
        frame.tracking = {
            pose_from(f.at("world_from_camera")), status_from(f.at("status").get<std::string>()),
            f.at("inlier_share").get<float>(),    f.at("rms_residual_m").get<float>(),
            f.at("iterations").get<int>(),        f.at("overlap").get<float>(),
            f.at("why").get<std::string>()};
        const auto gain = f.at("exposure").get<std::array<float, 3>>();
        frame.gain = {gain[0], gain[1], gain[2]};
        frame.readable = f.at("readable").get<bool>();
        if (f.contains("fused_at")) frame.fused_at = pose_from(f.at("fused_at"));
        r.frames.push_back(frame);
    }
    if (json.contains("registration")) r.registration = registration_from(json.at("registration"));
    r.keyframes = json.at("keyframes").get<std::vector<int>>();
    for (const int position : r.keyframes)
        require_place(position, r.frames.size());
    for (const Json& l : json.at("loops"))
        r.loops.push_back({l.at("from").get<int>(), l.at("to").get<int>(),
                           pose_from(l.at("motion")),
                           l.at("information").get<std::array<double, 21>>()});
    for (const PoseEdge& loop : r.loops) {
        require_place(loop.from, r.keyframes.size());
        require_place(loop.to, r.keyframes.size());
    }
    return r;
}

Json registration_json(const ColorRegistration& r) {
    const Lens& l = r.color_lens;
    return {
        {"needed", r.needed},
        {"delay_needed", r.delay_needed},
        {"color_from_depth", rows_of(r.color_from_depth)},
        {"rotation_sd_rad", numbers_of(r.rotation_sd)},
        {"translation_sd_m", numbers_of(r.translation_sd)},
        {"color_lens", {l.width, l.height, l.fx, l.fy, l.cx, l.cy, l.k1, l.k2, l.k3, l.p1, l.p2}},
        {"focal_sd_px", r.focal_sd},
        {"delay_s", r.delay},
        {"delay_sd_s", r.delay_sd},
        {"shift_px", r.shift_px},
        {"shift_sd_px", r.sd_px},
        {"delay_px", r.delay_px},
        {"edge_distance_px", {{"before", r.distance_before}, {"after", r.distance_after}}},
        {"share_within_2_px", {{"before", r.near_before}, {"after", r.near_after}}},
        {"points", r.points}};
}

Json keyframes_json(const Reconstruction& r) {
    Json keyframes = Json::array(), loops = Json::array();
    for (const int position : r.keyframes) {
        const ReconstructedFrame& f = r.frames[std::size_t(position)];
        keyframes.push_back({{"frame", f.number},
                             {"time_s", f.time},
                             {"world_from_camera", rows_of(f.tracking.world_from_camera)}});
    }
    const auto frame_of = [&](int keyframe) {
        return r.frames[std::size_t(r.keyframes[std::size_t(keyframe)])].number;
    };
    for (const PoseEdge& loop : r.loops)
        loops.push_back({{"from_frame", frame_of(loop.from)},
                         {"to_frame", frame_of(loop.to)},
                         {"from_to", rows_of(loop.motion)}});
    return {{"poses", "3 x 4, row-major, m"}, {"keyframes", keyframes}, {"loops", loops}};
}

Json status_json(const ReconstructedFrame& f) {
    const TrackResult& t = f.tracking;
    return {{"frame", f.number},
            {"time_s", f.time},
            {"status", name_of(t.status)},
            {"why", t.why},
            {"inlier_share", t.inlier_share},
            {"overlap", t.overlap},
            {"rms_residual_m", t.rms_residual},
            {"exposure", {f.gain.r, f.gain.g, f.gain.b}}};
}

}  // namespace inlay
