// EXR files: names, types and values of every layer; equal bytes; nothing but finite values.
#include "composite/write/write_exr.h"

#include "recordings/base/check.h"
#include "tests/support/temporary_folder.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfMatrixAttribute.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfVecAttribute.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>

namespace inlay {
namespace {

using test::TemporaryFolder;

Image<glm::vec3> ramp(int width, int height) {
    Image<glm::vec3> image(width, height);
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        image.pixels[i] = glm::vec3(0.37f, 1.7f, -3.1f) * float(i);
    return image;
}

Image<float> depth_ramp(int width, int height) {
    Image<float> image(width, height);
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        image.pixels[i] = 0.1f * float(i);
    return image;
}

Image<float> read_channel(const std::filesystem::path& path, const std::string& name) {
    Imf::InputFile file(path.string().c_str());
    const Imath::Box2i window = file.header().dataWindow();
    Image<float> image(window.max.x + 1, window.max.y + 1);
    Imf::FrameBuffer buffer;
    buffer.insert(name, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(image.pixels.data()),
                                   sizeof(float), sizeof(float) * std::size_t(image.width)));
    file.setFrameBuffer(buffer);
    file.readPixels(0, image.height - 1);
    return image;
}

std::map<std::string, Imf::PixelType> channel_types(const std::filesystem::path& path) {
    Imf::InputFile file(path.string().c_str());
    std::map<std::string, Imf::PixelType> types;
    const Imf::ChannelList& channels = file.header().channels();
    for (auto c = channels.begin(); c != channels.end(); ++c)
        types[c.name()] = c.channel().type;
    return types;
}

TEST(WriteExr, HasTheNamesAndTypesThatCompositorsExpect) {
    const TemporaryFolder folder;
    const Image<glm::vec3> colors = ramp(5, 4);
    const Image<float> depth = depth_ramp(5, 4);
    write_exr(folder / "a.exr", {.picture = &colors,
                                 .layers = {color_layer("E_R_direct", colors),
                                            vector_layer("N", colors), value_layer("Z", depth)}});
    const std::map<std::string, Imf::PixelType> expected{{"R", Imf::HALF},
                                                         {"G", Imf::HALF},
                                                         {"B", Imf::HALF},
                                                         {"E_R_direct.R", Imf::HALF},
                                                         {"E_R_direct.G", Imf::HALF},
                                                         {"E_R_direct.B", Imf::HALF},
                                                         {"N.X", Imf::FLOAT},
                                                         {"N.Y", Imf::FLOAT},
                                                         {"N.Z", Imf::FLOAT},
                                                         {"Z", Imf::FLOAT}};
    EXPECT_EQ(channel_types(folder / "a.exr"), expected);
}

TEST(WriteExr, ValuesReadBack) {
    const TemporaryFolder folder;
    const Image<glm::vec3> colors = ramp(13, 40);  // more rows than one ZIP block
    const Image<float> depth = depth_ramp(13, 40);
    write_exr(folder / "a.exr",
              {.picture = &colors, .layers = {vector_layer("P", colors), value_layer("Z", depth)}});
    const Image<float> green = read_channel(folder / "a.exr", "G");
    const Image<float> p_z = read_channel(folder / "a.exr", "P.Z");
    EXPECT_EQ(read_channel(folder / "a.exr", "Z").pixels, depth.pixels);  // float: lossless
    for (std::size_t i = 0; i < colors.pixels.size(); ++i) {
        EXPECT_EQ(p_z.pixels[i], colors.pixels[i].z);
        // half: 11 significant bits
        EXPECT_NEAR(green.pixels[i], colors.pixels[i].g, colors.pixels[i].g * 0x1p-11f);
    }
}

TEST(WriteExr, TruthMayKeepFullPrecision) {
    const TemporaryFolder folder;
    const Image<glm::vec3> colors = ramp(7, 3);
    write_exr(folder / "a.exr",
              {.picture = &colors, .picture_precision = ExrPrecision::full_float});
    const Image<float> blue = read_channel(folder / "a.exr", "B");
    for (std::size_t i = 0; i < colors.pixels.size(); ++i)
        EXPECT_EQ(blue.pixels[i], colors.pixels[i].b);
}

TEST(WriteExr, ColorsBeyondTheRangeOfHalfBecomeItsLargestValue) {
    const TemporaryFolder folder;
    const Image<Rgb> bright(1, 1, Rgb(1e9f, 65504.0f, -1e9f));
    write_exr(folder / "a.exr", {.picture = &bright});
    EXPECT_EQ(read_channel(folder / "a.exr", "R")(0, 0), 65504.0f);
    EXPECT_EQ(read_channel(folder / "a.exr", "G")(0, 0), 65504.0f);
    EXPECT_EQ(read_channel(folder / "a.exr", "B")(0, 0), -65504.0f);
}

TEST(WriteExr, SaysItsPrimariesFrameAndPose) {
    const TemporaryFolder folder;
    const Image<Rgb> grey(2, 2, Rgb(0.5f));
    Pose pose;
    pose.rotation = glm::dmat3(0, 1, 0, -1, 0, 0, 0, 0, 1);  // x to y
    pose.translation = {1, 2, 3};
    write_exr(
        folder / "a.exr",
        {.picture = &grey, .frame = 12, .world_from_camera = pose, .exposure = {1.5f, 1, 0.75f}});
    write_exr(folder / "b.exr", {.picture = &grey});
    const Imf::InputFile plain((folder / "b.exr").string().c_str());
    EXPECT_FALSE(plain.header().findTypedAttribute<Imf::V3fAttribute>("inlay/exposure"));
    Imf::InputFile file((folder / "a.exr").string().c_str());
    ASSERT_TRUE(Imf::hasChromaticities(file.header()));
    EXPECT_EQ(Imf::chromaticities(file.header()).red, Imath::V2f(0.64f, 0.33f));
    EXPECT_EQ(file.header().typedAttribute<Imf::IntAttribute>("inlay/frame").value(), 12);
    const Imath::M44f m =
        file.header().typedAttribute<Imf::M44fAttribute>("inlay/worldFromCamera").value();
    EXPECT_EQ(m, Imath::M44f(0, -1, 0, 1, 1, 0, 0, 2, 0, 0, 1, 3, 0, 0, 0, 1));
    EXPECT_EQ(file.header().typedAttribute<Imf::V3fAttribute>("inlay/exposure").value(),
              Imath::V3f(1.5f, 1, 0.75f));
}

TEST(WriteExr, EqualPixelsGiveEqualBytes) {
    const Image<glm::vec3> colors = ramp(31, 17);
    const ExrFile contents{.picture = &colors, .layers = {color_layer("camera", colors)}};
    EXPECT_EQ(encode_exr(contents), encode_exr(contents));
}

TEST(WriteExr, RefusesWhatIsNotFiniteAndNamesThePixel) {
    for (const float bad :
         {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        const TemporaryFolder folder;
        const Image<Rgb> good(4, 3, Rgb(0.5f));
        Image<float> z(4, 3, 1.0f);
        z(2, 1) = bad;
        try {
            write_exr(folder / "a.exr", {.picture = &good, .layers = {value_layer("Z", z)}});
            FAIL() << "a file was written";
        } catch (const Error& e) {
            EXPECT_EQ(e.code(), ExitCode::bad_data);
            EXPECT_NE(std::string(e.what()).find("(2, 1)"), std::string::npos) << e.what();
        }
        EXPECT_EQ(folder.entries(), 0);
    }
}

TEST(WriteExr, RefusesNamesThatCompositorsWouldChange) {
    const Image<float> z(2, 2, 1.0f);
    for (const char* name : {"", "2nd", "_Z", "depth-z", "a.b", "R", "N o"})
        EXPECT_THROW(encode_exr({.layers = {value_layer(name, z)}}), Error) << name;
    EXPECT_THROW(encode_exr({.layers = {value_layer("E_R", z), value_layer("ER", z)}}), Error);
    EXPECT_NO_THROW(encode_exr({.layers = {value_layer("E_R", z), value_layer("E_RV", z)}}));
}

TEST(WriteExr, RefusesLayersOfAnotherSize) {
    const Image<Rgb> picture(4, 4, Rgb(0.5f));
    const Image<float> z(4, 3, 1.0f);
    EXPECT_THROW(encode_exr({.picture = &picture, .layers = {value_layer("Z", z)}}), Error);
    EXPECT_THROW(encode_exr({}), Error);
}

}  // namespace
}  // namespace inlay
