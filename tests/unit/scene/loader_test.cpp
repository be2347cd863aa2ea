// What scene files mean, in both dialects.

#include "loader_fixtures.h"
#include "scene/inventory.h"

namespace gradslc {
namespace {

using test::k_sensor;
using test::load;
using test::reflectance;
using test::TemporaryFolder;

SceneDescription load_legacy(std::string_view body) { return load(body, {}, "0.6.0"); }

Rgb rectangle_reflectance(std::string_view colour, std::string_view version = "3.0.0") {
  const auto scene =
      load(fmt::format(R"(<shape type="rectangle"><bsdf type="diffuse">{}</bsdf></shape>)", colour), {}, version);
  return reflectance(scene.materials.at(scene.meshes.at(0).material));
}

TEST(Loader, BothDialectsOfTheSharedCornellBoxGiveTheSameScene) {
  const std::filesystem::path folder = std::filesystem::path(GRADSLC_SHARED_DIR) / "scenes/cornell-box";
  if (!std::filesystem::exists(folder))
    GTEST_SKIP() << "the shared folder with the Cornell box is not here: " << folder;
  const SceneDescription a = load_scene((folder / "scene_v0.6.xml").string());
  const SceneDescription b = load_scene((folder / "scene_v3.xml").string());
  ASSERT_EQ(a.meshes.size(), 8u);
  ASSERT_EQ(b.meshes.size(), 8u);
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_EQ(a.meshes[i].positions, b.meshes[i].positions);
    EXPECT_EQ(a.meshes[i].triangles, b.meshes[i].triangles);
    EXPECT_EQ(a.meshes[i].uvs, b.meshes[i].uvs);
    EXPECT_EQ(a.meshes[i].flip_normals, b.meshes[i].flip_normals);
    EXPECT_EQ(a.meshes[i].area_light, b.meshes[i].area_light);
    EXPECT_EQ(reflectance(a.materials[a.meshes[i].material]), reflectance(b.materials[b.meshes[i].material]));
    EXPECT_TRUE(test::is_two_sided(a.materials[a.meshes[i].material]));
    EXPECT_TRUE(test::is_two_sided(b.materials[b.meshes[i].material]));
  }
  EXPECT_EQ(a.area_lights.at(0).radiance, Rgb(17, 12, 4));
  EXPECT_EQ(b.area_lights.at(0).radiance, Rgb(17, 12, 4));
  for (const Vec2 film : {Vec2{0, 0}, Vec2{1024, 300}})
    EXPECT_EQ(a.camera.generate_ray(film).direction, b.camera.generate_ray(film).direction);
  EXPECT_EQ(a.camera.resolution(), (Resolution{1024, 1024}));
  const Scene scene(a);
  EXPECT_EQ(scene.triangle_count(), 36u);
  EXPECT_NEAR(scene.emitters().power().r, 17 * k_pi * 4 * 0.235 * 0.19, 1e-4);
}

TEST(Loader, ReadsOurOwnCornellBox) {
  const Scene scene(load_scene(GRADSLC_SOURCE_DIR "/scenes/cornell-box/scene.xml",
                               {.width = 32, .height = {}, .definitions = {}, .permissive = false}));
  EXPECT_EQ(scene.triangle_count(), 36u);
  EXPECT_EQ(scene.camera().resolution(), (Resolution{32, 32}));
  EXPECT_NEAR(scene.bounds().upper.x, 0.5528f, 1e-6f);
  EXPECT_NEAR(scene.bounds().upper.y, 0.5488f, 1e-6f);
  EXPECT_NEAR(scene.bounds().upper.z, 0.5592f, 1e-6f);
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x) {
      const Ray ray = scene.camera().generate_ray({static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f});
      const auto hit = scene.intersect(ray);
      if (!hit) continue;  // the margin around the opening
      EXPECT_LT(dot(hit->geometric_normal, ray.direction), 0) << "the inside of " << scene.meshes()[hit->mesh].name;
    }
  const auto name_at = [&](float x, float y) {
    return scene.meshes()[scene.intersect(scene.camera().generate_ray({x, y}))->mesh].name;
  };
  EXPECT_EQ(name_at(3, 16), "left_wall");
  EXPECT_EQ(name_at(29, 16), "right_wall");
  EXPECT_EQ(name_at(16, 2), "ceiling");
  EXPECT_EQ(name_at(16, 30), "floor");
  EXPECT_EQ(name_at(12, 16), "tall_block");
  EXPECT_EQ(name_at(20, 24), "short_block");
}

