#include "experiments/metrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/error.h"

namespace gradslc {
namespace {

RgbImage two_pixels(Rgb first, Rgb second) {
  RgbImage image({2, 1});
  image[std::size_t{0}] = first;
  image[std::size_t{1}] = second;
  return image;
}

double value(const std::vector<Metric>& metrics, const char* name) { return metric_value(metrics, name); }

TEST(Metrics, ComeInTheOrderOfTheirRegistry) {
  const RgbImage image({2, 2}, Rgb(1));
  const std::vector<Metric> metrics = compare_images(image, image);
  ASSERT_EQ(metrics.size(), metric_registry().size());
  for (std::size_t i = 0; i < metrics.size(); ++i) {
    EXPECT_EQ(metrics[i].name, metric_registry()[i].name);
    EXPECT_EQ(metrics[i].value, 0);
  }
}

TEST(Metrics, AgreeWithSumsDoneByHandAgainstOneImage) {
  // r = 1 everywhere in the first pixel, 3 in the second: mean 2, e2 = 0.01 * 4 = 0.04, e = 0.2.
  const RgbImage reference = two_pixels(Rgb(1), Rgb(3));
  const RgbImage image = two_pixels(Rgb(1.5f), Rgb(2));
  const std::vector<Metric> metrics = compare_images(image, reference);
  EXPECT_NEAR(value(metrics, "mse"), (0.25 + 1) / 2, 1e-12);
  EXPECT_NEAR(value(metrics, "relmse"), (0.25 / 1.04 + 1 / 9.04) / 2, 1e-12);
  EXPECT_NEAR(value(metrics, "mape"), (0.5 / 1.2 + 1 / 3.2) / 2, 1e-12);
  EXPECT_NEAR(value(metrics, "smape"), (2 * 0.5 / 2.7 + 2 * 1 / 5.2) / 2, 1e-12);
  EXPECT_NEAR(value(metrics, "mean_bias"), 1.75 / 2 - 1, 1e-12);
  EXPECT_NEAR(value(metrics, "relmse_trimmed"), 1 / 9.04, 1e-12) << "the first pixel ranks worst";
}

TEST(Metrics, ChannelsCountSeparately) {
  const RgbImage reference({1, 1}, Rgb(1, 2, 3));  // mean 2
  const RgbImage image({1, 1}, Rgb(1, 2, 4));
  EXPECT_NEAR(value(compare_images(image, reference), "mse"), 1.0 / 3, 1e-12);
  EXPECT_NEAR(value(compare_images(image, reference), "relmse"), 1 / 9.04 / 3, 1e-12);
}

TEST(Metrics, HalvesGiveProductsOfDifferences) {
  // a = 1, b = 3, so r = 2 and the mean is 2: e2 = 0.04.
  const ReferenceImages halves{RgbImage({1, 1}, Rgb(1)), RgbImage({1, 1}, Rgb(3))};
  const RgbImage image({1, 1}, Rgb(4));
  const std::vector<Metric> metrics = compare_images(image, halves);
  EXPECT_NEAR(value(metrics, "mse"), (4 - 1) * (4 - 3), 1e-12) << "a plain square would give 4";
  EXPECT_NEAR(value(metrics, "relmse"), 3 / 4.04, 1e-12);
  EXPECT_NEAR(value(metrics, "mape"), 2 / 2.2, 1e-12);
  EXPECT_LT(value(compare_images(RgbImage({1, 1}, Rgb(2)), halves), "mse"), 0) << "near the noise negative, as it is";
}

TEST(Metrics, HalvesDoNotCarryTheReferencesNoise) {
  // The image is the truth; halves err by +d or -d in a fixed pattern that is uncorrelated between them.
  RgbImage a({4, 1}), b({4, 1});
  const float d = 0.3f;
  for (std::size_t i = 0; i < 4; ++i) {
    a[i] = Rgb(1 + (i % 2 == 0 ? d : -d));
    b[i] = Rgb(1 + (i < 2 ? d : -d));
  }
  const RgbImage truth({4, 1}, Rgb(1));
  EXPECT_NEAR(value(compare_images(truth, ReferenceImages{a, b}), "mse"), 0, 1e-12);
  EXPECT_NEAR(value(compare_images(truth, ReferenceImages{a, b}.mean()), "mse"), d * d / 2, 1e-6) << "plain squares do";
}

TEST(Metrics, TrimmedLeavesOutAThousandthOfThePixelsRoundedUp) {
  for (const auto& [pixels, dropped] :
       {std::pair{999, 1}, std::pair{1000, 1}, std::pair{1001, 2}, std::pair{2000, 2}}) {
    const RgbImage reference({pixels, 1}, Rgb(1));
    // As many fireflies as may be dropped, then one more.
    for (int fireflies = dropped; fireflies <= dropped + 1; ++fireflies) {
      RgbImage image = reference;
      for (int i = 0; i < fireflies; ++i) image(7 + 3 * i, 0) = Rgb(100);
      const double trimmed = value(compare_images(image, reference), "relmse_trimmed");
      const double expected = fireflies == dropped ? 0 : 99.0 * 99 / 1.01 / (pixels - dropped);
      EXPECT_NEAR(trimmed, expected, 1e-6) << pixels;
    }
  }
}

TEST(Metrics, ImageOfOnePixelKeepsItWhenTrimmed) {
  const double trimmed = value(compare_images(RgbImage({1, 1}, Rgb(2)), RgbImage({1, 1}, Rgb(1))), "relmse_trimmed");
  EXPECT_NEAR(trimmed, 1 / 1.01, 1e-12);
}

TEST(Metrics, NoiseOfTheReferenceIsThatOfTheHalvesMean) {
  const ReferenceImages halves{RgbImage({1, 1}, Rgb(1)), RgbImage({1, 1}, Rgb(3))};
  EXPECT_NEAR(*reference_noise(halves), 1 / 4.04, 1e-12);
  EXPECT_FALSE(reference_noise({RgbImage({1, 1}, Rgb(1)), {}}).has_value());
}

TEST(Metrics, RefuseWhatCannotBeMeasured) {
  const RgbImage one({2, 1}, Rgb(1));
  RgbImage broken = one;
  broken(1, 0).g = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(compare_images(broken, one), Error);
  EXPECT_THROW(compare_images(one, broken), Error);
  broken(1, 0).g = std::numeric_limits<float>::infinity();
  EXPECT_THROW(compare_images(broken, one), Error);
  EXPECT_THROW(compare_images(one, RgbImage({1, 2}, Rgb(1))), Error) << "other size";
  EXPECT_THROW(compare_images(one, RgbImage({2, 1}, Rgb(0))), Error) << "black reference";
  EXPECT_THROW(compare_images(RgbImage(), RgbImage()), Error);
}

}  // namespace
}  // namespace gradslc
