#pragma once

#include <functional>
#include <string>

#include "experiments/makers.h"
#include "experiments/metrics.h"

namespace gradslc {

/// What methods are measured against, and how well it is known.
struct Reference {
  ReferenceImages images;
  std::optional<ReferenceImages> vpl_light;  ///< vpl_light() of both halves, where the experiment has parts
  std::optional<double> noise;               ///< relmse of the reference itself; unknown for an imported image
  std::filesystem::path file;
  int spp = 0;           ///< of both halves together; 0: imported
  nlohmann::json about;  ///< for manifests
};

/// Where references are kept: the folder that the environment variable GRADSLC_REFERENCES names, so that experiments
/// share them, or else `references` in the results folder.
std::filesystem::path reference_folder(const std::filesystem::path& results);

/// What a rendered reference depends on, with the scene's content hash; its SHA-256 is the file's name.
nlohmann::json reference_key(const ReferencePlan& plan, const std::string& scene_hash, Resolution resolution,
                             const RenderSettings& settings);

/// An image of an EXR file as reference. Error (input) where it does not have the `wanted` size or is black.
Reference imported_reference(const std::filesystem::path& file, Resolution wanted);

/// The reference of a scene: read from `folder` if a file with this key is there, else rendered by the plan's method in
/// two halves with seeds of their own (independent of each other, of the experiment's seed and of its methods) and kept
/// there; or the imported image. Error (input) where an imported image does not fit, and where the reference is black.
/// `progress` gets the share of rendering that is done.
Reference obtain_reference(const ReferencePlan& plan, const Scene& scene, const std::string& scene_hash,
                           const RenderSettings& settings, const std::filesystem::path& folder, const Makers& makers,
                           const std::function<void(const std::string&)>& log,
                           const std::function<void(double)>& progress);

}  // namespace gradslc
