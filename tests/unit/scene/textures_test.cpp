// What the loader makes of <texture> elements.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <string_view>

#include "core/error.h"
#include "scene/loaders/loader.h"
#include "scene/loaders/mitsuba_properties.h"
#include "support/temporary_folder.h"
#include "unit/scene/image_bytes.h"

namespace gradslc {
namespace {

using namespace std::string_literals;

/// A folder with images: "two.tga", grey, 51 and 204 from left to right; "rgba.tga", one pixel (51, 102, 153, 204).
class Textures : public testing::Test {
 protected:
  Textures() {
    folder_.write("two.tga", test::tga(3, 2, 1, 8, 0x20, "\x33\xcc"s));
    folder_.write("rgba.tga", test::tga(2, 1, 1, 32, 0x28, "\x99\x66\x33\xcc"s));
    folder_.write("light.hdr", test::hdr("-Y 1 +X 1", "\x80\x40\x20\x82"s));
    folder_.write("broken.png", "\x89PNG\r\n\x1a\nno more");
  }

  /// `body` begins on line 2.
  SceneDescription load(std::string_view body, bool legacy = false, bool permissive = false) const {
    constexpr std::string_view k_sensor = R"(<sensor type="perspective"><float name="fov" value="40"/></sensor>)";
    return load_scene_text(
        fmt::format("<scene version=\"{}\">\n{}\n{}</scene>", legacy ? "0.6.0" : "3.0.0", body, k_sensor),
        (folder_.path() / "test.xml").string(),
        {.width = {}, .height = {}, .definitions = {}, .permissive = permissive});
  }
  /// The material of a rectangle.
  MaterialPtr material(std::string_view bsdf, bool legacy = false) const {
    return load(fmt::format(R"(<shape type="rectangle">{}</shape>)", bsdf), legacy).materials.at(0);
  }
  /// The reflectance of a diffuse material with a bitmap that has these properties.
  Texture bitmap(std::string_view properties, bool legacy = false, std::string_view file = "two.tga") const {
    return diffuse(fmt::format(R"(<texture name="reflectance" type="bitmap"><string name="filename" value="{}"/>{})"
                               "</texture>",
                               file, properties),
                   legacy);
  }
  Texture diffuse(std::string_view property, bool legacy = false) const {
    return material(fmt::format(R"(<bsdf type="diffuse">{}</bsdf>)", property), legacy)->textures().at(0);
  }
  /// The first line of the error, without the folder.
  std::string refusal(std::string_view body, bool legacy = false) const {
    try {
      load(body, legacy);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), Error::Kind::input);
      const std::string text = error.what(), folder = folder_.path().string() + "/";
      std::string line = text.substr(0, text.find('\n'));
      for (std::size_t at = line.find(folder); at != std::string::npos; at = line.find(folder))
        line.erase(at, folder.size());
      return line;
    }
    return "accepted";
  }
  std::string bitmap_refusal(std::string_view properties, std::string_view file = "two.tga") const {
    return refusal(
        fmt::format("<texture type=\"bitmap\" id=\"t\">\n<string name=\"filename\" value=\"{}\"/>\n{}</texture>", file,
                    properties));
  }

  fixtures::TemporaryFolder folder_;
};

const Rgb k_dark(srgb_to_linear(51 / 255.0f)), k_bright(srgb_to_linear(204 / 255.0f));
constexpr Vec2 k_left{0.25f, 0.5f}, k_right{0.75f, 0.5f};

TEST_F(Textures, BitmapsAreReflectancesInBothDialects) {
  for (const bool legacy : {false, true}) {
    const Texture texture = bitmap("", legacy);
    EXPECT_EQ(texture.eval(k_left), k_dark);
    EXPECT_EQ(texture.eval(k_right), k_bright);
    EXPECT_EQ(texture.eval({0, 0.5f}), texture.eval({1, 0.5f})) << "repeats";
  }
}

