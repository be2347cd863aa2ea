#include "experiments/reconstruct.h"

#include <gtest/gtest.h>

#include <cmath>

namespace gradslc {
namespace {

/// One set of one sample.
void add_set(Film& film, int half, float value) {
  for (MomentImage* image : {&film.half(half).primal, &film.half(half).dx}) image->add({0, 0}, Rgb(value));
  film.close_set(half);
}

TEST(ReconstructionInput, HoldsMeansCountsAndVariancesOfHalvesAndBoth) {
  Film film({1, 1}, {.gradients = true});
  for (const float v : {1.0f, 3.0f}) add_set(film, 0, v);
  for (const float v : {4.0f, 4.0f, 10.0f}) add_set(film, 1, v);
  const ReconstructionInput input = reconstruction_input(film);
  const std::size_t p = 0;
  EXPECT_EQ(input.halves[0].primal[p], Rgb(2));
  EXPECT_EQ(input.halves[1].primal[p], Rgb(6));
  EXPECT_FLOAT_EQ(input.combined.primal[p].g, 22.0f / 5);
  EXPECT_EQ(input.combined.primal_count[p], 5);
  EXPECT_FLOAT_EQ(input.halves[0].primal_variance[p].r, 2.0f / 2);
  EXPECT_FLOAT_EQ(input.halves[1].dx_variance[p].r, 12.0f / 3);
  // Scatter of all five values about 4.4: 45.2 / 4, of the mean a fifth of that.
  EXPECT_FLOAT_EQ(input.combined.dx_variance[p].b, 45.2f / 4 / 5);
  EXPECT_EQ(input.combined.dx[p], input.combined.primal[p]);
  EXPECT_EQ(input.halves[0].dy_count[p], 0) << "nothing was recorded there";
}

TEST(ReconstructionInput, SetThatIsStillOpenCounts) {
  Film film({1, 1}, {.gradients = true});
  add_set(film, 0, 1);
  film.half(0).primal.add({0, 0}, Rgb(3));
  const ReconstructionInput input = reconstruction_input(film);
  EXPECT_EQ(input.combined.primal[std::size_t{0}], Rgb(2));
  EXPECT_EQ(input.combined.primal_count[std::size_t{0}], 2);
  EXPECT_FLOAT_EQ(input.combined.primal_variance[std::size_t{0}].r, 1);
  EXPECT_EQ(film.half(0).primal.sets({0, 0}), 1u) << "the film is as it was";
}

TEST(ReconstructionInput, FilmWithoutGradientsHasNoneOfKnownVariance) {
  Film film({2, 2}, {});
  film.half(0).primal.add({1, 1}, Rgb(1));
  const ReconstructionInput input = reconstruction_input(film);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(input.combined.dx_count[i], 0);
    EXPECT_TRUE(std::isinf(input.combined.dy_variance[i].g));
  }
}

TEST(FinalImage, IsThePrimalWithoutAReconstruction) {
  Film film({2, 1}, {});
  film.half(1).primal.add({1, 0}, Rgb(5));
  const FinalImage result = final_image(film, nullptr);
  EXPECT_EQ(result.image, film.primal());
  EXPECT_FALSE(result.reconstruction.has_value());
}

}  // namespace
}  // namespace gradslc
