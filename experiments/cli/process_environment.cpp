#include "experiments/cli/process_environment.h"

#include <unistd.h>

#include <cstdlib>

namespace gradslc {

void set_process_environment(char** argv) {
  constexpr const char* k_settings[][2] = {{"OMP_WAIT_POLICY", "passive"},
                                           {"GLIBC_TUNABLES", "glibc.malloc.hugetlb=1"}};
  bool changed = false;
  for (const auto& [variable, value] : k_settings)
    if (std::getenv(variable) == nullptr && setenv(variable, value, 0) == 0) changed = true;
  if (changed) execv("/proc/self/exe", argv);
}

}  // namespace gradslc
