#include "core/memory.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <iterator>

#include "core/constants.h"

namespace gradslc {
namespace {

std::string content_of(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// The number that a text begins with, after blanks.
std::optional<double> leading_number(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(" \t"), text.size()));
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc()) return std::nullopt;
  return static_cast<double>(value);
}

/// What follows the first occurrence of `key`, to the end of its line.
std::string_view line_after(std::string_view text, std::string_view key) {
  const std::size_t found = text.find(key);
  if (found == text.npos) return {};
  text.remove_prefix(found + key.size());
  return text.substr(0, text.find('\n'));
}

/// What the limit of this process's control group leaves; nullopt without a limit.
std::optional<double> left_in_control_group() {
  const std::string membership = content_of("/proc/self/cgroup");
  const std::string folder = "/sys/fs/cgroup" + std::string(line_after(membership, "0::")) + "/";
  const auto most = leading_number(content_of(folder + "memory.max"));
  const auto used = leading_number(content_of(folder + "memory.current"));
  if (!most || !used) return std::nullopt;
  return std::max(0.0, *most - *used);
}

}  // namespace

std::optional<double> mem_available(std::string_view meminfo) {
  const auto kibibytes = leading_number(line_after(meminfo, "MemAvailable:"));
  if (!kibibytes) return std::nullopt;
  return 1024 * *kibibytes;
}

double available_memory() {
  const double system = mem_available(content_of("/proc/meminfo")).value_or(k_infinity);
  return std::min(system, left_in_control_group().value_or(k_infinity));
}

std::string format_bytes(double bytes) {
  constexpr const char* k_units[] = {"bytes", "KiB", "MiB", "GiB", "TiB"};
  std::size_t unit = 0;
  for (; bytes >= 1000 && unit + 1 < std::size(k_units); ++unit) bytes /= 1024;
  return fmt::format("{:.3g} {}", bytes, k_units[unit]);
}

}  // namespace gradslc
