#include <gtest/gtest.h>

#include "loader_fixtures.h"
#include "scene/scene.h"

namespace gradslc {
namespace {

constexpr std::string_view k_group = R"(<bsdf type="diffuse" id="red"><rgb name="reflectance" value="1 0 0"/></bsdf>
<shape type="shapegroup" id="group">
  <shape type="rectangle" id="floor"><ref id="red"/></shape>
  <shape type="disk" id="lid"><transform name="to_world"><translate z="1"/></transform></shape>
</shape>
)";

std::string with_group(std::string_view more) { return std::string(k_group).append(more); }

TEST(Instances, AreMovedCopiesOfTheGroupWithItsMaterials) {
  const SceneDescription scene = test::load(with_group(R"(
      <shape type="instance" id="far"><ref id="group"/>
        <transform name="to_world"><scale value="2"/><translate x="10"/></transform></shape>
      <shape type="instance"><ref id="group"/></shape>)"));
  ASSERT_EQ(scene.meshes.size(), 4u);
  EXPECT_EQ(scene.meshes[0].name, "floor in far");
  EXPECT_EQ(scene.meshes[3].name, "lid in instance at line 10");
  EXPECT_EQ(scene.meshes[0].positions[0], (Point3{8, -2, 0}));
  EXPECT_EQ(scene.meshes[1].bounds().lower.z, 2);
  EXPECT_EQ(scene.meshes[2].positions[0], (Point3{-1, -1, 0}));
  EXPECT_EQ(test::reflectance(scene.materials[scene.meshes[0].material]), Rgb(1, 0, 0));
  EXPECT_EQ(test::reflectance(scene.materials[scene.meshes[1].material]), Rgb(0.5f));
}

TEST(Instances, AGroupIsNotSeenByItself) { EXPECT_TRUE(test::load(k_group).meshes.empty()); }

TEST(Instances, MirroringKeepsTheSideOfNormals) {
  const auto normal = [](std::string_view transform) {
    const Scene scene(test::load(with_group(fmt::format(
        R"(<shape type="instance"><ref id="group"/><transform name="to_world">{}</transform></shape>)", transform))));
    return scene.intersect({{0.9f, 0.9f, 9}, {0, 0, -1}})->geometric_normal.z;
  };
  EXPECT_EQ(normal(R"(<scale x="1"/>)"), 1);
  EXPECT_EQ(normal(R"(<scale x="-1"/>)"), 1);
  EXPECT_EQ(normal(R"(<scale z="-1"/>)"), -1);
}

TEST(Instances, SayWhatIsWrong) {
  const auto message = [](std::string_view body) {
    try {
      test::load(body);
    } catch (const Error& error) {
      return error.message();
    }
    return std::string("accepted");
  };
  EXPECT_EQ(message(with_group(R"(<shape type="instance"/>)")),
            "an instance needs one <ref> to a shape \"shapegroup\"");
  EXPECT_EQ(message(with_group(R"(<shape type="instance"><ref id="floor"/></shape>)")),
            "an instance needs one <ref> to a shape \"shapegroup\"");
  EXPECT_EQ(message(with_group(R"(<shape type="instance"><ref id="group"/><ref id="red"/></shape>)")),
            "shape \"instance\" has no use for a <bsdf>");
  EXPECT_EQ(message(R"(<shape type="shapegroup"><shape type="instance"/></shape>)"),
            "a shapegroup cannot hold a shape \"instance\"");
  EXPECT_EQ(message(R"(<shape type="shapegroup"><shape type="disk"><emitter type="area"/></shape></shape>)"),
            "a shape in a shapegroup cannot emit light");
}

}  // namespace
}  // namespace gradslc
