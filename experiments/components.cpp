#include "experiments/components.h"

namespace gradslc {
namespace {

constexpr ComponentEntry k_components[] = {
    {"emission", "emitters seen by the camera, paths of one edge", &Components::emission},
    {"direct", "light that was scattered once, two edges", &Components::direct},
    {"indirect", "light that was scattered more often, three edges and more", &Components::indirect},
};

}  // namespace

std::span<const ComponentEntry> component_registry() { return k_components; }

std::vector<std::string> component_names() { return names_of(Components{true, true, true}); }

std::vector<std::string> names_of(const Components& components) {
  std::vector<std::string> names;
  for (const ComponentEntry& entry : k_components)
    if (components.*entry.member) names.emplace_back(entry.name);
  return names;
}

bool include_component(Components& components, std::string_view name) {
  for (const ComponentEntry& entry : k_components) {
    if (name != entry.name) continue;
    components.*entry.member = true;
    return true;
  }
  return false;
}

}  // namespace gradslc