TEST_F(Textures, EncodingIsSrgbForIntegersUnlessTheFileSaysOtherwise) {
  EXPECT_EQ(bitmap(R"(<boolean name="raw" value="true"/>)").eval(k_left), Rgb(0.2f));
  EXPECT_EQ(bitmap(R"(<float name="gamma" value="1"/>)", true).eval(k_left), Rgb(0.2f));
  EXPECT_EQ(bitmap(R"(<float name="gamma" value="-1"/>)", true).eval(k_left), k_dark);
  EXPECT_EQ(bitmap(R"(<float name="gamma" value="0"/>)", true).eval(k_left), k_dark);
  EXPECT_FLOAT_EQ(bitmap(R"(<float name="gamma" value="2"/>)", true).eval(k_left).r, 0.04f);
  EXPECT_EQ(bitmap("", false, "light.hdr").eval({}), Rgb(2, 1, 0.5f));
  EXPECT_EQ(bitmap(R"(<float name="gamma" value="2"/>)", true, "light.hdr").eval({}), Rgb(4, 1, 0.25f));
}

TEST_F(Textures, ChannelsServeAsGrey) {
  const auto channel = [&](const char* name, const char* file = "rgba.tga") {
    return bitmap(fmt::format(R"(<string name="channel" value="{}"/><float name="gamma" value="1"/>)", name), true,
                  file)
        .eval({});
  };
  EXPECT_EQ(channel("r"), Rgb(0.2f));
  EXPECT_EQ(channel("b"), Rgb(0.6f));
  EXPECT_EQ(channel("a"), Rgb(0.8f));
  EXPECT_EQ(channel("y", "two.tga"), bitmap(R"(<boolean name="raw" value="true"/>)").eval({}));
  EXPECT_EQ(bitmap(R"(<string name="channel" value="a"/>)", true, "rgba.tga").eval({}), Rgb(0.8f)) << "alpha is linear";
  EXPECT_EQ(bitmap(R"(<string name="channel" value="r"/>)", true, "rgba.tga").eval({}), k_dark);
}

TEST_F(Textures, WrapModes) {
  const auto at = [&](std::string_view properties, Vec2 uv) {
    return bitmap(fmt::format(R"({}<string name="filterType" value="nearest"/>)", properties), true).eval(uv);
  };
  const auto mode = [](const char* name, const char* value) {
    return fmt::format(R"(<string name="{}" value="{}"/>)", name, value);
  };
  EXPECT_EQ(at("", {1.25f, 0}), k_dark);
  EXPECT_EQ(at(mode("wrapMode", "mirror"), {1.25f, 0}), k_bright);
  EXPECT_EQ(at(mode("wrapMode", "clamp"), {7, 0}), k_bright);
  for (const char* name : {"zero", "black"}) EXPECT_EQ(at(mode("wrapMode", name), {7, 0}), Rgb(0));
  for (const char* name : {"one", "white"}) EXPECT_EQ(at(mode("wrapMode", name), {0.25f, 7}), Rgb(1));
  const std::string both = mode("wrapMode", "one") + mode("wrapModeU", "clamp");
  EXPECT_EQ(at(both, {-7, 0.5f}), k_dark);
  EXPECT_EQ(at(both, {0.25f, 7}), Rgb(1));
  EXPECT_EQ(at(mode("wrapModeV", "zero"), {0.25f, 7}), Rgb(0));
  EXPECT_EQ(bitmap(mode("wrap_mode", "clamp") + mode("filter_type", "nearest")).eval({7, 0}), k_bright);
}

