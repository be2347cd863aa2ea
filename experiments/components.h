#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "integrators/integrator.h"

namespace gradslc {

struct ComponentEntry {
  const char* name;
  const char* meaning;
  bool Components::*member;
};
/// The only list of components.
std::span<const ComponentEntry> component_registry();
std::vector<std::string> component_names();

/// The names of those that are on.
std::vector<std::string> names_of(const Components& components);
/// Turns one on; false where there is none of that name.
bool include_component(Components& components, std::string_view name);

}  // namespace gradslc
