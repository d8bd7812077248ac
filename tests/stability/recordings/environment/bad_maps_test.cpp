// Damaged and hostile environment files: refused with the file's name and the right exit code.
#include "recordings/base/check.h"
#include "recordings/environment/exr_image.h"
#include "recordings/environment/latlong_files.h"
#include "tests/support/temporary_folder.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfTiledOutputFile.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <vector>

namespace inlay {
namespace {

namespace fs = std::filesystem;
using test::file_text;
using test::TemporaryFolder;
using testing::HasSubstr;

void write(const fs::path& file, const std::string& bytes) {
    std::ofstream(file, std::ios::binary) << bytes;
}

/// Rising values 0, 1, 2, ... in each channel; `type` float or half.
void write_exr(const fs::path& file, const std::vector<std::string>& channels, int width,
               int height, std::vector<float> values = {}) {
    Imf::Header header(width, height);
    for (const std::string& c : channels)
        header.channels().insert(c, Imf::Channel(Imf::FLOAT));
    values.resize(std::size_t(width) * std::size_t(height), 0.5f);
    Imf::FrameBuffer frame;
    for (const std::string& c : channels)
        frame.insert(c, Imf::Slice::Make(Imf::FLOAT, values.data(), {0, 0}, width, height));
    Imf::OutputFile exr(file.string().c_str(), header);
    exr.setFrameBuffer(frame);
    exr.writePixels(height);
}

void expect_refused(const std::function<void()>& body, ExitCode code, const std::string& words) {
    try {
        body();
        ADD_FAILURE() << "accepted; expected: " << words;
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), code) << error.what();
        EXPECT_THAT(error.what(), HasSubstr(words));
    }
}

TEST(BadExr, EveryTruncationIsRefused) {
    const TemporaryFolder folder;
    write_exr(folder / "a.exr", {"R", "G", "B"}, 64, 32);
    const std::string whole = file_text(folder / "a.exr");
    EXPECT_EQ(read_exr(folder / "a.exr").width, 64);
    for (const double share : {0.0, 0.001, 0.1, 0.5, 0.9, 0.99}) {
        write(folder / "cut.exr", whole.substr(0, std::size_t(double(whole.size()) * share)));
        expect_refused([&] { read_exr(folder / "cut.exr"); }, ExitCode::bad_data, "cut.exr");
        expect_refused([&] { read_exr_channels(folder / "cut.exr"); }, ExitCode::bad_data,
                       "cut.exr");
    }
    expect_refused([&] { read_exr(folder / "none.exr"); }, ExitCode::input_missing, "none.exr");
    expect_refused([&] { read_exr(folder.path()); }, ExitCode::input_missing, "no such file");
}

/// The file with the data window's and display window's right and bottom replaced.
std::string with_window(std::string bytes, std::int32_t right, std::int32_t bottom) {
    for (const char* name : {"dataWindow", "displayWindow"}) {
        const std::size_t at =
            bytes.find(name) + std::strlen(name) + 1 + std::strlen("box2i") + 1 + 4;
        std::memcpy(bytes.data() + at + 8, &right, 4);
        std::memcpy(bytes.data() + at + 12, &bottom, 4);
    }
    return bytes;
}

TEST(BadExr, SizesThatLieAreRefusedWithoutTakingMemory) {
    const TemporaryFolder folder;
    write_exr(folder / "a.exr", {"R", "G", "B"}, 64, 32);
    const std::string whole = file_text(folder / "a.exr");
    for (const auto& [right, bottom] :
         {std::pair(2000000000, 2000000000), std::pair(59999, 59999), std::pair(16383, 8191),
          std::pair(-1, 31), std::pair(63, -5), std::pair(2147483647, 31)}) {
        write(folder / "b.exr", with_window(whole, right, bottom));
        expect_refused([&] { read_exr(folder / "b.exr"); }, ExitCode::bad_data, "b.exr");
    }
}

TEST(BadExr, ChannelsOtherThanColorAreRefusedByName) {
    const TemporaryFolder folder;
    write_exr(folder / "z.exr", {"Z"}, 8, 4);
    expect_refused([&] { read_exr(folder / "z.exr"); }, ExitCode::bad_data, "Z");
    EXPECT_EQ(read_exr_channels(folder / "z.exr").at(0).name, "Z");
}