TEST_F(Textures, UvsAreScaledThenOffset) {
  const Texture legacy = bitmap(R"(<float name="uscale" value="0.5"/><float name="uoffset" value="0.5"/>)", true);
  EXPECT_EQ(legacy.eval({0.5f, 0}), k_bright);
  EXPECT_EQ(bitmap(R"(<float name="uvscale" value="0.25"/>)", true).eval({1, 0}), k_dark);
  const Texture turned = bitmap(R"(<transform name="to_uv"><matrix value="0 0.5 0.5  1 0 0  0 0 1"/></transform>)");
  EXPECT_EQ(turned.eval({0.1f, 0.5f}), k_bright) << "u' = 0.5 v + 0.5";
  EXPECT_EQ(bitmap(R"(<transform name="to_uv"><scale x="0.25" y="3"/></transform>)").eval({1, 0}), k_dark);
}

TEST_F(Textures, ATranslationOfUvsByTheFourthColumnIsNoted) {
  const auto scene = load(R"(<texture type="checkerboard" id="t">
      <transform name="to_uv"><translate x="0.5"/></transform></texture>)");
  ASSERT_EQ(scene.notes.size(), 1u);
  EXPECT_NE(scene.notes[0].find("the translation in to_uv has no effect"), std::string::npos);
}

TEST_F(Textures, CheckerboardsHoldColoursAndTextures) {
  const Texture board = diffuse(R"(<texture name="reflectance" type="checkerboard">
      <rgb name="color0" value="0.1 0.2 0.3"/>
      <texture name="color1" type="bitmap"><string name="filename" value="two.tga"/></texture>
      <float name="uvscale" value="2"/></texture>)",
                                true);
  EXPECT_EQ(board.eval({0.01f, 0.01f}), Rgb(0.1f, 0.2f, 0.3f));
  EXPECT_EQ(board.eval({0.75f, 0.01f}), k_bright);
  const Texture plain = diffuse(R"(<texture name="reflectance" type="checkerboard"/>)");
  EXPECT_EQ(plain.eval({0.1f, 0.1f}), Rgb(0.4f));
  EXPECT_EQ(plain.eval({0.6f, 0.1f}), Rgb(0.2f));
}

TEST_F(Textures, ScaleMultipliesTheTextureInside) {
  const Texture scaled = diffuse(R"(<texture name="reflectance" type="scale"><float name="scale" value="0.5"/>
      <texture type="bitmap"><string name="filename" value="two.tga"/></texture></texture>)",
                                 true);
  EXPECT_EQ(scaled.eval(k_right), 0.5f * k_bright);
}

TEST_F(Textures, AreBuiltOnceAndFoundByIdWhereverTheyStand) {
  const SceneDescription scene = load(R"(
      <shape type="rectangle"><bsdf type="diffuse"><ref name="reflectance" id="inner"/></bsdf></shape>
      <bsdf type="twosided"><bsdf type="diffuse">
        <texture name="reflectance" type="bitmap" id="inner"><string name="filename" value="two.tga"/></texture>
      </bsdf></bsdf>
      <shape type="rectangle"><bsdf type="diffuse"><ref name="reflectance" id="inner"/></bsdf></shape>
      <shape type="rectangle"><bsdf type="diffuse"><ref name="reflectance" id="outer"/></bsdf></shape>
      <texture type="checkerboard" id="outer"><ref name="color0" id="inner"/></texture>)");
  const auto map = [&](std::size_t i) { return scene.materials.at(i)->textures().at(0).map(); };
  EXPECT_NE(map(0), nullptr);
  EXPECT_EQ(map(0), map(1));
  EXPECT_EQ(map(2)->eval({0.25f, 0.25f}), k_dark);
}

TEST_F(Textures, FilesAreRememberedOnceInTheOrderOfTheScene) {
  const auto file = folder_.write(
      "scene.xml", R"(<scene version="3.0.0"><sensor type="perspective"><float name="fov" value="40"/></sensor>
      <texture type="bitmap" id="b"><string name="filename" value="two.tga"/></texture>
      <texture type="bitmap" id="c"><string name="filename" value="light.hdr"/></texture>
      <texture type="bitmap" id="d"><string name="filename" value="two.tga"/></texture></scene>)");
  EXPECT_EQ(load_scene(file.string()).files,
            (std::vector<std::filesystem::path>{file, folder_.path() / "two.tga", folder_.path() / "light.hdr"}));
}

