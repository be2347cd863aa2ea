#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace gradslc {

/// Bytes that this process can still take: what the system has available, within the limit of the process's control
/// group (version 2). Infinite where neither is known.
double available_memory();

/// The line MemAvailable of /proc/meminfo, in bytes.
std::optional<double> mem_available(std::string_view meminfo);

/// "1.5 GiB", "20 MiB": three digits.
std::string format_bytes(double bytes);

}  // namespace gradslc
