#include "experiments/cli/idle_threads.h"

#include <unistd.h>

#include <cstdlib>

namespace gradslc {

void let_idle_threads_sleep(char** argv) {
  constexpr const char* k_variable = "OMP_WAIT_POLICY";
  if (std::getenv(k_variable) != nullptr || setenv(k_variable, "passive", 0) != 0) return;
  execv("/proc/self/exe", argv);
}

}  // namespace gradslc
