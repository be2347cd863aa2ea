// What the loader says of scenes that are wrong: file, line, column, element, and what would be right.

#include "loader_fixtures.h"

namespace gradslc {
namespace {

using test::load;
using test::reflectance;
using test::refusal;
using test::TemporaryFolder;

TEST(LoaderErrors, PointAtTheAttributeAndShowTheLine) {
  try {
    load("<shape type=\"rectangle\">\n\t<bsdf type=\"difuse\"/></shape>");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.where().file, "test.xml");
    EXPECT_EQ(error.where().line, 3);
    EXPECT_EQ(error.where().column, 8);
    EXPECT_EQ(error.where().pointer, "/scene/shape/bsdf");
    EXPECT_EQ(error.message(), "unknown bsdf \"difuse\"; did you mean \"diffuse\"?");
    EXPECT_NE(std::string(error.what()).find("<bsdf type=\"difuse\"/>"), std::string::npos);
  }
}

struct WrongScene {
  const char* body;
  const char* error;
};

TEST(LoaderErrors, NameWhatIsNotKnown) {
  const WrongScene cases[] = {
      {R"(<shape type="rectangel"/>)",
       "test.xml:2:8: error: /scene/shape: unknown shape \"rectangel\"; did you mean \"rectangle\"?"},
      {R"(<shape type="rectangle"><bsdf type="diffuse"><rgb name="reflectence" value="1"/></bsdf></shape>)",
       "test.xml:2:51: error: /scene/shape/bsdf/rgb: bsdf \"diffuse\" has no property \"reflectence\"; did you mean "
       "\"reflectance\"?"},
      {R"(<shape type="rectangle"><float name="radius" value="1"/></shape>)",
       "test.xml:2:32: error: /scene/shape/float: shape \"rectangle\" has no property \"radius\"; known: bsdf, "
       "emitter, flip_normals, to_world"},
      {R"(<shape type="rectangle"><transform name="toWorld"/></shape>)",
       "test.xml:2:36: error: /scene/shape/transform: shape \"rectangle\" has no property \"toWorld\"; did you mean "
       "\"to_world\"?"},
      {R"(<shape type="rectangle"><sampler type="sobol"/></shape>)",
       "test.xml:2:26: error: /scene/shape/sampler: shape \"rectangle\" has no use for a <sampler>"},
      {R"(<shape type="rectangle"><emitter type="point"/></shape>)",
       "test.xml:2:34: error: /scene/shape/emitter: unknown emitter \"point\" in a shape; known: area"},
      {R"(<emitter type="spots"/>)",
       "test.xml:2:10: error: /scene/emitter: unknown emitter \"spots\"; did you mean \"spot\"?"},
      {R"(<emitter type="area"/>)", "test.xml:2:2: error: /scene/emitter: an area emitter must stand inside a <shape>"},
      {R"(<medium type="homogeneous"/>)", "test.xml:2:2: error: /scene/medium: unknown element <medium> in <scene>"},
      {R"(<shape type="rectangle"><colour name="x"/></shape>)",
       "test.xml:2:26: error: /scene/shape/colour: unknown element <colour> in shape \"rectangle\""},
      {R"(<shape type="rectangle"><ref id="whyte"/></shape><bsdf type="diffuse" id="white"/>)",
       "test.xml:2:30: error: /scene/shape/ref: reference to an unknown id \"whyte\"; did you mean \"white\"?"},
      {R"(<alias id="nobody" as="x"/>)",
       "test.xml:2:8: error: /scene/alias: alias of an unknown id \"nobody\"; there are no ids"},
      {R"(<shape type="rectangle"><transform name="to_world"><shear x="1"/></transform></shape>)",
       "test.xml:2:53: error: /scene/shape/transform/shear: unknown transform <shear>; known: translate, rotate, "
       "scale, matrix, lookat"},
      {R"(<include filename="no.xml"/>)",
       "test.xml:2:10: error: /scene/include: included file \"no.xml\" does not exist"},
      {R"(<shape type="obj"><string name="filename" value="no.obj"/></shape>)",
       "test.xml:2:43: error: /scene/shape/string: file \"no.obj\" does not exist"},
      {R"(<bsdf type="diffuse"><rgb name="reflectance" value="$x"/></bsdf>)",
       "test.xml:2:46: error: /scene/bsdf/rgb: parameter \"$x\" has no value; no <default> stands before it"},
      {R"(<default name="size" value="1"/><bsdf type="diffuse"><rgb name="reflectance" value="$sizd"/></bsdf>)",
       "test.xml:2:78: error: /scene/bsdf/rgb: parameter \"$sizd\" has no value; did you mean \"size\"?"},
  };
  for (const WrongScene& wrong : cases) EXPECT_EQ(refusal(wrong.body), wrong.error);
}

TEST(LoaderErrors, SayWhatValuesShouldBe) {
  const auto diffuse = [](const char* property) {
    return refusal(fmt::format(R"(<bsdf type="diffuse">{}</bsdf>)", property));
  };
  const auto shape = [](const char* content) {
    return refusal(fmt::format(R"(<shape type="rectangle">{}</shape>)", content));
  };
  const auto transform = [](const char* step) {
    return refusal(
        fmt::format("<shape type=\"rectangle\"><transform name=\"to_world\">\n{}</transform></shape>", step));
  };
  EXPECT_EQ(diffuse(R"(<string name="reflectance" value="red"/>)"),
            "test.xml:2:49: error: /scene/bsdf/string: \"reflectance\" is given as <string>, needs an <rgb>, "
            "<spectrum> or <float>");
  EXPECT_EQ(
      diffuse(R"(<rgb name="reflectance" value="1 2"/>)"),
      "test.xml:2:46: error: /scene/bsdf/rgb: \"reflectance\" must be one or three numbers (or #rrggbb), not \"1 2\"");
  EXPECT_EQ(diffuse(R"(<rgb name="reflectance" value="1 2 x"/>)"),
            "test.xml:2:46: error: /scene/bsdf/rgb: \"reflectance\" must be one or three numbers (or #rrggbb), not \"1 "
            "2 x\"");
  EXPECT_EQ(diffuse(R"(<rgb name="reflectance" value="#12345g"/>)"),
            "test.xml:2:46: error: /scene/bsdf/rgb: \"reflectance\" must be one or three numbers (or #rrggbb), not "
            "\"#12345g\"");
  EXPECT_EQ(diffuse(R"(<spectrum name="reflectance" value="400:1, 700:0.5"/>)"),
            "test.xml:2:51: error: /scene/bsdf/spectrum: \"reflectance\": spectra by wavelength are not supported; "
            "give an <rgb>");
  EXPECT_EQ(diffuse(R"(<rgb name="reflectance"/>)"),
            "test.xml:2:23: error: /scene/bsdf/rgb: attribute \"value\" is missing");
  EXPECT_EQ(diffuse(R"(<rgb name="reflectance" value=""/>)"),
            "test.xml:2:46: error: /scene/bsdf/rgb: attribute \"value\" is empty");
  EXPECT_EQ(diffuse(R"(<float name="reflectance" value="nan"/>)"),
            "test.xml:2:48: error: /scene/bsdf/float: \"reflectance\" must be one number, not \"nan\"");
  EXPECT_EQ(diffuse(R"(<rgb value="1"/>)"), "test.xml:2:23: error: /scene/bsdf/rgb: a <rgb> needs a name");
  EXPECT_EQ(diffuse(R"(<rgb name="reflectance" value="1"/><rgb name="reflectance" value="1"/>)"),
            "test.xml:2:62: error: /scene/bsdf/rgb[2]: property \"reflectance\" is given twice");
  EXPECT_EQ(shape(R"(<boolean name="flip_normals" value="yes"/>)"),
            "test.xml:2:54: error: /scene/shape/boolean: \"flip_normals\" must be true or false, not \"yes\"");
  EXPECT_EQ(shape(R"(<bsdf type="diffuse"/><bsdf type="diffuse"/>)"),
            "test.xml:2:2: error: /scene/shape: a shape has one bsdf, not 2");
  EXPECT_EQ(shape(R"(<emitter type="area"><rgb name="radiance" value="1 -1 1"/></emitter>)"),
            "test.xml:2:67: error: /scene/shape/emitter/rgb: radiance must not be negative");
  EXPECT_EQ(shape("text"), "test.xml:2:2: error: /scene/shape: text \"text\" between elements");
  EXPECT_EQ(transform(R"(<matrix value="1 2 3"/>)"),
            "test.xml:3:9: error: /scene/shape/transform/matrix: a matrix has 16 (or 9) numbers, row by row, not 3");
  EXPECT_EQ(transform(R"(<matrix value="1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 2"/>)"),
            "test.xml:3:9: error: /scene/shape/transform/matrix: the last row of a matrix must be 0 0 0 1");
  EXPECT_EQ(transform(R"(<rotate angle="3"/>)"),
            "test.xml:3:2: error: /scene/shape/transform/rotate: the axis of a rotation must not be zero");
  EXPECT_EQ(transform(R"(<rotate x="1"/>)"),
            "test.xml:3:2: error: /scene/shape/transform/rotate: attribute \"angle\" is missing");
  EXPECT_EQ(transform(R"(<translate x="1m"/>)"),
            "test.xml:3:12: error: /scene/shape/transform/translate: x must be a number");
  EXPECT_EQ(transform(R"(<translate value="1 2"/>)"),
            "test.xml:3:12: error: /scene/shape/transform/translate: value must be three numbers, not 2");
  EXPECT_EQ(transform(R"(<lookat origin="1 2 3" target="1 2 3"/>)"),
            "test.xml:3:2: error: /scene/shape/transform/lookat: origin, target and up do not define a direction: "
            "target equals origin, or up is parallel to it");
}

TEST(LoaderErrors, RefuseWhatIsNoScene) {
  const auto load_text = [](const char* text) -> std::string {
    try {
      load_scene_text(text, "test.xml");
    } catch (const Error& error) {
      const std::string what = error.what();
      return what.substr(0, what.find('\n'));
    }
    return "accepted";
  };
  EXPECT_EQ(load_text("<scene version=\"3.0.0\">\n<a></b></scene>").substr(0, 45),
            "test.xml:2:6: error: not well-formed XML: Sta");
  EXPECT_EQ(load_text("").substr(0, 41), "test.xml:1:1: error: not well-formed XML:");
  EXPECT_EQ(load_text("<world/>"), "test.xml:1:2: error: /world: the outermost element must be <scene>");
  EXPECT_EQ(load_text("<scene/>"), "test.xml:1:2: error: /scene: attribute \"version\" is missing");
  EXPECT_EQ(load_text("<scene version=\"7.0\"/>"),
            "test.xml:1:8: error: /scene: version \"7.0\" is not supported, only 0.x, 2.x and 3.x are");
  EXPECT_EQ(load_text("<scene version=\"3.0\"/>"), "test.xml:1:2: error: /scene: the scene has no <sensor>");
  EXPECT_EQ(load_text("<scene version=\"3.0\">hello</scene>"),
            "test.xml:1:2: error: /scene: text \"hello\" between elements");
  try {
    load_scene("no-such-file.xml");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::input);
    EXPECT_EQ(error.where().file, "no-such-file.xml");
  }
}

TEST(LoaderErrors, RefuseIdsThatClashAndBsdfsThatContainThemselves) {
  EXPECT_EQ(refusal("<bsdf type=\"diffuse\" id=\"a\"/>\n<shape type=\"cube\" id=\"a\"/>"),
            "test.xml:3:20: error: /scene/shape: id \"a\" is taken already, at test.xml:2");
  EXPECT_EQ(refusal(R"(<bsdf type="twosided" id="a"><ref id="a"/></bsdf>)"),
            "test.xml:2:2: error: /scene/bsdf: this bsdf contains itself");
  std::string chain;
  for (int i = 0; i < 100; ++i)
    chain += fmt::format("<bsdf type=\"twosided\" id=\"b{}\"><ref id=\"b{}\"/></bsdf>\n", i, i + 1);
  EXPECT_EQ(refusal(chain + R"(<bsdf type="diffuse" id="b100"/>)"),
            "test.xml:66:2: error: /scene/bsdf[65]: bsdfs are nested more than 64 deep");
}

TEST(LoaderErrors, RefuseIncludesWithoutEnd) {
  const TemporaryFolder folder;
  const std::string file = folder.write("loop.xml", R"(<scene version="3.0.0"><include filename="loop.xml"/></scene>)");
  try {
    load_scene(file);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.message(), "includes are nested more than 16 deep; does a file include itself?");
  }
}

