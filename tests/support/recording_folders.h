// Small recordings on disk, of a scene whose depth is known in closed form.
#pragma once

#include "recordings/base/image.h"
#include "recordings/base/lens.h"
#include "recordings/base/pose.h"

#include <opencv2/imgcodecs.hpp>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace inlay::test {

inline void write_file(const std::filesystem::path& file, const std::string& text) {
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << text;
}

inline void write_image(const std::filesystem::path& file, const cv::Mat& image) {
    std::filesystem::create_directories(file.parent_path());
    if (!cv::imwrite(file.string(), image)) throw std::runtime_error("cannot write an image");
}

/// Red 10, green 20, blue 30: so that swapped channels show.
inline void write_color(const std::filesystem::path& file, int width, int height) {
    write_image(file, cv::Mat(height, width, CV_8UC3, cv::Scalar(30, 20, 10)));
}

/// Depth as stored units, the same everywhere.
inline void write_depth(const std::filesystem::path& file, int width, int height, int units) {
    write_image(file, cv::Mat(height, width, CV_16UC1, cv::Scalar(units)));
}

/// A small lens for 64 x 48 px, for scenes seen under 53 x 41 degrees.
inline Lens small_lens() { return {64, 48, 64, 64, 31.5, 23.5}; }

/// A hand-held path: it turns and moves in all three directions.
inline Pose pose_on_path(int frame) {
    const double t = 0.05 * frame;
    const glm::dquat q = glm::angleAxis(0.3 * t, glm::normalize(glm::dvec3(0.3, 1.0, 0.2)));
    return {glm::mat3_cast(q), {0.4 * t, -0.15 * t, 0.25 * t}};
}

/// z-depth (m) of a slanted wall, z = 2 + 0.3 x + 0.2 y in the world, in front of the camera.
inline double wall_depth(const Pose& world_from_camera, const glm::dvec3& ray_camera) {
    const glm::dvec3 origin = world_from_camera.translation;
    const glm::dvec3 ray = world_from_camera.rotation * ray_camera;
    const glm::dvec3 normal{0.3, 0.2, -1.0};
    return (-2.0 - glm::dot(normal, origin)) / glm::dot(normal, ray);
}

/// The wall as seen by `lens`, in stored units.
inline cv::Mat wall_image(const Lens& lens, const Pose& world_from_camera, double units) {
    cv::Mat image(lens.height, lens.width, CV_16UC1);
    for (int y = 0; y < lens.height; ++y)
        for (int x = 0; x < lens.width; ++x) {
            const double z = wall_depth(world_from_camera, unproject(lens, {x, y}));
            image.at<std::uint16_t>(y, x) = std::uint16_t(std::lround(z * units));
        }
    return image;
}

inline std::string frame_name(int number) {
    char name[32];
    std::snprintf(name, sizeof name, "frame-%06d", number);
    return name;
}

/// Sixteen numbers in four rows.
inline std::string rows_text(const Pose& pose) {
    std::string text;
    char row[160];
    for (int r = 0; r < 3; ++r) {
        std::snprintf(row, sizeof row, "%.17g %.17g %.17g %.17g\n", pose.rotation[0][r],
                      pose.rotation[1][r], pose.rotation[2][r], pose.translation[r]);
        text += row;
    }
    return text + "0 0 0 1\n";
}

/// A 3DMatch folder of the wall, depth in `units` per m.
inline void write_three_d_match(const std::filesystem::path& folder, const std::vector<int>& frames,
                                double units = 1000) {
    write_file(folder / "camera-intrinsics.txt", "64 0 31.5\n0 64 23.5\n0 0 1\n");
    for (const int n : frames) {
        write_color(folder / (frame_name(n) + ".color.png"), 64, 48);
        write_image(folder / (frame_name(n) + ".depth.png"),
                    wall_image(small_lens(), pose_on_path(n), units));
        write_file(folder / (frame_name(n) + ".pose.txt"), rows_text(pose_on_path(n)));
    }
}

}  // namespace inlay::test