TEST(Loader, TakesAnInventoryOfTheScene) {
  const SceneInventory inventory =
      take_inventory(Scene(load_scene(GRADSLC_SOURCE_DIR "/scenes/cornell-box/scene.xml")));
  EXPECT_EQ(inventory.triangles, 36u);
  EXPECT_EQ(inventory.meshes, 8u);
  EXPECT_EQ(inventory.materials, (std::map<std::string, int>{{"diffuse", 1}, {"twosided diffuse", 3}}));
  EXPECT_EQ(inventory.emissive_triangles, 2u);
  EXPECT_NEAR(inventory.emitted_power.g, 12 * k_pi * 0.13 * 0.105, 1e-5);
  EXPECT_EQ(inventory.resolution, (Resolution{256, 256}));
  EXPECT_EQ(inventory.notes.size(), 3u);
  EXPECT_EQ(inventory.lights, (std::map<std::string, int>{{"area", 1}}));
  EXPECT_EQ(inventory.textures, 0u);
  EXPECT_FALSE(inventory.delta_light_on_delta_lobes);
  EXPECT_GT(inventory.geometry_bytes, 36u * 12);
}

TEST(Loader, AShapeWithoutBsdfIsHalfGrey) {
  const SceneDescription scene = load(R"(<shape type="rectangle"/><shape type="cube" id="box"/>)");
  ASSERT_EQ(scene.meshes.size(), 2u);
  EXPECT_EQ(scene.materials.size(), 1u);
  EXPECT_EQ(reflectance(scene.materials[scene.meshes[0].material]), Rgb(0.5f));
  EXPECT_EQ(scene.meshes[0].name, "rectangle at line 2");
  EXPECT_EQ(scene.meshes[1].name, "box");
}

