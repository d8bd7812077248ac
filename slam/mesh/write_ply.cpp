#include "slam/mesh/write_ply.h"

#include "recordings/base/check.h"
#include "recordings/base/color.h"

#include <fcntl.h>
#include <unistd.h>

#include <bit>
#include <cerrno>
#include <cstring>
#include <string>

namespace inlay {
namespace {

namespace fs = std::filesystem;

static_assert(std::endian::native == std::endian::little, "the file is little-endian");

std::string header(const TriangleMesh& mesh) {
    std::string text = "ply\nformat binary_little_endian 1.0\ncomment lengths in m\n";
    text += "element vertex " + std::to_string(mesh.positions.size()) + "\n";
    text += "property float x\nproperty float y\nproperty float z\n";
    if (!mesh.normals.empty()) text += "property float nx\nproperty float ny\nproperty float nz\n";
    if (!mesh.colors.empty()) {
        text += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
    }
    text += "element face " + std::to_string(mesh.triangles.size()) + "\n";
    return text + "property list uchar uint vertex_indices\nend_header\n";
}

template <class Value>
void append(std::string& bytes, const Value& value) {
    const std::size_t end = bytes.size();
    bytes.resize(end + sizeof(Value));
    std::memcpy(&bytes[end], &value, sizeof(Value));
}

std::string contents(const TriangleMesh& mesh) {
    std::string bytes = header(mesh);
    bytes.reserve(bytes.size() + mesh.positions.size() * 27 + mesh.triangles.size() * 13);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        append(bytes, mesh.positions[i]);
        if (!mesh.normals.empty()) append(bytes, mesh.normals[i]);
        if (!mesh.colors.empty()) append(bytes, encode(mesh.colors[i]));
    }
    for (const glm::uvec3& triangle : mesh.triangles) {
        append(bytes, std::uint8_t(3));
        append(bytes, triangle);
    }
    return bytes;
}

void write_all(int descriptor, const std::string& bytes, const fs::path& file) {
    std::size_t done = 0;
    while (done < bytes.size()) {
        const ssize_t written = ::write(descriptor, bytes.data() + done, bytes.size() - done);
        if (written < 0 && errno == EINTR) continue;
        require(written > 0,
                file.string() + ": wrote " + std::to_string(done) + " of " +
                    std::to_string(bytes.size()) + " bytes: " + std::strerror(errno) +
                    "; make room on the disk",
                ExitCode::disk_fault);
        done += std::size_t(written);
    }
    require(::fsync(descriptor) == 0, file.string() + ": " + std::strerror(errno),
            ExitCode::disk_fault);
}

/// An open file that is closed, and removed unless it was kept.
struct Unfinished {
    fs::path path;
    int descriptor;
    bool kept = false;
    ~Unfinished() {
        ::close(descriptor);
        if (!kept) ::unlink(path.c_str());
    }
};

}  // namespace

void write_ply(const fs::path& file, const TriangleMesh& mesh) {
    const fs::path beside = file.string() + ".partial";
    Unfinished unfinished{beside,
                          ::open(beside.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666)};
    require(unfinished.descriptor >= 0,
            beside.string() + ": cannot be created: " + std::strerror(errno) +
                "; choose a folder that exists and may be written",
            ExitCode::cannot_create);
    write_all(unfinished.descriptor, contents(mesh), beside);
    require(::rename(beside.c_str(), file.c_str()) == 0,
            file.string() + ": cannot be created: " + std::strerror(errno),
            ExitCode::cannot_create);
    unfinished.kept = true;
}

}  // namespace inlay
