#include "support/render/method.h"

#include <algorithm>
#include <cstdlib>
#include <iostream>

#include "core/hash.h"
#include "film/film.h"
#include "scene/scene.h"

namespace gradslc {
namespace {

class ParameterAssigner final : public ParameterVisitor {
 public:
  explicit ParameterAssigner(std::map<std::string, ParameterValue> values) : values_(std::move(values)) {}
  ~ParameterAssigner() override {
    for (const auto& [key, value] : values_) {
      std::cerr << "unknown parameter in a test: " << key << std::endl;
      std::abort();
    }
  }
  using ParameterVisitor::choice;
  using ParameterVisitor::integer;
  using ParameterVisitor::real;

  void boolean(std::string_view name, bool& value, std::string_view) override {
    if (const auto* v = take<bool>(name)) value = *v;
  }
  void integer(std::string_view name, std::int64_t& value, Range, std::string_view, std::string_view) override {
    if (const auto* v = take<double>(name)) value = static_cast<std::int64_t>(*v);
  }
  void real(std::string_view name, double& value, Range, std::string_view, std::string_view) override {
    if (const auto* v = take<double>(name)) value = *v;
  }
  void choice(std::string_view name, std::size_t& index, const std::vector<std::string>& names,
              std::string_view) override {
    const auto* v = take<std::string>(name);
    if (!v) return;
    const auto found = std::find(names.begin(), names.end(), *v);
    if (found == names.end()) std::abort();
    index = static_cast<std::size_t>(found - names.begin());
  }
  void group(std::string_view name, std::string_view, const std::function<void()>& body) override {
    const std::string outer = prefix_;
    prefix_ += std::string(name) + "/";
    body();
    prefix_ = outer;
  }

 private:
  template <class T>
  const T* take(std::string_view name) {
    const auto found = values_.find(prefix_ + std::string(name));
    if (found == values_.end()) return nullptr;
    taken_ = found->second;
    values_.erase(found);
    return &std::get<T>(taken_);
  }
  std::map<std::string, ParameterValue> values_;
  ParameterValue taken_;
  std::string prefix_;
};

/// Means of one image over regions.
std::vector<double> region_means(const Regions& regions, const std::function<Rgb(Pixel)>& value,
                                 const std::function<bool(Pixel)>& counts) {
  std::vector<double> sums(regions.count, 0);
  std::vector<int> pixels(regions.count, 0);
  for (std::size_t i = 0; i < regions.of.size(); ++i) {
    const Pixel pixel = regions.of.resolution().pixel(i);
    if (!counts(pixel)) continue;
    sums[regions.of[i]] += static_cast<double>(luminance(value(pixel)));
    ++pixels[regions.of[i]];
  }
  for (std::size_t r = 0; r < sums.size(); ++r)
    if (pixels[r] > 0) sums[r] /= pixels[r];
  return sums;
}

/// Recorded differences of one image over regions, run by run. Which pairs a run records is random, each pair with the
/// same probability: so the expectation of a region's differences is that of its sum over that of its count.
class DifferenceSums {
 public:
  explicit DifferenceSums(std::span<const Regions> partitions) : partitions_(partitions) {}

  void add(Quantity quantity, const MomentImage& image) {
    std::vector<std::vector<Sum>>& run = runs_[quantity].emplace_back();
    for (const Regions& regions : partitions_) {
      std::vector<Sum>& sums = run.emplace_back(regions.count);
      for (std::size_t i = 0; i < regions.of.size(); ++i) {
        const Pixel pixel = regions.of.resolution().pixel(i);
        const double count = image.count(pixel);
        sums[regions.of[i]].value += static_cast<double>(luminance(image.mean(pixel))) * count;
        sums[regions.of[i]].count += count;
      }
    }
  }
  /// One value per run and region: their mean is the ratio over all runs, their scatter that of the ratio.
  void finish(std::vector<BlockMoments>& results) const {
    for (const auto& [quantity, runs] : runs_)
      for (std::size_t k = 0; k < partitions_.size(); ++k) {
        std::vector<Moments>& blocks = results[k].blocks[quantity];
        blocks.resize(partitions_[k].count);
        for (std::size_t r = 0; r < blocks.size(); ++r) {
          Sum all;
          for (const auto& run : runs) all.value += run[k][r].value, all.count += run[k][r].count;
          const double ratio = all.count > 0 ? all.value / all.count : 0;
          const double mean_count = all.count / static_cast<double>(runs.size());
          for (const auto& run : runs) {
            const auto [value, count] = run[k][r];
            blocks[r].add(all.count > 0 ? ratio + (value - ratio * count) / mean_count : 0);
          }
        }
      }
  }