TEST(Loader, ReadsColoursInAllNotations) {
  EXPECT_EQ(rectangle_reflectance(R"(<rgb name="reflectance" value="0.1, 0.2, 0.3"/>)"), Rgb(0.1f, 0.2f, 0.3f));
  EXPECT_EQ(rectangle_reflectance("<rgb name=\"reflectance\" value=\" 0.1 \t0.2\n.3\"/>"), Rgb(0.1f, 0.2f, 0.3f));
  EXPECT_EQ(rectangle_reflectance(R"(<rgb name="reflectance" value="0.25"/>)"), Rgb(0.25f));
  EXPECT_EQ(rectangle_reflectance(R"(<float name="reflectance" value="0.25"/>)"), Rgb(0.25f));
  EXPECT_EQ(rectangle_reflectance(R"(<spectrum name="reflectance" value="0.25"/>)", "0.6.0"), Rgb(0.25f));
  EXPECT_EQ(rectangle_reflectance(R"(<spectrum name="reflectance" value="0.1 0.2 0.3"/>)", "0.6.0"),
            Rgb(0.1f, 0.2f, 0.3f));
  const Rgb hex = rectangle_reflectance(R"(<rgb name="reflectance" value="#ff8000"/>)");
  EXPECT_EQ(hex.r, 1);
  EXPECT_NEAR(hex.g, 0.215861f, 1e-6f);
  EXPECT_EQ(hex.b, 0);
  EXPECT_NEAR(rectangle_reflectance(R"(<srgb name="reflectance" value="0.5"/>)", "0.6.0").r, 0.214041f, 1e-6f);
}

TEST(Loader, AppliesTransformsInTheOrderOfTheFile) {
  const auto first_corner = [](std::string_view steps) {
    return load(fmt::format(R"(<shape type="rectangle"><transform name="to_world">{}</transform></shape>)", steps))
        .meshes[0]
        .positions[2];  // (1, 1, 0)
  };
  EXPECT_EQ(first_corner(R"(<translate x="1" y="2" z="3"/>)"), (Point3{2, 3, 3}));
  EXPECT_EQ(first_corner(R"(<translate value="1, 2, 3"/><scale value="2"/>)"), (Point3{4, 6, 6}));
  EXPECT_EQ(first_corner(R"(<scale x="2"/><translate z="3"/>)"), (Point3{2, 1, 3}));
  EXPECT_EQ(first_corner(R"(<matrix value="0 1 0 5  1 0 0 6  0 0 1 7  0 0 0 1"/>)"), (Point3{6, 7, 7}));
  EXPECT_EQ(first_corner(R"(<matrix value="2 0 0  0 3 0  0 0 1"/>)"), (Point3{2, 3, 0}));
  const Point3 turned = first_corner(R"(<rotate z="2" angle="90"/>)");  // x -> y, y -> -x
  EXPECT_NEAR(turned.x, -1, 1e-6f);
  EXPECT_NEAR(turned.y, 1, 1e-6f);
  const Point3 looking = first_corner(R"(<lookat origin="1 2 3" target="1 2 9" up="0 1 0"/>)");
  EXPECT_EQ(looking, (Point3{2, 3, 3}));
}

Normal3 hit_normal(const Scene& scene, Vec3 direction) {
  const auto hit = scene.intersect({Point3() - 10 * direction, direction});
  EXPECT_TRUE(hit);
  return hit ? hit->geometric_normal : Normal3();
}

// Mirroring turns the winding round, but normals go by the inverse transpose and keep their side.
TEST(Loader, MirroredShapesKeepTheSideOfTheirNormals) {
  for (const char* scale : {"1, 1, 1", "-1, 1, 1", "-2, -3, 1", "1, 2, -1", "-1, -1, -1"})
    for (const bool flip : {false, true}) {
      const std::string body = fmt::format(
          R"(<boolean name="flip_normals" value="{}"/><transform name="to_world"><scale value="{}"/></transform></shape>)",
          flip, scale);
      const Scene cube(load(R"(<shape type="cube">)" + body));
      for (const Vec3 d : {Vec3{1, 0, 0}, Vec3{-1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, -1, 0}, Vec3{0, 0, 1}, Vec3{0, 0, -1}})
        EXPECT_NEAR(dot(hit_normal(cube, d), d), flip ? 1 : -1, 1e-6f) << scale;
      const Scene rectangle(load(R"(<shape type="rectangle">)" + body));
      const float up = (std::string_view(scale).ends_with("-1") ? -1.0f : 1.0f) * (flip ? -1.0f : 1.0f);
      EXPECT_NEAR(hit_normal(rectangle, {0, 0, -1}).z, up, 1e-6f) << scale;
    }
}

TEST(Loader, TheRectangleHasMitsubasTextureCoordinates) {
  const Scene scene(load(R"(<shape type="rectangle"/>)"));
  const auto hit = scene.intersect({{-0.5f, 0.8f, 1}, {0, 0, -1}});
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->uv.x, 0.25f, 1e-6f);
  EXPECT_NEAR(hit->uv.y, 0.9f, 1e-6f);
}

// Corners of the six faces as Mitsuba's cube has them: position of uv (0, 1) and of uv (1, 0).
TEST(Loader, TheCubeHasMitsubasTextureCoordinates) {
  const TriangleMesh cube = load(R"(<shape type="cube"/>)").meshes[0];
  ASSERT_EQ(cube.positions.size(), 24u);
  ASSERT_EQ(cube.triangles.size(), 12u);
  constexpr Point3 k_first[] = {{1, -1, -1}, {1, 1, -1}, {1, -1, -1}, {1, -1, 1}, {-1, -1, 1}, {1, 1, -1}};
  constexpr Point3 k_third[] = {{-1, -1, 1}, {-1, 1, 1}, {1, 1, 1}, {-1, 1, 1}, {-1, 1, -1}, {-1, -1, -1}};
  for (std::size_t face = 0; face < 6; ++face) {
    EXPECT_EQ(cube.positions[4 * face], k_first[face]);
    EXPECT_EQ(cube.uvs[4 * face], (Vec2{0, 1}));
    EXPECT_EQ(cube.positions[4 * face + 2], k_third[face]);
    EXPECT_EQ(cube.uvs[4 * face + 2], (Vec2{1, 0}));
  }
}

