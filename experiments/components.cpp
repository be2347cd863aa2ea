#include "experiments/components.h"

namespace gradslc {
namespace {

struct NamedComponent {
  const char* name;
  bool Components::*member;
};
constexpr NamedComponent k_components[] = {
    {"emission", &Components::emission}, {"direct", &Components::direct}, {"indirect", &Components::indirect}};

}  // namespace

std::vector<std::string> component_names() { return names_of(Components{true, true, true}); }

std::vector<std::string> names_of(const Components& components) {
  std::vector<std::string> names;
  for (const NamedComponent& component : k_components)
    if (components.*component.member) names.emplace_back(component.name);
  return names;
}

bool include_component(Components& components, std::string_view name) {
  for (const NamedComponent& component : k_components) {
    if (name != component.name) continue;
    components.*component.member = true;
    return true;
  }
  return false;
}

}  // namespace gradslc