TEST_F(Textures, ThoseInsideAreTheOnesThatNoPropertyHasRead) {
  const LoadOptions options;
  MitsubaDocument document("test.xml", R"(<scene version="3.0.0"><texture type="x">
      <texture name="a" type="b"/><texture type="c"/></texture></scene>)",
                           options);
  MitsubaProperties properties(document, document.objects().at(0));
  EXPECT_TRUE(properties.texture_element("a"));
  const std::vector<XmlElement> rest = properties.unread_objects("texture");
  ASSERT_EQ(rest.size(), 1u);
  EXPECT_EQ(document.attribute(rest[0], "type"), "c");
  EXPECT_TRUE(properties.unread_objects("texture").empty());
}

TEST_F(Textures, BumpMapsTakeTheirTextureByAnyName) {
  for (const char* name : {R"(name="map")", R"(name="anything")", ""}) {
    const MaterialPtr bumped = material(fmt::format(R"(<bsdf type="bumpmap"><texture {} type="scale">
        <float name="scale" value="3"/><texture type="bitmap"><string name="filename" value="two.tga"/></texture></texture>
        <bsdf type="twosided" id="inner"><bsdf type="diffuse"/></bsdf></bsdf>)",
                                                    name),
                                        true);
    EXPECT_TRUE(bumped->bends_normals());
    Shading shading;
    bumped->shade({{0.5f, 0.5f}, {1, 0, 0}, {0, 1, 0}}, {0, 0, 1}, shading);
    const float slope = 3 * 2 * (k_bright.r - k_dark.r);  // over half a unit
    EXPECT_NEAR(shading.frame.n.x / shading.frame.n.z, -slope, 1e-5f);
  }
}

TEST_F(Textures, AShapeThatRefersToTheMaterialInsideABumpMapHasNoBumps) {
  const SceneDescription scene = load(R"(<bsdf type="bumpmap"><texture type="checkerboard"/>
      <bsdf type="twosided" id="inner"><bsdf type="diffuse"/></bsdf></bsdf>
      <shape type="rectangle"><ref id="inner"/></shape>)");
  EXPECT_FALSE(scene.materials.at(0)->bends_normals());
  EXPECT_EQ(scene.material_names.at(0).kind, "twosided diffuse");
}

TEST_F(Textures, NormalMapsBendNormals) {
  EXPECT_TRUE(material(R"(<bsdf type="normalmap"><texture name="normalmap" type="bitmap">
      <boolean name="raw" value="true"/><string name="filename" value="rgba.tga"/></texture><bsdf type="diffuse"/></bsdf>)")
                  ->bends_normals());
}

TEST_F(Textures, FiltersAreNotedOnceAndWhatHasNoEffectWhereItStands) {
  const auto notes = load(R"(<texture type="bitmap" id="a"><string name="filename" value="two.tga"/>
      <string name="filterType" value="trilinear"/><float name="maxAnisotropy" value="20"/></texture>
      <texture type="bitmap" id="b"><string name="filename" value="two.tga"/><string name="filterType" value="ewa"/></texture>)",
                          true)
                         .notes;
  ASSERT_EQ(notes.size(), 2u);
  EXPECT_NE(notes[0].find("test.xml:2: filter_type \"trilinear\": all bitmaps are interpolated bilinearly"),
            std::string::npos);
  EXPECT_NE(notes[1].find("texture \"bitmap\": \"max_anisotropy\" has no effect here"), std::string::npos);
}