TEST(LoaderErrors, RefuseElementsNestedWithoutEnd) {
  std::string deep;
  for (int i = 0; i < 100000; ++i) deep += "<bsdf type=\"twosided\">";
  for (int i = 0; i < 100000; ++i) deep += "</bsdf>";
  EXPECT_NE(refusal(deep).find("elements are nested more than 64 deep"), std::string::npos);
}

TEST(LoaderErrors, RefuseValuesThatGrowWithoutEnd) {
  std::string body = R"(<default name="p0" value="0123456789"/>)";
  for (int i = 0; i < 30; ++i)
    body += fmt::format(R"(<default name="p{}x" value="$p{}$p{}"/>)", std::string(static_cast<std::size_t>(i) + 1, 'q'),
                        i == 0 ? "0" : std::string(static_cast<std::size_t>(i), 'q') + "x",
                        i == 0 ? "0" : std::string(static_cast<std::size_t>(i), 'q') + "x");
  EXPECT_NE(refusal(body).find("the value is longer than 65536 characters"), std::string::npos);
}

TEST(LoaderErrors, RefuseDefinitionsOfNothing) {
  LoadOptions options;
  options.definitions = {{"spq", "3"}};
  EXPECT_EQ(refusal(R"(<default name="spp" value="1"/>)", options),
            "test.xml:1:2: error: /scene: the scene has no parameter \"spq\" to define; did you mean \"spp\"?");
}

TEST(LoaderPermissive, TurnsWhatIsNotRecognisedIntoNotes) {
  LoadOptions options;
  options.permissive = true;
  const SceneDescription scene = load(R"(<medium type="fog"/><shape type="teapot"/><emitter type="aurora"/>
    <shape type="rectangle"><float name="radius" value="1"/><bsdf type="velvet"/></shape>)",
                                      options);
  ASSERT_EQ(scene.meshes.size(), 1u);
  EXPECT_EQ(reflectance(scene.materials[0]), Rgb(0.5f));
  ASSERT_EQ(scene.notes.size(), 5u);
  EXPECT_EQ(scene.notes[0], "test.xml:2: unknown element <medium> in <scene>; ignored");
  EXPECT_NE(scene.notes[3].find("diffuse 0.5 takes its place"), std::string::npos);
  EXPECT_NE(refusal(R"(<shape type="rectangle"><ref id="x"/></shape>)", options), "accepted");  // wrong is still wrong
}

}  // namespace
}  // namespace gradslc
