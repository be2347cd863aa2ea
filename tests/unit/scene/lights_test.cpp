// Properties that every light must have, on one list, and known values of each. A light in the registry that is not on
// the list fails.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

#include "light_cases.h"
#include "scene/loaders/mitsuba_emitters.h"
#include "support/direction_test.h"
#include "support/statistics.h"

namespace gradslc {
namespace {

using test::LightCase;

constexpr double k_degree = std::numbers::pi / 180;
constexpr BoundingSphere k_ball{{0.1f, -0.2f, 0.3f}, 1.5f};
/// Without and with a focus, off the middle.
constexpr EmissionExtent k_extents[] = {{k_ball, {}}, {k_ball, {{0.5f, 0.4f, 0.1f}, 0.6f}}};

class EveryLight : public testing::TestWithParam<LightCase> {};
INSTANTIATE_TEST_SUITE_P(Lights, EveryLight, testing::ValuesIn(test::light_cases()),
                         [](const auto& light) { return light.param.name; });

class EveryEnvironment : public testing::TestWithParam<LightCase> {};
INSTANTIATE_TEST_SUITE_P(Lights, EveryEnvironment, testing::ValuesIn(test::environment_cases()),
                         [](const auto& light) { return light.param.name; });

TEST(LightRegistry, IsUnderTestAsAWhole) {
  std::set<std::string_view> registered, tested;
  for (const LightEntry& entry : light_registry()) registered.insert(entry.name);
  for (const LightCase& c : test::light_cases()) tested.insert(c.light->kind());
  EXPECT_EQ(registered, tested);
}

TEST_P(EveryLight, SampleDirectAgreesWithDensityAndRadiance) {
  const Light& light = *GetParam().light;
  TestRandom random(1);
  int lit = 0;
  for (int i = 0; i < 10'000; ++i) {
    const Point3 reference = k_ball.centre + random.get1() * random.direction();
    const auto sample = light.sample_direct(reference, random.get2());
    if (!sample) continue;
    ++lit;
    ASSERT_NEAR(length(sample->wi), 1, 1e-5f);
    ASSERT_GT(sample->pdf_solid_angle, 0);
    ASSERT_TRUE(is_finite(sample->radiance));
    ASSERT_FALSE(is_black(sample->radiance));
    ASSERT_EQ(sample->delta, !light.is_environment());
    if (sample->delta) {
      ASSERT_EQ(sample->pdf_solid_angle, 1);
      ASSERT_EQ(light.radiance(sample->wi), Rgb());
      ASSERT_EQ(light.pdf_direct(sample->wi), 0);
    } else {
      ASSERT_TRUE(sample->infinite);
      ASSERT_EQ(light.radiance(sample->wi), sample->radiance);
      ASSERT_EQ(light.pdf_direct(sample->wi), sample->pdf_solid_angle);
    }
    if (!sample->infinite) {
      ASSERT_NEAR(length(sample->wi - normalize(sample->position - reference)), 0, 1e-5f);
    }
  }
  EXPECT_GT(lit, 500);
}

// False alarm 0.1 % for each light.
TEST_P(EveryEnvironment, DirectionsFollowTheirDensity) {
  const Light& light = *GetParam().light;
  const auto sample = [&](TestRandom& random) -> std::optional<Vec3> {
    const auto drawn = light.sample_direct(Point3(), random.get2());
    return drawn ? std::optional(drawn->wi) : std::nullopt;
  };
  const auto pdf = [&](Vec3 direction) { return light.pdf_direct(direction); };
  EXPECT_GT(chi_square_directions(sample, pdf, {.samples = 60'000}).p_value, 1e-3);
  EXPECT_NEAR(integrate_over_sphere(pdf), 1, 1e-3);
}

TEST_P(EveryEnvironment, DensityIsPositiveWhereverThereIsRadiance) {
  const Light& light = *GetParam().light;
  TestRandom random(2);
  for (int i = 0; i < 50'000; ++i) {
    const Vec3 direction = random.direction();
    const float pdf = light.pdf_direct(direction);
    ASSERT_TRUE(std::isfinite(pdf));
    ASSERT_EQ(pdf > 0, !is_black(light.radiance(direction)));
  }
  for (const Vec3 axis :
       {Vec3{1, 0, 0}, Vec3{-1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, -1, 0}, Vec3{0, 0, 1}, Vec3{0, 0, -1}}) {
    ASSERT_TRUE(std::isfinite(light.pdf_direct(axis)));
    ASSERT_TRUE(is_finite(light.radiance(axis)));
  }
}

// Radiance over density averages to the integral of the radiance over the sphere, which is the power of a ball whose
// great disk has area 1. False alarm 0.1 % for each light.
TEST_P(EveryEnvironment, EstimatesItsIntegral) {
  const Light& light = *GetParam().light;
  TestRandom random(3);
  Moments estimate[3];
  for (int i = 0; i < 40'000; ++i) {
    const auto sample = light.sample_direct(Point3(), random.get2());
    for (int channel = 0; channel < 3; ++channel)
      estimate[channel].add(sample ? sample->radiance[channel] / sample->pdf_solid_angle : 0);
  }
  const BoundingSphere unit{Point3(), std::sqrt(std::numbers::inv_pi_v<float>)};
  const double numerical = integrate_over_sphere([&](Vec3 direction) { return luminance(light.radiance(direction)); });
  EXPECT_NEAR(numerical, luminance(light.power(unit)), 1e-3 * numerical);
  for (int channel = 0; channel < 3; ++channel) {
    const double exact = light.power(unit)[channel];
    EXPECT_TRUE(std::abs(estimate[channel].mean() - exact) < 1e-5 * exact ||
                estimate[channel].p_value(exact) > sidak(1e-3, 3))
        << estimate[channel].mean() << " for " << exact;
  }
}

// False alarm 0.1 % for each light.
TEST_P(EveryLight, ParticlesCarryItsPower) {
  const Light& light = *GetParam().light;
  TestRandom random(4);
  for (const EmissionExtent& extent : k_extents) {
    Moments carried[3];
    for (int i = 0; i < 20'000; ++i) {
      const Vec2 u_point = random.get2();
      const EmissionSample sample = light.sample_emission(u_point, random.get2(), extent);
      ASSERT_NEAR(length(sample.ray.direction), 1, 1e-5f);
      ASSERT_EQ(sample.delta, !light.is_environment());
      for (int channel = 0; channel < 3; ++channel) carried[channel].add(sample.power[channel]);
    }
    const Rgb power = light.power(k_ball);
    for (int channel = 0; channel < 3; ++channel)
      EXPECT_TRUE(std::abs(carried[channel].mean() - power[channel]) < 1e-5 * power[channel] ||
                  carried[channel].p_value(power[channel]) > sidak(1e-3, 6))
          << carried[channel].mean() << " for " << power[channel];
  }
}

/// A disk that receives light on the side of its normal.
struct Receiver {
  Point3 centre;
  Frame frame;
  float radius;
};

double area(const Receiver& receiver) { return std::numbers::pi * receiver.radius * receiver.radius; }

/// Luminance of what a particle brings to the receiver.
double landed(const EmissionSample& particle, const Receiver& receiver) {
  const double slope = dot(particle.ray.direction, receiver.frame.n);
  if (!(slope < 0)) return 0;
  const double distance = dot(receiver.centre - particle.ray.origin, receiver.frame.n) / slope;
  if (distance < 0) return 0;
  const Point3 position = particle.ray.at(static_cast<float>(distance));
  return distance_squared(position, receiver.centre) < receiver.radius * receiver.radius ? luminance(particle.power)
                                                                                         : 0;
}

/// Luminance of the flux by light sampling from a point uniform on the receiver.
double gathered(const Light& light, const Receiver& receiver, TestRandom& random) {
  const Vec2 on_disk = receiver.radius * square_to_disk(random.get2());
  const Point3 position = receiver.centre + receiver.frame.to_world({on_disk.x, on_disk.y, 0});
  const auto sample = light.sample_direct(position, random.get2());
  if (!sample) return 0;
  const double cosine = std::max(0.0f, dot(sample->wi, receiver.frame.n));
  return luminance(sample->radiance) * cosine / sample->pdf_solid_angle * area(receiver);
}

// The flux that particles bring to disks inside the ball is what light sampling finds there. False alarm 0.1 % for each
// light.
TEST_P(EveryLight, ParticlesBringWhatLightSamplingFinds) {
  const Light& light = *GetParam().light;
  const Receiver receivers[] = {
      {k_ball.centre, frame_from_normal({0, 1, 0}), 0.4f},
      {k_ball.centre + Vec3{0.3f, -0.7f, -0.2f}, frame_from_normal(as_normal(normalize({0.5f, 0.8f, -0.4f}))), 0.5f},
      {k_ball.centre + Vec3{-0.5f, 0.3f, 0.6f}, frame_from_normal(as_normal(normalize({0.1f, -0.6f, -0.9f}))), 0.5f}};
  TestRandom random(5);
  for (const EmissionExtent& extent : k_extents)
    for (const Receiver& receiver : receivers) {
      Moments particles, direct;
      for (int i = 0; i < 20'000; ++i) {
        const Vec2 u_point = random.get2();
        particles.add(landed(light.sample_emission(u_point, random.get2(), extent), receiver));
        direct.add(gathered(light, receiver, random));
      }
      EXPECT_GT(same_mean_p_value(particles, direct), sidak(1e-3, 2 * std::size(receivers)))
          << particles.mean() << " and " << direct.mean();
    }
}

Vec3 map_direction(double u, double v) {
  const double theta = v * std::numbers::pi, phi = 2 * std::numbers::pi * u;
  return {static_cast<float>(std::sin(theta) * std::sin(phi)), static_cast<float>(std::cos(theta)),
          static_cast<float>(-std::sin(theta) * std::cos(phi))};
}

void expect_near(Rgb a, Rgb b, float tolerance) {
  for (int channel = 0; channel < 3; ++channel) EXPECT_NEAR(a[channel], b[channel], tolerance);
}

// u = atan2(x, -z) / 2 pi: columns begin at -z and go over +x; rows begin at +y.
TEST(EnvironmentMap, IsBilinearBetweenTexelCentres) {
  const RgbImage texels = test::random_map(8, 4, 11);
  const EnvironmentMap light(texels, {});
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 8; ++x) {
      expect_near(light.radiance(map_direction((x + 0.5) / 8, (y + 0.5) / 4)), texels(x, y), 1e-5f);
      const Rgb right = texels((x + 1) % 8, y), between = 0.75f * texels(x, y) + 0.25f * right;
      expect_near(light.radiance(map_direction((x + 0.75) / 8, (y + 0.5) / 4)), between, 1e-5f);
    }
  expect_near(light.radiance(map_direction(3.5 / 8, 1.75 / 4)), 0.75f * texels(3, 1) + 0.25f * texels(3, 2), 1e-5f);
  expect_near(light.radiance(map_direction(3.5 / 8, 0.01)), texels(3, 0), 1e-4f);   // clamped
  expect_near(light.radiance(map_direction(3.5 / 8, 0.999)), texels(3, 3), 1e-4f);  // at the poles
  EXPECT_EQ(light.radiance({0, 0, -1}), EnvironmentMap(texels, {}, "again").radiance({0, 0, -1}));
  expect_near(light.radiance(normalize({1, 0, -1})),
              0.25f * (texels(0, 1) + texels(1, 1) + texels(0, 2) + texels(1, 2)), 1e-5f);  // u = 1/8
}

// Upper and lower half mirror each other in the sum: 2 pi times both, whatever lies between.
TEST(EnvironmentMap, HasTheExactIntegralOfTwoRows) {
  RgbImage texels({1, 2});
  texels(0, 0) = {1, 2, 3};
  texels(0, 1) = {10, 0, 5};
  const EnvironmentMap light(texels, test::oblique());
  expect_near(light.integral(), 2 * k_pi * Rgb(11, 2, 8), 1e-4f);
}

TEST(EnvironmentMap, OfOneTexelIsTheConstantLight) {
  const EnvironmentMap map(RgbImage({1, 1}, Rgb(1, 2, 3)), {});
  const ConstantLight constant(Rgb(1, 2, 3));
  TestRandom random(12);
  expect_near(map.power(k_ball), constant.power(k_ball), 1e-3f);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 direction = random.direction();
    expect_near(map.radiance(direction), constant.radiance(direction), 1e-6f);
    EXPECT_NEAR(map.pdf_direct(direction), constant.pdf_direct(direction), 1e-7f);
  }
}

TEST(EnvironmentMap, OrientationTurnsTheMap) {
  const RgbImage texels = test::random_map(8, 4, 13);
  const Orientation orientation = test::oblique(true);
  const EnvironmentMap straight(texels, {}), turned(texels, orientation);
  TestRandom random(14);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 local = random.direction();
    expect_near(turned.radiance(orientation.to_world(local)), straight.radiance(local), 1e-4f);
  }
}

// Every value that a random number can have gives a direction of its light, the borders 0 and 1 - 2^-24 included.
TEST(EnvironmentMap, BordersOfTheRandomNumbersGiveDirections) {
  for (const LightCase& c : test::environment_cases())
    for (const float x : {0.0f, 0x1p-24f, 0.5f, k_one_minus_epsilon})
      for (const float y : {0.0f, 0x1p-24f, 0.5f, k_one_minus_epsilon}) {
        const auto sample = c.light->sample_direct(Point3(), {x, y});
        if (sample) {
          EXPECT_NEAR(length(sample->wi), 1, 1e-5f) << c.name;
        }
        EXPECT_TRUE(is_finite(c.light->sample_emission({0, 0}, {x, y}, k_extents[1]).power)) << c.name;
      }
}

TEST(Point, FollowsTheInverseSquare) {
  const PointLight light({0, 3, 0}, Rgb(18, 9, 0));
  const auto sample = light.sample_direct({0, 0, 0}, {});
  ASSERT_TRUE(sample);
  expect_near(sample->radiance, Rgb(2, 1, 0), 1e-6f);
  EXPECT_EQ(sample->wi, (Vec3{0, 1, 0}));
  EXPECT_EQ(sample->position, (Point3{0, 3, 0}));
  EXPECT_FALSE(light.sample_direct({0, 3, 0}, {}));
}

TEST(Spot, FallsOffLinearlyWithTheAngle) {
  const auto at = [](double degrees) {
    const SpotLight light({0, 0, 0}, {0, 0, 1}, Rgb(4), static_cast<float>(40 * k_degree),
                          static_cast<float>(20 * k_degree));
    const auto sample = light.sample_direct(
        {static_cast<float>(2 * std::sin(degrees * k_degree)), 0, static_cast<float>(2 * std::cos(degrees * k_degree))},
        {});
    return sample ? sample->radiance.r : 0;
  };
  EXPECT_FLOAT_EQ(at(0), 1);
  EXPECT_FLOAT_EQ(at(19.9), 1);
  EXPECT_NEAR(at(25), 0.75, 1e-5);
  EXPECT_NEAR(at(30), 0.5, 1e-5);
  EXPECT_NEAR(at(39), 0.05, 1e-5);
  EXPECT_EQ(at(40.1), 0);
  EXPECT_EQ(at(180), 0);
}

TEST(Spot, HasTheIntegralOfItsFalloffAsPower) {
  constexpr double beam = 20 * k_degree, cutoff = 50 * k_degree;
  constexpr int steps = 100'000;
  double integral = 0;
  for (int i = 0; i < steps; ++i) {
    const double theta = (i + 0.5) / steps * cutoff;
    const double falloff = std::min(1.0, (cutoff - theta) / (cutoff - beam));
    integral += 2 * std::numbers::pi * falloff * std::sin(theta) * cutoff / steps;
  }
  const SpotLight light({}, {0, 0, 1}, Rgb(1), static_cast<float>(cutoff), static_cast<float>(beam));
  EXPECT_NEAR(light.power(k_ball).r, integral, 1e-5);
  const SpotLight everywhere({}, {0, 0, 1}, Rgb(1), k_pi, k_pi);
  EXPECT_NEAR(everywhere.power(k_ball).r, 4 * k_pi, 1e-5);
}

TEST(Directional, GivesItsIrradianceToAPlaneAcrossIt) {
  const DirectionalLight light({0, -1, 0}, Rgb(3, 2, 1));
  const auto sample = light.sample_direct({5, 6, 7}, {});
  ASSERT_TRUE(sample);
  EXPECT_EQ(sample->wi, (Vec3{0, 1, 0}));
  EXPECT_EQ(sample->radiance / sample->pdf_solid_angle, Rgb(3, 2, 1));
  expect_near(light.power({{0, 0, 0}, 2}), 4 * k_pi * Rgb(3, 2, 1), 1e-4f);
}

TEST(Lights, WithoutPowerAreHarmless) {
  const std::vector<LightPtr> black = {
      std::make_shared<const ConstantLight>(Rgb()),
      std::make_shared<const EnvironmentMap>(RgbImage({4, 2}), Orientation()),
      std::make_shared<const PointLight>(Point3(), Rgb()),
      std::make_shared<const SpotLight>(Point3(), Vec3{0, 0, 1}, Rgb(), 1.0f, 0.5f),
      std::make_shared<const DirectionalLight>(Vec3{0, 0, 1}, Rgb()),
  };
  for (const LightPtr& light : black) {
    EXPECT_EQ(light->power(k_ball), Rgb()) << light->kind();
    EXPECT_EQ(light->radiance({0, 1, 0}), Rgb()) << light->kind();
    EXPECT_EQ(light->pdf_direct({0, 1, 0}), 0) << light->kind();
    const auto sample = light->sample_direct({1, 2, 3}, {0.5f, 0.5f});
    EXPECT_TRUE(!sample || is_black(sample->radiance)) << light->kind();
  }
  const Emitters emitters({}, {}, black, {k_ball, {}});
  EXPECT_TRUE(emitters.empty());
  EXPECT_TRUE(emitters.environments().empty());
  EXPECT_FALSE(emitters.sample_direct({1, 2, 3}, 0.5, 0.5f));
}

}  // namespace
}  // namespace gradslc
