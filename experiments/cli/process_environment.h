#pragma once

namespace gradslc {

/// Settings that the C library and OpenMP read when a program is loaded: where they are not set, the program is started
/// once more with them. Returns where that is not needed or fails.
/// - OMP_WAIT_POLICY=passive: threads that wait for each other sleep instead of spin. Spinning is charged as CPU time
/// to
///   the method that waits, and on shared cores slows everybody.
/// - GLIBC_TUNABLES=glibc.malloc.hugetlb=1: large allocations may use huge pages, since rays and textures read all over
///   large scenes, and a missing page translation costs as much as the read.
void set_process_environment(char** argv);

}  // namespace gradslc
