#pragma once

namespace gradslc {

/// Lets threads that wait for each other sleep instead of spin, unless OMP_WAIT_POLICY is set: spinning is charged as
/// CPU time to the method that waits, and on shared cores slows everybody. OpenMP's runtime reads the variable when the
/// program is loaded, so the program is started once more with it set. Returns where that is not needed or fails.
void let_idle_threads_sleep(char** argv);

}  // namespace gradslc
