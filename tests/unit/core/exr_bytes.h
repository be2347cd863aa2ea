#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace gradslc {

/// An uncompressed EXR file put together byte by byte after the published file layout, as an oracle that shares no code
/// with the library that reads it. All channels have the same type; `value(channel, x, y)` is stored as is.
struct ExrBytes {
  struct Window {
    std::int32_t x_min, y_min, x_max, y_max;
  };
  enum class Type : std::int32_t { half = 1, float32 = 2 };

  Window data{0, 0, 1, 1}, display{0, 0, 1, 1};
  std::vector<std::string> channels{"B", "G", "R"};  ///< in alphabetical order
  Type type = Type::float32;
  bool tiled = false;  ///< one tile that covers the data window
  std::int32_t sampling = 1;

  /// `bits(channel, x, y)` gives the value's bit pattern: of a half or of a float.
  template <class Bits>
  std::string build(const Bits& bits) const {
    std::string file;
    put(file, std::int32_t{20000630});
    put(file, std::int32_t{tiled ? 0x202 : 2});
    put_attribute(file, "channels", "chlist", channel_list());
    put_attribute(file, "compression", "compression", std::string(1, '\0'));
    put_attribute(file, "dataWindow", "box2i", bytes_of(data));
    put_attribute(file, "displayWindow", "box2i", bytes_of(display));
    put_attribute(file, "lineOrder", "lineOrder", std::string(1, '\0'));
    put_attribute(file, "pixelAspectRatio", "float", bytes_of(1.0f));
    put_attribute(file, "screenWindowCenter", "v2f", std::string(8, '\0'));
    put_attribute(file, "screenWindowWidth", "float", bytes_of(1.0f));
    const std::int32_t width = data.x_max - data.x_min + 1, height = data.y_max - data.y_min + 1;
    if (tiled) put_attribute(file, "tiles", "tiledesc", bytes_of(width) + bytes_of(height) + std::string(1, '\0'));
    file += '\0';

    std::vector<std::string> chunks;
    if (tiled) chunks.push_back(std::string(16, '\0'));  // tile and level coordinates; its size follows below
    std::string pixels;
    for (std::int32_t y = data.y_min; y <= data.y_max; ++y) {
      std::string line;
      for (const std::string& channel : channels)
        for (std::int32_t x = data.x_min; x <= data.x_max; ++x) {
          const std::uint32_t value = bits(channel, x, y);
          line.append(reinterpret_cast<const char*>(&value), type == Type::half ? 2 : 4);
        }
      if (!tiled) chunks.push_back(bytes_of(y) + bytes_of(static_cast<std::int32_t>(line.size())) + line);
      pixels += line;
    }
    if (tiled) chunks[0] += bytes_of(static_cast<std::int32_t>(pixels.size())) + pixels;

    std::uint64_t offset = file.size() + 8 * chunks.size();
    for (const std::string& chunk : chunks) {
      put(file, offset);
      offset += chunk.size();
    }
    for (const std::string& chunk : chunks) file += chunk;
    return file;
  }

 private:
  template <class T>
  static std::string bytes_of(const T& value) {
    return {reinterpret_cast<const char*>(&value), sizeof value};
  }
  template <class T>
  static void put(std::string& file, const T& value) {
    file += bytes_of(value);
  }
  static void put_attribute(std::string& file, const std::string& name, const std::string& kind,
                            const std::string& value) {
    file += name + '\0' + kind + '\0' + bytes_of(static_cast<std::int32_t>(value.size())) + value;
  }
  std::string channel_list() const {
    std::string list;
    for (const std::string& name : channels)
      list += name + '\0' + bytes_of(type) + std::string(4, '\0') + bytes_of(sampling) + bytes_of(sampling);
    return list + '\0';
  }
};

}  // namespace gradslc
