#include "recordings/environment/hdr_image.h"

#include "recordings/base/check.h"

#include <opencv2/imgcodecs.hpp>

#include <fstream>
#include <sstream>
#include <string>

namespace inlay {

namespace fs = std::filesystem;

namespace {

constexpr int max_side = 16384;  // px

/// Refuses a Radiance file by its header alone: a decoder would take memory for any size it claims.
void require_radiance_header(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    std::string line;
    require(std::getline(stream, line) && line.starts_with("#?"),
            file.string() + ": does not begin with #?; expected a Radiance picture");
    for (int lines = 0; lines < 100 && std::getline(stream, line) && !line.empty();)
        ++lines;
    std::getline(stream, line);
    std::istringstream resolution(line);
    std::string y_axis, x_axis;
    long height = 0, width = 0;
    resolution >> y_axis >> height >> x_axis >> width;
    require(resolution && y_axis == "-Y" && x_axis == "+X" && height >= 1 && width >= 1 &&
                height <= max_side && width <= max_side,
            file.string() + ": resolution line \"" + line.substr(0, 80) +
                "\"; expected \"-Y height +X width\", 1 to " + std::to_string(max_side) + " px");
}

}  // namespace

Image<Rgb> read_hdr(const fs::path& file) {
    std::error_code ignored;
    require(fs::is_regular_file(file, ignored), file.string() + ": no such file",
            ExitCode::input_missing);
    require_radiance_header(file);
    cv::Mat bgr;
    try {
        bgr = cv::imread(file.string(), cv::IMREAD_UNCHANGED);
    } catch (const cv::Exception& fault) {
        throw Error(ExitCode::bad_data, file.string() + ": " + fault.what());
    }
    require(!bgr.empty() && bgr.type() == CV_32FC3,
            file.string() + ": the pixels are damaged or cut off; expected a Radiance picture");
    Image<Rgb> image(bgr.cols, bgr.rows);
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            const cv::Vec3f& p = bgr.at<cv::Vec3f>(y, x);
            image(x, y) = {p[2], p[1], p[0]};
        }
    }
    return image;
}

}  // namespace inlay
