#include "scene/loaders/mesh_file.h"

#include <algorithm>

namespace gradslc {
namespace {

constexpr std::size_t k_max_excerpt = 160;  // characters; longer lines are not shown

}  // namespace

SourcePosition position_in_text(std::string_view text, const std::string& file, std::size_t offset) {
  offset = std::min(offset, text.size());
  const std::string_view before = text.substr(0, offset);
  const std::size_t begin = before.rfind('\n') + 1;  // npos + 1 = 0
  const std::size_t end = std::min(text.find('\n', offset), text.size());
  SourcePosition where{.file = file,
                       .line = static_cast<int>(std::count(before.begin(), before.end(), '\n')) + 1,
                       .column = static_cast<int>(offset - begin) + 1,
                       .pointer = {},
                       .excerpt = {}};
  if (end - begin <= k_max_excerpt) where.excerpt = std::string(text.substr(begin, end - begin));
  std::replace(where.excerpt.begin(), where.excerpt.end(), '\t', ' ');
  if (where.excerpt.ends_with('\r')) where.excerpt.pop_back();
  return where;
}

}  // namespace gradslc