 private:
  struct Sum {
    double value = 0, count = 0;
  };
  std::span<const Regions> partitions_;
  std::map<Quantity, std::vector<std::vector<std::vector<Sum>>>> runs_;  // by run, partition and region
};

}  // namespace

std::unique_ptr<Integrator> Method::make() const {
  for (const IntegratorEntry& entry : integrator_registry()) {
    if (entry.name != integrator) continue;
    auto made = entry.make();
    ParameterAssigner assigner(parameters);
    made->describe(assigner);
    return made;
  }
  std::abort();
}

std::string to_string(Quantity quantity) {
  constexpr const char* k_names[] = {
      "image", "direct", "vpl", "compensation", "specular", "prefix", "vpl and compensation", "dx", "dy"};
  return k_names[static_cast<std::size_t>(quantity)];
}

Regions block_regions(Resolution resolution, int block) {
  const int columns = (resolution.width + block - 1) / block, rows = (resolution.height + block - 1) / block;
  Regions regions{Image<std::size_t>(resolution), static_cast<std::size_t>(columns * rows)};
  for (std::size_t i = 0; i < regions.of.size(); ++i) {
    const Pixel pixel = resolution.pixel(i);
    regions.of[i] = static_cast<std::size_t>(pixel.y / block * columns + pixel.x / block);
  }
  return regions;
}

BlockMoments block_moments(const Method& method, const Scene& scene, const RenderSettings& settings,
                           const BlockOptions& options) {
  const Regions blocks = block_regions(scene.camera().resolution(), options.block);
  return region_moments(method, scene, settings, {&blocks, 1}, options)[0];
}

std::vector<BlockMoments> region_moments(const Method& method, const Scene& scene, const RenderSettings& settings,
                                         std::span<const Regions> partitions, const BlockOptions& options) {
  std::vector<BlockMoments> results(partitions.size());
  const Resolution resolution = scene.camera().resolution();
  const auto add = [&](Quantity quantity, const std::function<Rgb(Pixel)>& value,
                       const std::function<bool(Pixel)>& counts) {
    for (std::size_t k = 0; k < partitions.size(); ++k) {
      const std::vector<double> means = region_means(partitions[k], value, counts);
      std::vector<Moments>& blocks = results[k].blocks[quantity];
      blocks.resize(means.size());
      for (std::size_t i = 0; i < means.size(); ++i) blocks[i].add(means[i]);
    }
  };
  DifferenceSums differences(partitions);
  for (int run = 0; run < options.runs; ++run) {
    RenderSettings seeded = settings;
    seeded.seed = hash_combine(options.seed, static_cast<std::uint64_t>(run));
    const auto integrator = method.make();
    integrator->prepare(scene, seeded);
    Film film(resolution, {.gradients = integrator->traits().gradients, .parts = true});
    for (int pass = 0; pass < options.passes; ++pass) integrator->render_pass(static_cast<std::uint32_t>(pass), film);
    if (film.invalid_samples() > 0) std::abort();

    const auto always = [](Pixel) { return true; };
    const RgbImage primal = film.primal();
    add(
        Quantity::image, [&](Pixel p) { return primal[p]; }, always);
    RgbImage both(resolution);
    for (int i = 0; i < k_part_count; ++i) {
      const RgbImage part = film.part(static_cast<Part>(i));
      add(
          static_cast<Quantity>(i + 1), [&](Pixel p) { return part[p]; }, always);
      if (i == static_cast<int>(Part::vpl) || i == static_cast<int>(Part::compensation))
        for (std::size_t k = 0; k < both.size(); ++k) both[k] += part[k];
    }
    add(
        Quantity::vpl_and_compensation, [&](Pixel p) { return both[p]; }, always);
    const auto inside = [&](Pixel step) { return [=](Pixel p) { return resolution.contains(p + step); }; };
    if (integrator->traits().gradients) {
      MomentImage dx = film.half(0).dx, dy = film.half(0).dy;
      dx.merge(film.half(1).dx), dy.merge(film.half(1).dy);
      differences.add(Quantity::dx, dx);
      differences.add(Quantity::dy, dy);
    } else {
      add(
          Quantity::dx,
          [&](Pixel p) {
            return primal[p + Pixel{1, 0}] - primal[p];
          },
          inside({1, 0}));
      add(
          Quantity::dy,
          [&](Pixel p) {
            return primal[p + Pixel{0, 1}] - primal[p];
          },
          inside({0, 1}));
    }
  }
  differences.finish(results);
  return results;
}

Comparison compare_blocks(const std::vector<Moments>& a, const std::vector<Moments>& b) {
  Comparison comparison;
  for (std::size_t i = 0; i < a.size(); ++i) {
    ++comparison.tests;
    const double p = same_mean_p_value(a[i], b[i]);
    if (p >= comparison.p_value) continue;
    comparison.p_value = p, comparison.block = i;
    comparison.mean_a = a[i].mean(), comparison.mean_b = b[i].mean();
  }
  return comparison;
}

}  // namespace gradslc
