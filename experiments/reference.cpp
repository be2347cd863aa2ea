#include "experiments/reference.h"

#include <fmt/format.h>

#include <cstdlib>

#include "core/error.h"
#include "core/exr.h"
#include "core/file.h"
#include "core/hash.h"
#include "experiments/build_info.h"
#include "experiments/render.h"
#include "experiments/sha256.h"
#include "experiments/vpl_light.h"
#include "scene/scene.h"

namespace gradslc {
namespace {

constexpr std::uint64_t k_reference_seed = 0x7265666572656e63;  // "referenc": a stream apart from every experiment's
constexpr const char* k_integrator = "spt";

/// Passes of one half; the spp of both are rounded up to an even number.
int passes_per_half(int spp) { return (spp + 1) / 2; }

MethodPlan method_of(const ReferencePlan& plan) {
  MethodPlan method =
      plan.method.value_or(MethodPlan{"", k_integrator, nlohmann::json::object(), "none", nlohmann::json::object()});
  method.name = "reference";
  return method;
}

Film render_half(int half, int passes, bool parts, const MethodPlan& method, const Scene& scene,
                 RenderSettings settings, const Makers& makers, const std::function<void(double)>& progress) {
  settings.seed = hash_combine(k_reference_seed, static_cast<std::uint64_t>(half));
  const std::unique_ptr<Integrator> integrator = makers.integrator(method);
  integrator->prepare(scene, settings);
  const IntegratorTraits traits = integrator->traits();
  if (traits.biased || traits.truncated || traits.one_set)
    throw_input_error("", fmt::format("the reference's method \"{}\" does not converge to the right image with these "
                                      "parameters; choose an unbiased one",
                                      method.integrator));
  Film film(scene.camera().resolution(), {.gradients = traits.gradients, .parts = parts});
  for (int pass = 0; pass < passes; ++pass) {
    integrator->render_pass(static_cast<std::uint32_t>(pass), film);
    progress((half + static_cast<double>(pass + 1) / passes) / 2);
  }
  if (const std::uint64_t invalid = film.invalid_samples()) {
    throw_failure("", fmt::format("the reference has {} samples that are not finite; it cannot be trusted", invalid));
  }
  return film;
}

std::filesystem::path with_extension(const std::filesystem::path& path, const char* extension) {
  return std::filesystem::path(path).replace_extension(extension);
}

void write_reference(const std::filesystem::path& file, const Reference& reference, const nlohmann::json& about) {
  ExrImage content{reference.images.mean(), {{"a", reference.images.a}, {"b", reference.images.b}}, {}};
  if (reference.vpl_light) {
    content.layers["vpl_light_a"] = reference.vpl_light->a;
    content.layers["vpl_light_b"] = reference.vpl_light->b;
  }
  write_exr(file, content);
  nlohmann::json full = about;
  full["sha256"] = sha256_of_file(file);
  write_file_atomically(with_extension(file, ".json"), full.dump(2) + "\n");
}

const RgbImage& half_layer(const ExrImage& content, const char* name, const std::filesystem::path& file) {
  const auto layer = content.layers.find(name);
  if (layer == content.layers.end() || !std::holds_alternative<RgbImage>(layer->second)) {
    throw_input_error(file.string(), fmt::format("has no half \"{}\"; remove the file to render it again", name));
  }
  return std::get<RgbImage>(layer->second);
}

/// Reads a kept reference and the JSON beside it, and checks the file against its checksum.
Reference read_reference(const std::filesystem::path& file, bool parts) {
  Reference reference;
  const nlohmann::json about = nlohmann::json::parse(read_file(with_extension(file, ".json")), nullptr, false);
  if (!about.is_object() || about.value("sha256", "") != sha256_of_file(file)) {
    throw_input_error(file.string(), "differs from its checksum; remove the file to render it again");
  }
  const ExrImage content = read_exr(file);
  reference.images = {half_layer(content, "a", file), half_layer(content, "b", file)};
  if (parts) reference.vpl_light = {half_layer(content, "vpl_light_a", file), half_layer(content, "vpl_light_b", file)};
  reference.about = about;
  return reference;
}

Reference rendered_reference(const ReferencePlan& plan, const Scene& scene, const nlohmann::json& key,
                             const RenderSettings& settings, const std::filesystem::path& folder, const Makers& makers,
                             const std::function<void(const std::string&)>& log,
                             const std::function<void(double)>& progress) {
  const int spp = plan.spp;
  const std::filesystem::path file = folder / (sha256(key.dump()) + ".exr");
  Reference reference;
  // The JSON is written last: without it the image may not be whole.
  if (std::filesystem::exists(with_extension(file, ".json"))) {
    reference = read_reference(file, plan.parts);
    log(fmt::format("reference: {} spp, kept in {}", spp, file.string()));
    if (reference.about.value("build", nlohmann::json()) != build_info())
      log("reference: was rendered by another build of this program");
  } else {
    const int passes = passes_per_half(spp);
    const Seconds begin = makers.clock();
    if (plan.parts) reference.vpl_light.emplace();
    for (const int half : {0, 1}) {
      const Film film = render_half(half, passes, plan.parts, method_of(plan), scene, settings, makers, progress);
      (half == 0 ? reference.images.a : reference.images.b) = film.primal();
      if (plan.parts) (half == 0 ? reference.vpl_light->a : reference.vpl_light->b) = vpl_light(film);
    }
    const Seconds time = makers.clock() - begin;
    reference.about = {{"key", key},
                       {"wall_seconds", time.wall},
                       {"cpu_seconds", time.cpu},
                       {"build", build_info()},
                       {"machine", machine_info()}};
    write_reference(file, reference, reference.about);
    log(fmt::format("reference: {} spp rendered in {:.1f} s", 2 * passes, time.wall));
  }
  reference.spp = 2 * passes_per_half(spp);
  reference.file = file;
  return reference;
}

/// Completes a reference whose images, file and spp are set.
void finish(Reference& reference) {
  try {
    compare_images(reference.images.mean(), reference.images);  // throws where it is of no use
  } catch (const Error& error) {
    throw_input_error(reference.file.string(), error.message());
  }
  reference.noise = reference_noise(reference.images);
  reference.about["file"] = reference.file.string();
  if (reference.noise) reference.about["noise_relmse"] = *reference.noise;
}

}  // namespace

std::filesystem::path reference_folder(const std::filesystem::path& results) {
  const char* shared = std::getenv("GRADSLC_REFERENCES");
  return shared != nullptr && shared[0] != '\0' ? std::filesystem::path(shared) : results / "references";
}

Reference imported_reference(const std::filesystem::path& file, Resolution wanted) {
  Reference reference;
  reference.images.a = read_exr(file).image;
  reference.file = file;
  const Resolution given = reference.images.resolution();
  if (given != wanted) {
    throw_input_error(file.string(), fmt::format("reference is {}x{}, the scene is rendered at {}x{}; give the scene "
                                                 "the reference's width and height",
                                                 given.width, given.height, wanted.width, wanted.height));
  }
  reference.about = {{"imported", true}, {"sha256", sha256_of_file(file)}};
  finish(reference);
  return reference;
}

nlohmann::json reference_key(const ReferencePlan& plan, const std::string& scene_hash, Resolution resolution,
                             const RenderSettings& settings) {
  nlohmann::json estimand = to_json(settings);
  estimand.erase("seed");
  nlohmann::json key = {{"integrator", method_of(plan).integrator},
                        {"scene", scene_hash},
                        {"width", resolution.width},
                        {"height", resolution.height},
                        {"settings", estimand},
                        {"spp", 2 * passes_per_half(plan.spp)},
                        {"seed", k_reference_seed}};
  if (plan.method) key["method"] = plan.resolved_method;
  if (plan.parts) key["parts"] = true;
  return key;
}

Reference obtain_reference(const ReferencePlan& plan, const Scene& scene, const std::string& scene_hash,
                           const RenderSettings& settings, const std::filesystem::path& folder, const Makers& makers,
                           const std::function<void(const std::string&)>& log,
                           const std::function<void(double)>& progress) {
  const Resolution resolution = scene.camera().resolution();
  if (plan.kind == ReferencePlan::Kind::file) return imported_reference(plan.file, resolution);
  const nlohmann::json key = reference_key(plan, scene_hash, resolution, settings);
  Reference reference = rendered_reference(plan, scene, key, settings, folder, makers, log, progress);
  finish(reference);
  return reference;
}

}  // namespace gradslc