TEST(Loader, ReferencesReachNestedIdsAndAliasesAndWhatComesLater) {
  const SceneDescription scene = load(R"(
    <shape type="rectangle"><ref id="inner"/></shape>
    <shape type="rectangle"><ref id="other"/></shape>
    <bsdf type="twosided" id="outer">
      <bsdf type="diffuse" id="inner"><rgb name="reflectance" value="0.2"/></bsdf>
    </bsdf>
    <alias id="outer" as="other"/>
    <shape type="rectangle"><ref id="outer"/></shape>)");
  const auto material = [&](std::size_t mesh) { return scene.materials[scene.meshes[mesh].material]; };
  EXPECT_FALSE(test::is_two_sided(material(0)));
  EXPECT_EQ(reflectance(material(0)), Rgb(0.2f));
  EXPECT_TRUE(test::is_two_sided(material(1)));
  EXPECT_EQ(scene.meshes[1].material, scene.meshes[2].material);
  EXPECT_EQ(scene.materials.size(), 2u);
}

TEST(Loader, SubstitutesParameters) {
  constexpr std::string_view k_body = R"(
    <default name="c" value="0.25"/><default name="c" value="0.75"/><default name="co" value="0.5"/>
    <default name="kind" value="diffuse"/>
    <shape type="rectangle"><bsdf type="$kind"><rgb name="reflectance" value="$c $co $c"/></bsdf></shape>)";
  EXPECT_EQ(reflectance(load(k_body).materials[0]), Rgb(0.25f, 0.5f, 0.25f));
  LoadOptions options;
  options.definitions = {{"c", "0.125"}};
  EXPECT_EQ(reflectance(load(k_body, options).materials[0]), Rgb(0.125f, 0.5f, 0.125f));
}

TEST(Loader, IncludesFilesRelativeToTheIncludingOne) {
  const TemporaryFolder folder;
  folder.write(
      "parts/leaf.xml",
      R"(<scene version="0.6.0"><bsdf type="diffuse" id="leaf"><spectrum name="reflectance" value="0.1, 0.2, 0.3"/></bsdf></scene>)");
  folder.write("parts/middle.xml", R"(<scene version="3.0.0"><include filename="leaf.xml"/></scene>)");
  const std::string file =
      folder.write("scene.xml", fmt::format(R"(<scene version="3.0.0"><include filename="parts/middle.xml"/>
    <shape type="rectangle"><ref id="leaf"/></shape>{}</scene>)",
                                            k_sensor));
  EXPECT_EQ(reflectance(load_scene(file).materials[0]), Rgb(0.1f, 0.2f, 0.3f));
}

TEST(Loader, ReadsObjFilesBesideTheScene) {
  const TemporaryFolder folder;
  folder.write("parts/triangle.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const std::string file = folder.write("scene.xml", fmt::format(R"(<scene version="3.0.0">
    <shape type="obj"><string name="filename" value="parts/triangle.obj"/><boolean name="flip_normals" value="true"/>
      <transform name="to_world"><translate z="5"/></transform></shape>{}</scene>)",
                                                                 k_sensor));
  const TriangleMesh mesh = load_scene(file).meshes.at(0);
  EXPECT_EQ(mesh.positions[1], (Point3{1, 0, 5}));
  EXPECT_TRUE(mesh.flip_normals);
}

TEST(Loader, NotesWhatHasNoEffectOnceEach) {
  const auto scene = load_scene_text(R"(<scene version="3.0.0">
<integrator type="path"/>
<sensor type="perspective"><float name="fov" value="40"/><float name="near_clip" value="0.1"/>
<sampler type="sobol"/><film type="hdrfilm"><rfilter type="box"/></film></sensor></scene>)",
                                     "s.xml");
  ASSERT_EQ(scene.notes.size(), 3u);
  EXPECT_EQ(scene.notes[0], "s.xml:2: integrator \"path\" has no effect: the experiment chooses the method");
  EXPECT_EQ(scene.notes[1], "s.xml:3: sensor \"perspective\": \"near_clip\" has no effect here");
  EXPECT_EQ(scene.notes[2].substr(0, 38), "s.xml:4: sampler \"sobol\" has no effect");
}

TEST(SnakeCase, TranslatesTheNamesOfDialect06) {
  const SceneDescription scene = load_legacy(
      R"(<shape type="rectangle"><boolean name="flipNormals" value="true"/><transform name="toWorld"><translate x="1"/></transform></shape>)");
  EXPECT_TRUE(scene.meshes[0].flip_normals);
  EXPECT_EQ(scene.meshes[0].positions[0], (Point3{0, -1, 0}));
}

}  // namespace
}  // namespace gradslc
