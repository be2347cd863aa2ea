#pragma once

#include <nlohmann/json.hpp>

namespace gradslc {

/// What this program was built from and with, as manifests record it: git commit and whether the tree had changes,
/// compiler, flags, versions of libraries.
nlohmann::json build_info();

/// The machine and its state now: processor, cores, threads that are used, load averages, operating system.
nlohmann::json machine_info();

/// Largest resident memory of this process so far, bytes.
std::uint64_t peak_memory_bytes();

}  // namespace gradslc