TEST(ReadExr, LuminanceAloneIsGrey) {
    const TemporaryFolder folder;
    write_exr(folder / "y.exr", {"Y"}, 8, 4, {0.25f});
    EXPECT_EQ(read_exr(folder / "y.exr")(0, 0), Rgb(0.25f));
}

TEST(ReadExr, TakesHalfUintTilesAndACroppedDataWindow) {
    const TemporaryFolder folder;
    Imf::Header header(Imath::Box2i({0, 0}, {31, 15}), Imath::Box2i({4, 2}, {35, 9}));
    for (const char* c : {"R", "G"})
        header.channels().insert(c, Imf::Channel(Imf::HALF));
    header.channels().insert("B", Imf::Channel(Imf::UINT));
    header.setTileDescription(Imf::TileDescription(8, 8, Imf::ONE_LEVEL));
    const std::vector<half> color(32 * 8, half(0.5f));
    const std::vector<unsigned> blue(32 * 8, 3);
    Imf::FrameBuffer frame;
    for (const char* c : {"R", "G"})
        frame.insert(c, Imf::Slice::Make(Imf::HALF, color.data(), {4, 2}, 32, 8));
    frame.insert("B", Imf::Slice::Make(Imf::UINT, blue.data(), {4, 2}, 32, 8));
    {
        Imf::TiledOutputFile exr((folder / "t.exr").c_str(), header);
        exr.setFrameBuffer(frame);
        exr.writeTiles(0, exr.numXTiles() - 1, 0, exr.numYTiles() - 1);
    }
    const Image<Rgb> image = read_exr(folder / "t.exr");
    ASSERT_EQ(image.width, 32);
    ASSERT_EQ(image.height, 16);
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 32; ++x)
            EXPECT_EQ(image(x, y), x >= 4 && y >= 2 && y < 10 ? Rgb(0.5f, 0.5f, 3) : Rgb(0));
}

TEST(BadMaps, ShapeAndValuesAreChecked) {
    const TemporaryFolder folder;
    write_exr(folder / "square.exr", {"R", "G", "B"}, 16, 16);
    expect_refused([&] { load_latlong(folder / "square.exr"); }, ExitCode::bad_data, "16 x 16");
    expect_refused([&] { load_latlong(folder / "square.png"); }, ExitCode::bad_data,
                   ".exr or .hdr");
    write_exr(folder / "nan.exr", {"R", "G", "B"}, 8, 4, {NAN, INFINITY, -1, 1, -INFINITY});
    const LatlongFile mended = load_latlong(folder / "nan.exr");
    EXPECT_EQ(mended.replaced_texels, 4);
    EXPECT_EQ(mended.radiance(0, 0), Rgb(0));
    EXPECT_EQ(mended.radiance(3, 0), Rgb(1));
}

TEST(BadMaps, RadianceFilesAreReadOrRefused) {
    const TemporaryFolder folder;
    const std::string header = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n";
    std::string pixels;
    for (int i = 0; i < 4 * 2; ++i)
        pixels += std::string("\x80\x40\x20\x82", 4);  // (0.5, 0.25, 0.125) x 4
    write(folder / "a.hdr", header + "-Y 2 +X 4\n" + pixels);
    const LatlongFile map = load_latlong(folder / "a.hdr");
    EXPECT_NEAR(map.radiance(3, 1).r, 2.0f, 0.02f);  // one step of the shared exponent's mantissa
    EXPECT_NEAR(map.radiance(3, 1).b, 0.5f, 0.02f);
    write(folder / "cut.hdr", header + "-Y 2 +X 4\n" + pixels.substr(0, 9));
    expect_refused([&] { load_latlong(folder / "cut.hdr"); }, ExitCode::bad_data, "cut.hdr");
    for (const char* line :
         {"-Y 200000 +X 400000\n", "+Y 2 +X 4\n", "-Y 2\n", "", "-Y x +X y\n", "-Y -2 +X 4\n"}) {
        write(folder / "b.hdr", header + line + pixels);
        expect_refused([&] { load_latlong(folder / "b.hdr"); }, ExitCode::bad_data, "b.hdr");
    }
    write(folder / "c.hdr", "no picture");
    expect_refused([&] { load_latlong(folder / "c.hdr"); }, ExitCode::bad_data, "c.hdr");
}

}  // namespace
}  // namespace inlay
