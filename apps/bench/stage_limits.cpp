#include "apps/bench/stage_limits.h"

#include "composite/write/atomic_file.h"
#include "composite/write/descriptor.h"
#include "recordings/base/parallel.h"
#include "recordings/base/random.h"

#include <benchmark/benchmark.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <fstream>

namespace inlay {
namespace fs = std::filesystem;

std::vector<fs::path> picture_files(const fs::path& recording, int frame) {
    const std::string number = fmt::format("{:06d}", frame);
    std::vector<fs::path> files;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(recording)) {
        const fs::path &file = entry.path(), kind = file.extension();
        const bool picture = kind == ".png" || kind == ".jpg";
        if (picture && file.filename().string().find(number) != std::string::npos)
            files.push_back(file);
    }
    return files;
}

std::vector<std::vector<unsigned char>> read_files(const std::vector<fs::path>& files) {
    std::vector<std::vector<unsigned char>> all;
    for (const fs::path& file : files) {
        all.emplace_back(fs::file_size(file));
        std::ifstream stream(file, std::ios::binary);
        stream.read(reinterpret_cast<char*>(all.back().data()), std::streamsize(all.back().size()));
    }
    return all;
}

void decode_pictures(const std::vector<std::vector<unsigned char>>& files) {
    for (const auto& bytes : files)
        benchmark::DoNotOptimize(
            cv::imdecode(bytes, cv::IMREAD_ANYDEPTH | cv::IMREAD_ANYCOLOR).data);
}

void write_plainly(const fs::path& file, std::span<const std::byte> bytes) {
    const Descriptor open_file(::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666));
    if (open_file.get() < 0) throw_write_error(file, errno);
    const ssize_t written = ::write(open_file.get(), bytes.data(), bytes.size());
    if (written < 0 || ::fsync(open_file.get()) != 0) throw_write_error(file, errno);
    if (std::size_t(written) < bytes.size()) throw_write_error(file, ENOSPC);
}

BareRays pixel_rays(const Lens& lens, const Pose& world_from_camera, float nearest) {
    BareRays rays;
    for (int y = 0; y < lens.height; y += 4) {
        for (int x = 0; x < lens.width; x += 4) {
            RayPacket packet;
            packet.t_min = nearest;
            packet.coherent = true;
            for (int lane = 0; lane < packet_width; ++lane) {
                const glm::ivec2 pixel(x + lane % 4, y + lane / 4);
                if (pixel.x >= lens.width || pixel.y >= lens.height) continue;
                const glm::dvec3 direction =
                    world_from_camera.rotation * unproject(lens, glm::dvec2(pixel));
                packet.set(lane, glm::vec3(world_from_camera.translation),
                           glm::vec3(glm::normalize(direction)));
            }
            rays.add(packet, /*nearest=*/true);
        }
    }
    return rays;
}

void draw_samples(const EnvironmentSampler& environment, int count) {
    constexpr int block = 1024;
    parallel_for((count + block - 1) / block, [&](int b) {
        for (int i = b * block; i < std::min(count, (b + 1) * block); ++i) {
            const SampleKey key{1, 0, std::uint32_t(i), 0};
            benchmark::DoNotOptimize(
                sample_environment(environment, {uniform(key, 0), uniform(key, 1)}));
        }
    });
}

}  // namespace inlay
