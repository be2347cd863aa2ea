#pragma once

#include <algorithm>
#include <cstddef>

#include "core/image.h"
#include "core/vec.h"

namespace gradslc {

/// The image cut into blocks of one size, moved by a random offset: blocks at the border are cut off. Whether two
/// neighbours share a block depends on that offset alone (DESIGN 6).
class BlockPartition {
 public:
  /// `u` in [0,1)^2 chooses one of the width * height offsets of the block grid, each with the same probability.
  BlockPartition(Resolution image, Resolution block, Vec2 u)
      : image_(image),
        block_(block),
        shift_{chosen(block.width, u.x), chosen(block.height, u.y)},
        grid_{count(image.width, block.width, shift_.x), count(image.height, block.height, shift_.y)} {}

  std::size_t size() const { return grid_.pixels(); }

  struct Block {
    Pixel first;      ///< upper left pixel
    Resolution size;  ///< at least 1x1
  };
  /// Calls body(Block) for the smaller blocks that a block consists of, whose sides divide those of the whole ones:
  /// they are cut off where it is.
  template <class Body>
  void for_each_within(const Block& block, Resolution smaller, const Body& body) const {
    const Pixel end{block.first.x + block.size.width, block.first.y + block.size.height};
    for (Pixel first = block.first; first.y < end.y; first = {block.first.x, next(first.y, shift_.y, smaller.height)})
      for (; first.x < end.x; first.x = next(first.x, shift_.x, smaller.width)) {
        const Pixel beyond{std::min(next(first.x, shift_.x, smaller.width), end.x),
                           std::min(next(first.y, shift_.y, smaller.height), end.y)};
        body(Block{first, {beyond.x - first.x, beyond.y - first.y}});
      }
  }
  Block block(std::size_t index) const {
    const Pixel cell = grid_.pixel(index);
    const int x = cell.x * block_.width - shift_.x, y = cell.y * block_.height - shift_.y;
    const Pixel first{std::max(x, 0), std::max(y, 0)};
    return {first,
            {std::min(x + block_.width, image_.width) - first.x, std::min(y + block_.height, image_.height) - first.y}};
  }

 private:
  static int chosen(int size, float u) { return std::min(static_cast<int>(u * static_cast<float>(size)), size - 1); }
  /// The first place behind `place` where one of blocks of `size` begins.
  static int next(int place, int shift, int size) { return ((place + shift) / size + 1) * size - shift; }
  static int count(int image, int block, int shift) { return (image + shift + block - 1) / block; }

  Resolution image_, block_;
  Pixel shift_;  // how far the grid's origin lies above and left of the image's
  Resolution grid_;
};

}  // namespace gradslc
