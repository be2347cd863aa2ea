#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace gradslc {

enum class PlyFormat : std::uint8_t { ascii, binary_little_endian, binary_big_endian };
enum class PlyType : std::uint8_t { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

/// Bytes of a value in binary files.
std::size_t ply_size(PlyType type);

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::float32;
  std::optional<PlyType> count_type;  ///< of the number before the values of a list; none: a single value
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  PlyFormat format = PlyFormat::ascii;
  std::vector<PlyElement> elements;
  std::size_t size = 0;  ///< bytes, with the end of the line "end_header"

  /// nullptr where there is none.
  const PlyElement* find(std::string_view name) const;
};

/// The header of a PLY file. Throws Error (input) with line and column.
PlyHeader parse_ply_header(std::string_view bytes, const std::string& file);

}  // namespace gradslc
