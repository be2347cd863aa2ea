#include "core/parameters.h"

#include <charconv>

namespace gradslc {

double shortest_double(float value) {
  char text[32];
  const auto written = std::to_chars(text, text + sizeof text, value);
  double wide = 0;
  std::from_chars(text, written.ptr, wide);
  return wide;
}

}  // namespace gradslc
