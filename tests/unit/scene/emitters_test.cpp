#include "scene/emitters.h"

#include <gtest/gtest.h>

#include "core/warp.h"
#include "light_cases.h"
#include "scene_fixtures.h"
#include "support/statistics.h"

namespace gradslc {
namespace {

using test::Random;

/// A lamp of that radiance: index of its light is the number of lights before it.
void add_lamp(SceneDescription& description, TriangleMesh mesh, Rgb radiance) {
  mesh.area_light = static_cast<std::int32_t>(description.area_lights.size());
  description.area_lights.push_back({radiance});
  description.meshes.push_back(std::move(mesh));
}

/// Three lamps of different size, colour and tilt around the origin; one of them turns its back.
Scene three_lamps() {
  SceneDescription description = test::describe({});
  add_lamp(description, test::parallelogram({-1, -0.5f, 1.5f}, {0.2f, 1.5f, 0.3f}, {2, 0, -0.4f}), Rgb(1, 2, 3));
  add_lamp(description, test::parallelogram({1, 1, -1}, {0, -1, 0}, {0.3f, 0, -1}), Rgb(20, 4, 1));
  add_lamp(description, test::parallelogram({-1, -1, -1}, {0, 1, 0}, {1, 0, 0}), Rgb(5, 5, 5));
  return Scene(std::move(description));
}

/// Irradiance at `position` over pi from the emitters, estimated by light sampling and cosine sampling with the balance
/// heuristic: finite variance also where the emitter touches, and right only if pdf_direct is sample_direct's density.
double gathered(const Scene& scene, Point3 position, Normal3 normal, Random& random) {
  double sum = 0;
  const double u_select = random.uniform();
  if (const auto light = scene.emitters().sample_direct(position, u_select, random.get1())) {
    const float cosine = dot(light->wi, normal);
    if (cosine > 0 && !scene.occluded(segment(position, light->position)))
      sum += luminance(light->radiance) * cosine * k_inv_pi /
             (light->pdf_solid_angle + cosine_hemisphere_pdf_solid_angle(cosine));
  }
  const Vec3 direction = frame_from_normal(normal).to_world(square_to_cosine_hemisphere(random.get2()));
  if (const auto hit = scene.intersect({position, direction})) {
    const float pdf = cosine_hemisphere_pdf_solid_angle(dot(direction, normal));
    if (pdf > 0)
      sum += luminance(scene.emitters().radiance(*hit, -direction)) * pdf /
             (pdf + scene.emitters().pdf_direct(position, *hit));
  }
  return sum;
}

/// View factor between equal, aligned parallel rectangles x by y at distance 1 (Howell's catalogue, C-11).
double parallel_view_factor(double x, double y) {
  const double x1 = 1 + x * x, y1 = 1 + y * y;
  return 2 / (std::numbers::pi * x * y) *
         (0.5 * std::log(x1 * y1 / (x1 + y1 - 1)) + x * std::sqrt(y1) * std::atan(x / std::sqrt(y1)) +
          y * std::sqrt(x1) * std::atan(y / std::sqrt(x1)) - x * std::atan(x) - y * std::atan(y));
}

/// View factor from a rectangle 1 by w to one 1 by h at right angles that shares the edge of length 1 (C-14).
double perpendicular_view_factor(double w, double h) {
  const double w2 = w * w, h2 = h * h, sum = w2 + h2;
  return (w * std::atan(1 / w) + h * std::atan(1 / h) - std::sqrt(sum) * std::atan(1 / std::sqrt(sum)) +
          0.25 * (std::log((1 + w2) * (1 + h2) / (1 + sum)) + w2 * std::log(w2 * (1 + sum) / ((1 + w2) * sum)) +
                  h2 * std::log(h2 * (1 + sum) / ((1 + h2) * sum)))) /
         (std::numbers::pi * w);
}

// False alarm 0.1 % for both view factors together.
TEST(Emitters, GiveTheViewFactorOfParallelRectangles) {
  SceneDescription description = test::describe({});
  add_lamp(description, test::parallelogram({0, 0, 1}, {0, 0.7f, 0}, {1.5f, 0, 0}), Rgb(1));
  const Scene scene(std::move(description));
  Random random(1);
  Moments mean;
  for (int i = 0; i < 100000; ++i) {
    const Vec2 u = random.get2();
    mean.add(gathered(scene, {1.5f * u.x, 0.7f * u.y, 0}, {0, 0, 1}, random));
  }
  EXPECT_GT(mean.p_value(parallel_view_factor(1.5, 0.7)), sidak(1e-3, 2)) << mean.mean();
}

TEST(Emitters, GiveTheViewFactorOfPerpendicularRectanglesThatTouch) {
  SceneDescription description = test::describe({});
  add_lamp(description, test::parallelogram({0, 0, 0}, {0, 1, 0}, {0, 0, 2}), Rgb(1));  // faces +x
  const Scene scene(std::move(description));
  Random random(2);
  Moments mean;
  for (int i = 0; i < 100000; ++i) {
    const Vec2 u = random.get2();
    mean.add(gathered(scene, {0.5f * u.x, u.y, 0}, {0, 0, 1}, random));
  }
  EXPECT_GT(mean.p_value(perpendicular_view_factor(0.5, 2)), sidak(1e-3, 2)) << mean.mean();
}

// Directions of sample_direct against the integral of pdf_direct over cells of the sphere. False alarm 0.1 %.
TEST(Emitters, SampleDirectFollowsPdfDirectOverSolidAngle) {
  const Scene scene = three_lamps();
  constexpr int k_rows = 40, k_columns = 80, k_sub = 16, k_samples = 200000;
  const auto direction = [](double row, double column) {
    const double z = 1 - 2 * row / k_rows, r = std::sqrt(1 - z * z), phi = 2 * std::numbers::pi * column / k_columns;
    return Vec3{static_cast<float>(r * std::cos(phi)), static_cast<float>(r * std::sin(phi)), static_cast<float>(z)};
  };
  std::vector<double> observed(k_rows * k_columns), expected(k_rows * k_columns);
  double integral = 0;
  for (int row = 0; row < k_rows * k_sub; ++row)
    for (int column = 0; column < k_columns * k_sub; ++column) {
      const auto hit = scene.intersect({{0, 0, 0}, direction((row + 0.5) / k_sub, (column + 0.5) / k_sub)});
      if (!hit) continue;
      const double part =
          scene.emitters().pdf_direct({0, 0, 0}, *hit) * 4 * std::numbers::pi / (k_rows * k_columns * k_sub * k_sub);
      expected[static_cast<std::size_t>(row / k_sub * k_columns + column / k_sub)] += part * k_samples;
      integral += part;
    }
  Random random(3);
  int chosen = 0;
  for (int i = 0; i < k_samples; ++i) {
    const double u_select = random.uniform();
    const auto sample = scene.emitters().sample_direct({0, 0, 0}, u_select, random.get1());
    if (!sample) continue;
    ++chosen;
    double phi = std::atan2(sample->wi.y, sample->wi.x);
    if (phi < 0) phi += 2 * std::numbers::pi;
    const int row = std::min(static_cast<int>((1 - sample->wi.z) / 2 * k_rows), k_rows - 1);
    const int column = std::min(static_cast<int>(phi / (2 * std::numbers::pi) * k_columns), k_columns - 1);
    ++observed[static_cast<std::size_t>(row * k_columns + column)];
  }
  EXPECT_NEAR(integral, static_cast<double>(chosen) / k_samples,
              0.004);  // the lamp that turns its back is chosen in vain
  EXPECT_LT(integral, 0.95);
  EXPECT_GT(chi_square_test(observed, expected).p_value, 1e-3);
}

TEST(Emitters, SampleAndPdfAgreeAtTheSamePoint) {
  SceneDescription description = test::describe({});
  add_lamp(description, test::block({0, 0, 1.2f}, {0.2f, 0.3f, 0.4f}, 30), Rgb(1));  // triangles of all directions
  add_lamp(description, test::parallelogram({1, 1, -1}, {0, -1, 0}, {0.3f, 0, -1}), Rgb(20, 4, 1));
  const Scene scene(std::move(description));
  int compared = 0;
  Random random(4);
  for (int i = 0; i < 10000; ++i) {
    const Point3 reference = Point3() + 0.5f * square_to_sphere(random.get2());
    const double u_select = random.uniform();
    const auto sample = scene.emitters().sample_direct(reference, u_select, random.get1());
    if (!sample) continue;
    const auto hit = scene.intersect({reference, sample->wi});
    if (!hit || distance(hit->position, sample->position) > 1e-4f) continue;  // another lamp stands before it
    ++compared;
    EXPECT_NEAR(scene.emitters().pdf_direct(reference, *hit) / sample->pdf_solid_angle, 1, 2e-4);
    EXPECT_EQ(scene.emitters().radiance(*hit, -sample->wi), sample->radiance);
    EXPECT_FALSE(scene.occluded(segment(reference, sample->position)));
  }
  EXPECT_GT(compared, 300);
}

TEST(Emitters, EmitOnTheSideOfTheNormalOnly) {
  for (const bool flip : {false, true}) {
    SceneDescription description = test::describe({});
    TriangleMesh lamp = test::parallelogram({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    lamp.flip_normals = flip;
    add_lamp(description, std::move(lamp), Rgb(3));
    const Scene scene(std::move(description));
    for (const float side : {-1.0f, 1.0f}) {
      const bool lit = (side > 0) != flip;
      const Point3 reference{0.3f, 0.3f, side};
      const auto hit = scene.intersect({reference, {0, 0, -side}});
      ASSERT_TRUE(hit);
      EXPECT_EQ(scene.emitters().radiance(*hit, {0, 0, side}), lit ? Rgb(3) : Rgb());
      EXPECT_EQ(scene.emitters().pdf_direct(reference, *hit) > 0, lit);
      EXPECT_EQ(scene.emitters().sample_direct(reference, 0.5, 0.5f).has_value(), lit);
    }
    const EmissionSample emission = scene.emitters().sample_emission(0.5, {0.5f, 0.25f}, {0.3f, 0.7f});
    EXPECT_EQ(emission.ray.direction.z > 0, !flip);
    EXPECT_EQ(emission.ray.origin.z > 0, !flip);
    EXPECT_FALSE(emission.delta);
  }
}

TEST(Emitters, PowerIsPiTimesAreaTimesRadiance) {
  SceneDescription description = test::describe({});
  add_lamp(description, test::parallelogram({0, 0, 0}, {2, 0, 0}, {0, 3, 0}), Rgb(1, 2, 3));
  add_lamp(description, test::parallelogram({0, 0, 5}, {0.5f, 0, 0}, {0, 1, 0}), Rgb(10, 0, 0));
  const Scene scene(std::move(description));
  const Rgb power = scene.emitters().power();
  EXPECT_FLOAT_EQ(power.r, k_pi * (6 * 1 + 0.5f * 10));
  EXPECT_FLOAT_EQ(power.g, k_pi * 6 * 2);
  EXPECT_FLOAT_EQ(power.b, k_pi * 6 * 3);
}

// Moments carried power is the power; directions have density cos / pi; lamps are chosen by luminance. False alarm 0.1
// % for all.
TEST(Emitters, EmissionConservesEnergyAndFollowsTheCosine) {
  const Scene scene = three_lamps();
  constexpr int k_samples = 100000, k_cells = 16;
  Moments carried[3];
  std::vector<double> lamps(3), lamps_expected, cells(k_cells * k_cells);
  Random random(6);
  for (int i = 0; i < k_samples; ++i) {
    const double u_select = random.uniform();
    const Vec2 u_point = random.get2();
    const EmissionSample sample = scene.emitters().sample_emission(u_select, u_point, random.get2());
    for (int channel = 0; channel < 3; ++channel) carried[channel].add(sample.power[channel]);
    const auto lamp = scene.intersect({sample.ray.origin, -sample.ray.direction});
    ASSERT_TRUE(lamp);
    ++lamps[lamp->mesh];
    const Vec3 local = frame_from_normal(lamp->geometric_normal).to_local(sample.ray.direction);
    ASSERT_GT(local.z, 0);
    ASSERT_NEAR(length(local), 1, 1e-5);
    const auto cell = [](double u) {
      return std::min(static_cast<std::size_t>(u * k_cells), std::size_t{k_cells - 1});
    };
    const double azimuth = std::atan2(local.y, local.x) / (2 * std::numbers::pi) + 0.5;
    ++cells[cell(local.z * local.z) * k_cells + cell(azimuth)];  // cos^2 is uniform
  }
  const double alpha = sidak(1e-3, 5);
  for (int channel = 0; channel < 3; ++channel)
    EXPECT_GT(carried[channel].p_value(scene.emitters().power()[channel]), alpha);
  EXPECT_GT(chi_square_test(cells, std::vector<double>(cells.size(), k_samples / 256.0)).p_value, alpha);
  double total = 0;
  for (const TriangleMesh& mesh : scene.meshes()) {
    const float area = length(cross(mesh.positions[1] - mesh.positions[0], mesh.positions[3] - mesh.positions[0]));
    const std::array<Rgb, 3> radiances = {Rgb(1, 2, 3), Rgb(20, 4, 1), Rgb(5, 5, 5)};
    lamps_expected.push_back(area * luminance(radiances[lamps_expected.size()]));
    total += lamps_expected.back();
  }
  for (double& expected : lamps_expected) expected *= k_samples / total;
  EXPECT_GT(chi_square_test(lamps, lamps_expected).p_value, alpha);
}

// Points are uniform over the lamp: cells of equal area get equal counts. False alarm 0.1 %.
TEST(Emitters, EmissionIsUniformOverTheArea) {
  SceneDescription description = test::describe({});
  add_lamp(description, test::parallelogram({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), Rgb(1));
  const Scene scene(std::move(description));
  std::vector<double> cells(64);
  Random random(8);
  for (int i = 0; i < 64000; ++i) {
    const double u_select = random.uniform();
    const Vec2 u_point = random.get2();
    const Point3 p = scene.emitters().sample_emission(u_select, u_point, {0.5f, 0.5f}).ray.origin;
    ++cells[static_cast<std::size_t>(p.x * 8) * 8 + static_cast<std::size_t>(p.y * 8)];
  }
  EXPECT_GT(chi_square_test(cells, std::vector<double>(64, 1000)).p_value, 1e-3);
}

TEST(Emitters, NeverChooseBlackLampsOrTrianglesWithoutArea) {
  SceneDescription description = test::describe({});
  add_lamp(description, test::parallelogram({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), Rgb());
  TriangleMesh half = test::parallelogram({0, 0, 1}, {1, 0, 0}, {0, 1, 0});
  half.triangles.insert(half.triangles.begin(), {0, 1, 1});  // no area
  half.triangles.push_back({2, 2, 2});
  add_lamp(description, std::move(half), Rgb(1));
  add_lamp(description, test::parallelogram({0, 0, 2}, {1, 0, 0}, {0, 1, 0}), Rgb());
  const Scene scene(std::move(description));
  EXPECT_EQ(scene.emitters().triangle_count(), 2u);
  EXPECT_EQ(scene.triangle_count(), 6u);
  for (const double u : {0.0, 0.25, 0.5, 0.75, 0.9999999999999999}) {
    const EmissionSample sample = scene.emitters().sample_emission(u, {0.4f, 0.3f}, {0.4f, 0.3f});
    EXPECT_NEAR(sample.ray.origin.z, 1, 1e-5f);
    EXPECT_FLOAT_EQ(sample.power.r, k_pi);
  }
  const auto black = scene.intersect({{0.2f, 0.3f, 0.5f}, {0, 0, -1}});
  ASSERT_TRUE(black);
  EXPECT_EQ(scene.emitters().pdf_direct({0.2f, 0.3f, 0.5f}, *black), 0);
  EXPECT_EQ(scene.emitters().radiance(*black, {0, 0, 1}), Rgb());
}

TEST(Emitters, MayBeAbsent) {
  for (const bool black_lamp : {false, true}) {
    SceneDescription description = test::describe(test::room());
    if (black_lamp) add_lamp(description, test::parallelogram({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), Rgb());
    const Scene scene(std::move(description));
    EXPECT_TRUE(scene.emitters().empty());
    EXPECT_EQ(scene.emitters().power(), Rgb());
    EXPECT_FALSE(scene.emitters().sample_direct({0, 0, 0}, 0.5, 0.5f));
    const auto hit = scene.intersect({{0, 0, 0.5f}, {0, 0, -1}});
    ASSERT_TRUE(hit);
    EXPECT_EQ(scene.emitters().radiance(*hit, {0, 0, 1}), Rgb());
    EXPECT_EQ(scene.emitters().pdf_direct({0, 0, 0.5f}, *hit), 0);
  }
}

// Densities stay finite and positive where the reference lies in the emitter's plane or on the emitter.
TEST(Emitters, ReferencesInThePlaneOfTheLampAreNotLit) {
  SceneDescription description = test::describe({});
  add_lamp(description, test::parallelogram({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), Rgb(1));
  const Scene scene(std::move(description));
  Random random(9);
  for (int i = 0; i < 100; ++i) {
    EXPECT_FALSE(scene.emitters().sample_direct({2, 0.5f, 0}, 0.5, random.get1()));
    EXPECT_FALSE(scene.emitters().sample_direct({0.5f, 0.5f, 0}, 0.5, random.get1()));
  }
}

/// A lamp, a sky and a point light over a floor.
Scene lamp_sky_and_point() {
  SceneDescription description = test::describe({test::parallelogram({-1, -1, -1}, {0, 0, 2}, {2, 0, 0})});
  add_lamp(description, test::parallelogram({-0.5f, 1, -0.5f}, {1, 0, 0}, {0, 0, 1}), Rgb(9, 6, 3));  // faces down
  description.lights = {std::make_shared<const EnvironmentMap>(test::random_map(16, 8, 3), test::oblique()),
                        std::make_shared<const PointLight>(Point3{0.3f, 0.5f, 0.2f}, Rgb(2, 3, 4)),
                        std::make_shared<const ConstantLight>(Rgb())};  // no power
  return Scene(std::move(description));
}

// Each emitter is chosen in proportion to its luminous power, and the density says so. False alarm 0.1 %.
TEST(Emitters, OfAllKindsAreChosenByPower) {
  const Scene scene = lamp_sky_and_point();
  const Emitters& emitters = scene.emitters();
  ASSERT_EQ(emitters.environments().size(), 1u);
  const auto& [sky, sky_probability, probability_among_lights] = emitters.environments()[0];
  EXPECT_GT(probability_among_lights, sky_probability);
  const BoundingSphere ball = scene.bounding_sphere();
  const double weights[] = {k_pi * luminance(Rgb(9, 6, 3)), luminance(sky->power(ball)),
                            4 * k_pi * luminance(Rgb(2, 3, 4))};
  const double total = weights[0] + weights[1] + weights[2];
  EXPECT_NEAR(sky_probability, weights[1] / total, 1e-6);
  EXPECT_NEAR(luminance(emitters.power()), total, 1e-4 * total);

  const Point3 reference{0.1f, -0.3f, 0.2f};
  Random random(10);
  constexpr int k_samples = 50000;
  std::vector<double> chosen(3), expected;
  for (const double weight : weights) expected.push_back(k_samples * weight / total);
  for (int i = 0; i < k_samples; ++i) {
    const double u_select = random.uniform();
    const auto sample = emitters.sample_direct(reference, u_select, random.get1());
    ASSERT_TRUE(sample);
    if (sample->infinite) {
      ++chosen[1];
      ASSERT_FLOAT_EQ(sample->pdf_solid_angle, sky_probability * sky->pdf_direct(sample->wi));
      ASSERT_EQ(sample->radiance, sky->radiance(sample->wi));
    } else if (sample->delta) {
      ++chosen[2];
      ASSERT_NEAR(sample->pdf_solid_angle, weights[2] / total, 1e-6);
    } else {
      ++chosen[0];
      const auto hit = scene.intersect({reference, sample->wi});
      ASSERT_TRUE(hit);
      ASSERT_NEAR(emitters.pdf_direct(reference, *hit) / sample->pdf_solid_angle, 1, 2e-4);
    }
  }
  EXPECT_GT(chi_square_test(chosen, expected).p_value, 1e-3);
}

// The others are chosen by their power among themselves. False alarm 0.1 %.
TEST(Emitters, WithoutAreaLightsAreChosenByPower) {
  const Scene scene = lamp_sky_and_point();
  const Emitters& emitters = scene.emitters();
  const auto& sky = emitters.environments()[0];
  const double sky_power = luminance(sky.light->power(scene.bounding_sphere()));
  const double sky_share = sky_power / (sky_power + static_cast<double>(4 * k_pi * luminance(Rgb(2, 3, 4))));
  EXPECT_NEAR(sky.probability_without_area_lights, sky_share, 1e-6);
  Random random(11);
  constexpr int k_samples = 20000;
  std::vector<double> chosen(2);
  const std::vector<double> expected = {k_samples * sky_share, k_samples * (1 - sky_share)};
  for (int i = 0; i < k_samples; ++i) {
    const double u_select = random.uniform();
    const auto sample =
        emitters.sample_direct({0.1f, -0.3f, 0.2f}, u_select, random.get1(), EmitterChoice::without_area_lights);
    ASSERT_TRUE(sample);
    ASSERT_TRUE(sample->infinite || sample->delta) << "an area light";
    ++chosen[sample->infinite ? 0 : 1];
    const double pdf =
        sample->infinite ? sky_share * static_cast<double>(sky.light->pdf_direct(sample->wi)) : 1 - sky_share;
    ASSERT_NEAR(static_cast<double>(sample->pdf_solid_angle), pdf, 1e-5 * (1 + pdf));
  }
  EXPECT_GT(chi_square_test(chosen, expected).p_value, 1e-3);

  SceneDescription lamp_alone = test::describe({test::parallelogram({-1, -1, -1}, {0, 0, 2}, {2, 0, 0})});
  add_lamp(lamp_alone, test::parallelogram({-0.5f, 1, -0.5f}, {1, 0, 0}, {0, 0, 1}), Rgb(9, 6, 3));
  const Scene lamp(std::move(lamp_alone));
  EXPECT_FALSE(lamp.emitters().sample_direct({0, 0, 0}, 0.5, 0.5f, EmitterChoice::without_area_lights));
}

// What particles bring to a small rectangle below the lamp is what light sampling finds there. False alarm 0.1 %.
TEST(Emitters, OfAllKindsGiveTheSameByParticlesAndBySampling) {
  const Scene scene = lamp_sky_and_point();
  const Vec2 half{0.3f, 0.2f};
  const float height = 0.2f;
  Random random(11);
  Moments particles, direct, carried;
  for (int i = 0; i < 200000; ++i) {
    const double u_particle = random.uniform();
    const Vec2 u_point = random.get2();
    const EmissionSample particle = scene.emitters().sample_emission(u_particle, u_point, random.get2());
    carried.add(luminance(particle.power));
    const float distance = (height - particle.ray.origin.y) / particle.ray.direction.y;
    const Point3 landing = particle.ray.at(distance);
    const bool lands = particle.ray.direction.y < 0 && distance > 0 && std::abs(landing.x) < half.x &&
                       std::abs(landing.z) < half.y &&
                       !scene.occluded({particle.ray.origin, particle.ray.direction, distance});
    particles.add(lands ? luminance(particle.power) : 0);

    const Vec2 u = random.get2();
    const Point3 position{half.x * (2 * u.x - 1), height, half.y * (2 * u.y - 1)};
    const double u_light = random.uniform();
    const auto sample = scene.emitters().sample_direct(position, u_light, random.get1());
    const bool lit =
        sample && sample->wi.y > 0 &&
        !scene.occluded(sample->infinite ? Ray{position, sample->wi} : segment(position, sample->position));
    direct.add(lit ? luminance(sample->radiance) * sample->wi.y / sample->pdf_solid_angle * 4 * half.x * half.y : 0);
  }
  EXPECT_GT(same_mean_p_value(particles, direct), sidak(1e-3, 2)) << particles.mean() << " " << direct.mean();
  EXPECT_NEAR(carried.mean(), luminance(scene.emitters().power()), 1e-4 * carried.mean());
}

}  // namespace
}  // namespace gradslc
