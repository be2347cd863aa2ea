#include "lighttree/builders/pairs.h"
#include "lighttree/builders/saoh.h"
#include "lighttree/light_tree.h"

namespace gradslc {
namespace {

constexpr BuilderEntry k_builders[] = {
    {"pairs", "Morton order, neighbours paired level by level", build_pairs, pairs_bytes, pairs_peak_bytes},
    {"saoh", "split top-down by surface area and orientation, with bins", build_saoh, saoh_bytes, saoh_peak_bytes},
};

}  // namespace

std::span<const BuilderEntry> builder_registry() { return k_builders; }

std::vector<std::string> builder_names() {
  std::vector<std::string> names;
  for (const BuilderEntry& entry : k_builders) names.emplace_back(entry.name);
  return names;
}

}  // namespace gradslc