TEST_F(Textures, SayWhatIsWrong) {
  EXPECT_EQ(refusal(R"(<texture type="bitmpa" id="t"/>)"),
            "test.xml:2:10: error: /scene/texture: unknown texture \"bitmpa\"; did you mean \"bitmap\"?");
  EXPECT_EQ(refusal(R"(<texture type="bitmap" id="t"/>)"),
            "test.xml:2:2: error: /scene/texture: a bitmap needs a filename");
  EXPECT_EQ(bitmap_refusal("", "no.png"),
            "test.xml:3:25: error: /scene/texture/string: file \"no.png\" does not exist");
  EXPECT_EQ(bitmap_refusal("", "broken.png"), "broken.png: error: is no readable PNG file: it is truncated");
  EXPECT_EQ(bitmap_refusal(R"(<string name="filter_type" value="cubic"/>)"),
            "test.xml:4:28: error: /scene/texture/string[2]: \"filter_type\" must be bilinear, nearest, trilinear or "
            "ewa, not \"cubic\"");
  EXPECT_EQ(bitmap_refusal(R"(<string name="wrap_mode" value="roll"/>)"),
            "test.xml:4:26: error: /scene/texture/string[2]: \"wrap_mode\" must be repeat, mirror, clamp, zero (black) "
            "or one (white), not \"roll\"");
  EXPECT_EQ(bitmap_refusal(R"(<string name="channel" value="a"/>)"),
            "test.xml:4:24: error: /scene/texture/string[2]: the image has no channel \"a\"; it has: y");
  EXPECT_EQ(bitmap_refusal(R"(<float name="gamma" value="-2"/>)"),
            "test.xml:4:21: error: /scene/texture/float: \"gamma\" must be positive, -1 (sRGB) or 0 (automatic)");
  EXPECT_EQ(bitmap_refusal(R"(<float name="gama" value="1"/>)"),
            "test.xml:4:8: error: /scene/texture/float: texture \"bitmap\" has no property \"gama\"; did you mean "
            "\"gamma\"?");
  EXPECT_EQ(refusal(R"(<texture type="scale" id="t"><ref id="t"/></texture>)"),
            "test.xml:2:2: error: /scene/texture: this texture contains itself");
  EXPECT_EQ(refusal(R"(<texture type="scale" id="t"/>)"),
            "test.xml:2:2: error: /scene/texture: a scale texture needs one texture inside");
  EXPECT_EQ(refusal(R"(<bsdf type="bumpmap"><bsdf type="diffuse"/></bsdf>)"),
            "test.xml:2:2: error: /scene/bsdf: a bumpmap needs one texture and one bsdf inside");
  EXPECT_EQ(refusal(R"(<bsdf type="normalmap"><texture type="checkerboard"/></bsdf>)"),
            "test.xml:2:2: error: /scene/bsdf: a normalmap needs one texture and one bsdf inside");
  EXPECT_EQ(refusal(R"(<bsdf type="twosided"><bsdf type="diffuse"/><texture type="checkerboard"/></bsdf>)"),
            "test.xml:2:46: error: /scene/bsdf/texture: bsdf \"twosided\" has no use for a <texture>");
  EXPECT_EQ(refusal(R"(<bsdf type="conductor"><texture name="eta" type="checkerboard"/></bsdf>)"),
            "test.xml:2:25: error: /scene/bsdf/texture: \"eta\" cannot be a texture; give an <rgb>");
}

TEST_F(Textures, TheFirstErrorInTheFileIsReported) {
  folder_.write("worse.png", "\x89PNG\r\n\x1a\nless");
  for (int i = 0; i < 10; ++i)
    EXPECT_EQ(refusal(R"(<texture type="bitmap" id="a"><string name="filename" value="worse.png"/></texture>
        <texture type="bitmap" id="b"><string name="filename" value="broken.png"/></texture>)")
                  .substr(0, 9),
              "worse.png");
}

TEST_F(Textures, PermissiveReplacesUnknownTextures) {
  const auto scene =
      load(R"(<shape type="rectangle"><bsdf type="diffuse"><texture name="reflectance" type="wood"/></bsdf></shape>)",
           false, true);
  EXPECT_EQ(scene.materials.at(0)->textures().at(0).eval({}), Rgb(0.5f));
}

}  // namespace
}  // namespace gradslc
